#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
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

/// Neighbours of a run, which show whether it is accidentally accurate: at the edge of
/// stability, or where spatial and temporal errors cancel. A run counts for a target only
/// if its neighbours are within neighbour_allowance times that target. These are 1 and 2
/// elements more, the step or the tolerance times 0.7 and 1.4, and the run itself with
/// the scene's data changed a little up and down. In this order: those with more elements
/// are runs that may win themselves, and are not judged for a run that fails otherwise.
enum class Neighbour {
  shorter_steps,
  longer_steps,
  data_up,
  data_down,
  one_more_element,
  two_more
};
inline constexpr int neighbour_count = 6;
inline constexpr double shorter = 0.7, longer = 1.4;

/// Properties of a run, or of its scene, that a name depends on.
struct RunKind {
  bool by_tolerance = false;  // adaptive
  int element_unit = 1;       // SearchPlan::element_unit
  bool held = false;          // supports or joints keep the lengths
};
/// "1 element more", "tolerance x 1.4" ...
std::string name(Neighbour neighbour, const RunKind& kind);

/// One measured run. A method is a model with its options and an integrator, identified
/// here by its index.
struct Trial {
  std::size_t method = 0;
  int elements = 0;
  int substeps = 0;  // steps per frame
  double error = 0;
  /// Measured, or of a search the work at the least price of it (Search).
  double wall_s = 0;
  double work = 0;  // total_work(); 0: not counted
  // Number of neighbours examined (see Neighbour), their largest error, and which has it.
  int examined = 0;
  double neighbours = 0;
  Neighbour worst = Neighbour::shorter_steps;

  /// Largest over its steps, 0 if the method has none (ErrorIndicator).
  double indicator = 0;
  double steps = 0;  // of a strand, mean

  /// The smallest target for which the run counts, by its own error and by those of its
  /// neighbours under the allowance. A lower bound until all neighbours were examined.
  double judged() const;
};

/// The cheapest run accepted by `accept` that is judged at most `target`; null when there
/// is none.
const Trial* cheapest(const std::vector<Trial>& runs, double target,
                      const std::function<bool(const Trial&)>& accept = {});

/// The run judged best among those taking at most `wall_s`. Errors below `floor` are
/// indistinguishable: the cheapest of those.
const Trial* most_accurate(const std::vector<Trial>& runs, double wall_s, double floor);

/// Returns the runs that no other beats in both judged error and time, from the most
/// expensive, most accurate one on. Runs that reduce the error by less than a tenth
/// relative to a cheaper one are left out. Errors below `floor` count as `floor`.
std::vector<Trial> pareto_front(std::vector<Trial> runs, double floor);

}  // namespace tress::experiments::cost_of_accuracy
