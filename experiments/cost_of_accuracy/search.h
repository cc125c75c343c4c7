#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace tress {

/// One run that was measured. A method is a model with its options and an integrator,
/// known here by its number alone.
struct Trial {
  std::size_t method = 0;
  int elements = 0;
  int substeps = 0;  // steps per frame
  double error = 0;
  double wall_s = 0;
};

/// The cheapest run of those that `accept` takes whose error is at most `target`; null
/// when there is none.
const Trial* cheapest(const std::vector<Trial>& runs, double target,
                      const std::function<bool(const Trial&)>& accept = {});

/// The most accurate run that takes at most `wall_s`. Errors below `floor` cannot be told
/// apart: of those the cheapest.
const Trial* most_accurate(const std::vector<Trial>& runs, double wall_s, double floor);

/// Runs that no other beats in both error and time, from the dearest, most accurate one
/// on, without those that gain less than a tenth of the error on a cheaper one.
/// Errors below `floor` count as `floor`.
std::vector<Trial> pareto_front(std::vector<Trial> runs, double floor);

struct SearchPlan {
  std::vector<double> targets;  // errors, descending
  std::vector<int> elements;    // coarse ladders, ascending
  std::vector<int> substeps;
  double longest_run_s;  // a run that is expected to take longer is not tried
  /// How much the ladders may miss: a method whose cheapest run on them costs more than
  /// `slack` times the cheapest of all is given up (see ladder_slack).
  double slack;
};

/// Where cost grows as elements x substeps and error falls in both, the cheapest run on
/// the ladders costs at most r = (ratio of elements) x (ratio of substeps) times the
/// method's best between them. The method of the best run of all is then within r of the
/// cheapest run on the ladders: with this slack it is never given up. `noise`: how much
/// longer than usual one run may take.
double ladder_slack(const SearchPlan& plan, double noise);

/// The cheapest run for each wanted error, in stages:
///
///   probe    every method once in the middle of the ladders; those with the smallest
///            error x time go first, so that what follows can be measured against them
///   coarse   every method climbs from few elements and long steps: more substeps until
///            they gain little (what is left of the error is of space), then more
///            elements, from a step or two longer than where the last climb ended
///   prune    for each target the methods within `slack` of the cheapest go on
///   refine   from a method's cheapest run so far numbers of elements around it, each
///            with the fewest substeps that meet the target, by bisection; again from the
///            cheapest of those until it stays
class Search {
 public:
  /// A run and its time; no value where it fails or takes longer than `most_s`.
  using Measure = std::function<std::optional<Trial>(std::size_t method, int elements,
                                                     int substeps, double most_s)>;

  /// `stop`: true once time is over; what was measured until then stands.
  Search(SearchPlan plan, std::size_t methods, Measure measure,
         std::function<bool()> stop);

  void coarse();  // with the probe
  void refine();
  /// One method for one target, from its cheapest run so far.
  void refine(std::size_t method, double target);
  /// The fewest substeps with which the method meets `target` on so many elements: at
  /// first about `guess`. Null where `most` do not.
  const Trial* fewest_substeps(std::size_t method, int elements, double target, int guess,
                               int most);

  /// One run, measured unless it was before; null where it fails.
  const Trial* run(std::size_t method, int elements, int substeps);
  /// More time, after a stage was cut.
  void go_on(std::function<bool()> stop);

  const std::vector<Trial>& runs() const { return runs_; }
  std::size_t tried() const { return tried_; }  // methods that the coarse stage came to
  bool cut() const { return cut_; }             // `stop` ended a stage

 private:
  struct Place {
    std::size_t method;
    int elements, substeps;
    auto operator<=>(const Place&) const = default;
  };
  double expected_s(std::size_t method, int elements, int substeps) const;
  bool stopped();
  std::vector<std::size_t> promising_first();
  void climb(std::size_t method);

  SearchPlan plan_;
  std::size_t methods_;
  Measure measure_;
  std::function<bool()> stop_;
  std::vector<Trial> runs_;
  std::map<Place, std::optional<std::size_t>> seen_;  // of runs_; none: failed
  std::set<std::pair<std::size_t, double>> refined_;  // methods and targets
  std::size_t tried_ = 0;
  bool cut_ = false;
};

}  // namespace tress
