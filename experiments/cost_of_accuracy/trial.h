#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::cost_of_accuracy {

/// Factor by which the errors of a run's neighbours may exceed the target error.
inline constexpr double neighbour_allowance = 1.5;

/// The search resolves elements and steps to a tenth: of two runs whose times differ by
/// less, either could be cheaper on a finer grid.
inline constexpr double resolution = 1.1;

/// The error of a run that fails, and the time of one that never meets a target.
inline constexpr double never = std::numeric_limits<double>::infinity();

/// One measured run. A method is a model with its options and an integrator, identified
/// here by its index.
struct Trial {
  std::size_t method = 0;
  int elements = 0;
  int substeps = 0;  // steps per frame
  double error = 0;
  double wall_s = 0;
  // Number of neighbours examined (see Neighbour), and their largest error.
  int examined = 0;
  double neighbours = 0;

  /// Largest over its steps, 0 if the method has none (ErrorIndicator).
  double indicator = 0;

  /// The smallest target for which the run counts, by its own error and by those of its
  /// neighbours under the allowance. A lower bound until all neighbours were examined.
  double judged() const;
};

/// A run may be accidentally accurate: at the edge of stability, or where spatial and
/// temporal errors cancel. It counts for a target only if its neighbours are within
/// neighbour_allowance times that target: 1 and 2 elements more, half as many more steps,
/// and the run itself with the scene's data changed a little up and down.
enum class Neighbour { one_more_element, two_more, shorter_steps, data_up, data_down };
inline constexpr int neighbour_count = 5;

/// The cheapest run accepted by `accept` that is judged at most `target`; null when there
/// is none.
const Trial* cheapest(const std::vector<Trial>& runs, double target,
                      const std::function<bool(const Trial&)>& accept = {});

/// The run judged best among those taking at most `wall_s`. Errors below `floor` are
/// indistinguishable: the cheapest of those.
const Trial* most_accurate(const std::vector<Trial>& runs, double wall_s, double floor);

/// Runs that no other beats in both judged error and time, from the dearest, most
/// accurate one on, without those that reduce the error by less than a tenth relative to
/// a cheaper one. Errors below `floor` count as `floor`.
std::vector<Trial> pareto_front(std::vector<Trial> runs, double floor);

}  // namespace tress::experiments::cost_of_accuracy
