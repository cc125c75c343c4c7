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
#include "experiments/cost_of_accuracy/search.h"

namespace tress {

/// Of runs whose times are this near, over the shorter, the one stands for all that has
/// the fewest options off their defaults: the rest is a toss-up.
inline constexpr double toss_up = 1.1;

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
class Finalists {
 public:
  using Time = std::function<double(const Trial&)>;

  Finalists(Search& search, const SceneText& text, std::vector<Method>& methods,
            Time time);

  /// Nothing where no run meets the target.
  std::optional<BestRuns> of(double target);
  std::optional<Trial> within(double wall_s, double floor);
  /// Grows as long as the answers may still change: looking for what replaces a choice
  /// now and then finds something better.
  std::size_t known() const { return search_.runs().size() + wall_s_.size(); }
  /// The Pareto front of all runs with errors up to `loosest`.
  std::vector<Trial> front(double floor, double loosest);

 private:
  using Accept = std::function<bool(const Trial&)>;

  std::vector<Trial> runs() const;  // of the search, with the times of here
  void time(const Trial& run);
  void time_simpler(const Trial& run);
  std::optional<Trial> settled(double target, const Accept& accept);
  std::optional<Trial> replaced(const Trial& winner, double target,
                                const std::function<bool(const Method&)>& other);
  bool varied(const Method& method, std::string_view choice);
  std::optional<Trial> twice_the_elements(const Trial& winner, double target);
  std::optional<Trial> half_the_step(const Trial& winner, double target);

  Search& search_;
  const SceneText& text_;
  std::vector<Method>& methods_;
  Time time_;
  std::map<std::tuple<std::size_t, int, int>, double> wall_s_;
};

}  // namespace tress
