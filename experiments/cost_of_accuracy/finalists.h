#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "experiments/cost_of_accuracy/scene_measure.h"
#include "experiments/cost_of_accuracy/search.h"
#include "experiments/cost_of_accuracy/trial_scene.h"

namespace tress::experiments::cost_of_accuracy {

/// Runs whose times differ by less than this, relative to the shorter, are tied: the
/// search resolves no less. The margin widens where the shorter does not repeat as well.
/// Machine-independent criteria select among tied runs: fewest options off their
/// defaults, then least elements x substeps, then fewest elements, then the order of the
/// catalogue.
inline constexpr double toss_up = resolution;

/// The part of a time by which its repeats may scatter and widen a tie.
inline constexpr double most_scatter = 0.25;

/// Returns the ratio up to which the times of two runs are tied, where those of the
/// shorter scatter by this part.
constexpr double tie(double scatter) {
  return std::max(toss_up, 1 + std::min(scatter, most_scatter));
}

/// The answer for one target error.
struct BestRuns {
  Trial winner;
  std::optional<Trial> runner_up;  // another model or integrator
  /// Contribution of each choice of the winner: the cheapest run with another choice;
  /// empty where no tried run meets the target.
  std::vector<std::pair<std::string, std::optional<Trial>>> without;
};

/// The cheapest runs of one model for one target error: with methods of fixed steps
/// only, and with methods that have error control, adaptive or not, extrapolated or
/// not. Empty where none meets the target.
struct ControlCompared {
  std::optional<Trial> by_step, by_tolerance;
};

/// The result of a search: the few runs that are shown, timed again, each by its least
/// time. Variants of a winner's options that the search did not try are added to its
/// methods.
///
/// All of them count: their neighbours were examined (Trial::judged).
class Finalists {
 public:
  using Time = std::function<WallTime(const Trial&)>;

  Finalists(Search& search, const Scene& given, std::vector<Method>& methods, Time time);

  /// Empty where no run meets the target. Without `choices` nothing else replaces a
  /// choice of the winner: BestRuns::without stays empty.
  std::optional<BestRuns> of(double target, bool choices = true);
  /// The two are timed in turns.
  ControlCompared control(const ModelEntry& model, double target);
  std::optional<Trial> within(double wall_s, double floor);
  /// The run judged best, examined or not; the cheapest of equals.
  std::optional<Trial> nearest();
  bool cut() const { return search_.cut(); }
  /// Grows while the answers may still change: the search for replaced choices
  /// occasionally finds something better.
  std::size_t known() const { return search_.runs().size() + times_.size(); }
  /// The Pareto front of all runs with errors up to `loosest`.
  std::vector<Trial> front(double floor, double loosest);
  /// Returns the scatter of the time of a shown run, see WallTime.
  double scatter(const Trial& run) const { return times_.at(place(run)).scatter; }
  /// Whether the time of `run` is indistinguishable from that of `best`, which is shown.
  bool tied(const Trial& run, const Trial& best) const;

 private:
  using Accept = std::function<bool(const Trial&)>;

  /// Returns the runs of the search, with the times measured here; once the search is
  /// cut only the examined runs.
  std::vector<Trial> runs() const;
  bool time(const Trial& run);  // false: it was timed before
  void time_simpler(const Trial& run);
  Trial known(const Trial& run);
  std::optional<Trial> counting(double target, const Accept& accept);
  bool simpler(const Trial& a, const Trial& b) const;
  std::optional<Trial> settled(double target, const Accept& accept);
  std::optional<Trial> replaced(const Trial& winner, double target,
                                const std::function<bool(const Method&)>& other);
  void replace_choices(const Trial& winner, double target, BestRuns& best);
  void try_options(const Trial& run, const Trial& with, double target);
  bool varied(const Method& method, std::string_view choice);
  std::optional<Trial> twice_the_elements(const Trial& winner, double target);
  std::optional<Trial> half_the_step(const Trial& winner, double target);

  using Place = std::tuple<std::size_t, int, int>;
  static Place place(const Trial& run) {
    return {run.method, run.elements, run.substeps};
  }

  Search& search_;
  const Scene& given_;
  std::vector<Method>& methods_;
  Time time_;
  std::map<Place, WallTime> times_;
};

}  // namespace tress::experiments::cost_of_accuracy
