#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::cost_of_accuracy {

/// How far the errors of a run's neighbours may exceed the error that is asked for.
inline constexpr double neighbour_allowance = 1.5;

/// The search resolves elements and steps to a tenth: of two runs whose times differ by
/// less, either could have come out cheaper on a finer grid.
inline constexpr double resolution = 1.1;

/// The error of what cannot be run, and the time of what never gets there.
inline constexpr double never = std::numeric_limits<double>::infinity();

/// One run that was measured. A method is a model with its options and an integrator,
/// known here by its number alone.
struct Trial {
  std::size_t method = 0;
  int elements = 0;
  int substeps = 0;  // steps per frame
  double error = 0;
  double wall_s = 0;
  // Of its neighbours (see Neighbour) so many were examined, with this largest error.
  int examined = 0;
  double neighbours = 0;

  /// Largest of its steps, 0 where the method has none (ErrorIndicator).
  double indicator = 0;

  /// The smallest target for which the run counts: its own error, and what its neighbours
  /// leave of the allowance. A lower bound until all of them were examined.
  double judged() const;
};

/// A run may be accurate by luck: at the edge of stability, or where errors of space and
/// time cancel each other. It counts for a target only if its neighbours are within
/// neighbour_allowance times that target: 1 and 2 elements more, half as many more steps,
/// and the run itself with the scene's data changed a little up and down.
enum class Neighbour { one_more_element, two_more, shorter_steps, data_up, data_down };
inline constexpr int neighbour_count = 5;

/// The cheapest run of those that `accept` takes that is judged at most `target`; null
/// when there is none.
const Trial* cheapest(const std::vector<Trial>& runs, double target,
                      const std::function<bool(const Trial&)>& accept = {});

/// The run judged best that takes at most `wall_s`. Errors below `floor` cannot be told
/// apart: of those the cheapest.
const Trial* most_accurate(const std::vector<Trial>& runs, double wall_s, double floor);

/// Runs that no other beats in both judged error and time, from the dearest, most
/// accurate one on, without those that gain less than a tenth of the error on a cheaper
/// one. Errors below `floor` count as `floor`.
std::vector<Trial> pareto_front(std::vector<Trial> runs, double floor);

}  // namespace tress::experiments::cost_of_accuracy
