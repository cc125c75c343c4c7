#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "experiments/cost_of_accuracy/methods.h"
#include "experiments/cost_of_accuracy/scene_measure.h"
#include "experiments/cost_of_accuracy/search.h"

namespace tress::experiments::cost_of_accuracy {

/// Runs whose times are this near, over the shorter, are tied: the search tells no less
/// apart. Wider where the shorter does not repeat as well. One stands for all that are
/// tied, by what no machine changes: fewest options off their defaults, then least
/// elements x substeps, then fewest elements, then the order of the catalogue.
inline constexpr double toss_up = resolution;

/// The answer for one wanted error.
struct BestRuns {
  Trial winner;
  std::optional<Trial> runner_up;  // another model or integrator
  /// What each choice of the winner contributes: the cheapest run with another; none
  /// where nothing that was tried meets the target.
  std::vector<std::pair<std::string, std::optional<Trial>>> without;
};

/// What comes of a search: the few runs that are shown, timed once more, each by the
/// least of all its times. What the search did not try but for a winner's other options
/// is added to its methods.
///
/// All of them count: their neighbours were examined (Trial::judged).
class Finalists {
 public:
  using Time = std::function<WallTime(const Trial&)>;

  Finalists(Search& search, const Scene& given, std::vector<Method>& methods, Time time);

  /// Nothing where no run meets the target.
  std::optional<BestRuns> of(double target);
  std::optional<Trial> within(double wall_s, double floor);
  /// The run that is judged best, examined or not; of those the cheapest.
  std::optional<Trial> nearest();
  bool cut() const { return search_.cut(); }
  /// Grows as long as the answers may still change: looking for what replaces a choice
  /// now and then finds something better.
  std::size_t known() const { return search_.runs().size() + times_.size(); }
  /// The Pareto front of all runs with errors up to `loosest`.
  std::vector<Trial> front(double floor, double loosest);
  /// Of a run that is shown, see WallTime.
  double scatter(const Trial& run) const { return times_.at(place(run)).scatter; }
  /// Whether the time of `run` cannot be told from that of `best`, which is shown.
  bool tied(const Trial& run, const Trial& best) const;

 private:
  using Accept = std::function<bool(const Trial&)>;

  /// Of the search, with the times of here; once it is cut those that were examined.
  std::vector<Trial> runs() const;
  bool time(const Trial& run);  // false: it was before
  void time_simpler(const Trial& run);
  Trial known(const Trial& run);
  std::optional<Trial> counting(double target, const Accept& accept);
  bool simpler(const Trial& a, const Trial& b) const;
  std::optional<Trial> settled(double target, const Accept& accept);
  std::optional<Trial> replaced(const Trial& winner, double target,
                                const std::function<bool(const Method&)>& other);
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
