#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "experiments/cost_of_accuracy/trial.h"

namespace tress::experiments::cost_of_accuracy {

struct SearchPlan {
  std::vector<double> targets;  // errors, descending
  std::vector<int> elements;    // coarse ladders, ascending
  std::vector<int> substeps;
  long longest_run;  // elements x substeps; longer runs are not tried
  /// "Substeps" of a method that its ladder counts as one, its fewest; without it 1.
  std::function<int(std::size_t method)> unit = {};
  /// Orders of a method in elements and in substeps, from which probes are extrapolated
  /// to the tightest target.
  struct Orders {
    double space = 2, time = 2;
  };
  std::function<Orders(std::size_t method)> orders = {};
  /// Methods of one kind need similar elements and substeps: once one of a kind has
  /// climbed to the tightest target the others begin near its answer. Without it each
  /// method is a kind of its own.
  std::function<std::size_t(std::size_t method)> kind = {};
  /// Tolerance for the coarseness of the ladders: a method whose cheapest run on them
  /// costs more than `slack` times the cheapest of all is dropped (see ladder_slack).
  double slack;
  /// Numbers of elements that are tried are multiples of this.
  int element_unit = 1;
};

/// Returns the slack with which the cheapest method is never dropped. Suppose that cost
/// grows as elements x substeps and that error falls in both. The cheapest run on the
/// ladders then costs at most r times the method's best between them. The factor r is
/// (ratio of elements) x (ratio of substeps). The method of the overall best run is then
/// within r of the cheapest run on the ladders. `noise`: factor by which one run may take
/// longer than usual.
double ladder_slack(const SearchPlan& plan, double noise);

/// Search for the cheapest run for each target error, in stages:
///
/// - probe: every method runs once in the middle of the ladders, one of each kind before
///   the others. Those that would meet the tightest target soonest, by their orders,
///   climb first.
/// - coarse: a method climbs from few elements and long steps. It takes more substeps
///   until they gain little (the remaining error is spatial), then more elements. A
///   method of a kind that has climbed begins near the answer of that kind.
/// - prune: for each target the methods within `slack` of the cheapest continue.
/// - refine: numbers of elements around that of a method's cheapest run are tried, each
///   with the fewest substeps that meet the target, by bisection. This is repeated from
///   the cheapest of those until it no longer changes.
/// - sweep: every method is tried with all numbers of elements, an eighth apart, and with
///   substeps down from those that may cost as much as the best run.
///
/// Wherever a best run decides what is tried next, its neighbours must hold: accidentally
/// accurate runs are passed over. `stop` decides how far the search goes; the search
/// itself uses no clock except to compare times of runs.
///
/// One time of a short run scatters by tens of per cent, its count of work does not. Runs
/// are compared by work x price. The price of a method (s for a unit of work) is the
/// least that was measured with similar elements, within a power of two.
class Search {
 public:
  /// A run and its time; empty if it fails.
  using Measure =
      std::function<std::optional<Trial>(std::size_t method, int elements, int substeps)>;
  /// The error of a run with longer or shorter steps, or with the scene's data changed,
  /// infinite if it fails.
  using Changed = std::function<double(const Trial& run, Neighbour change)>;

  /// `stop`: true once the work is done; measurements so far are kept.
  Search(SearchPlan plan, std::size_t methods, Measure measure, Changed changed,
         std::function<bool()> stop);

  /// With the probe, which ends early where `probed` is true.
  void coarse(const std::function<bool()>& probed = {});
  void refine();
  void sweep();  // after coarse()
  /// One method for one target, from its cheapest run so far. Runs are not tried if they
  /// would take longer than the best of the method itself, or of all methods.
  enum class Bound { own, all };
  void refine(std::size_t method, double target, Bound bound = Bound::own);
  /// All runs of its method that are somewhat cheaper than `best` and near it. Errors are
  /// not monotonic, so that bisections end next to the cheapest.
  void comb(const Trial& best);
  /// The fewest substeps with which the method meets `target` on this many elements,
  /// starting near `guess`. Null where `most`, or the longest run, do not.
  const Trial* fewest_substeps(std::size_t method, int elements, double target, int guess,
                               int most);

  /// Returns such a run whose neighbours meet the target as well.
  const Trial* fewest_that_hold(std::size_t method, int elements, double target,
                                int guess, int most);

  /// Returns SearchPlan::unit of the method, 1 by default.
  int unit(std::size_t method) const { return plan_.unit ? plan_.unit(method) : 1; }

  /// One run, measured unless already known, with the multiple of
  /// SearchPlan::element_unit nearest to `elements`; null if it fails.
  const Trial* run(std::size_t method, int elements, int substeps);
  /// Whether the run, one of runs(), counts for `target`: examines its neighbours one by
  /// one until one does not hold. False also if the search is cut.
  bool holds(const Trial& run, double target);
  /// The cheapest run that counts for `target`, passing over those that do not; null if
  /// there is none. If the search is cut, among those examined.
  const Trial* robust(double target,
                      const std::function<bool(const Trial&)>& accept = {});
  /// Continues after a stage was cut.
  void go_on(std::function<bool()> stop);

  const std::vector<Trial>& runs() const { return runs_; }
  std::size_t tried() const { return tried_; }  // methods that the coarse stage reached
  std::size_t passed_over() const { return passed_over_; }  // accidentally accurate runs
  bool cut() const { return cut_; }                         // `stop` ended a stage

 private:
  struct Place {
    std::size_t method;
    int elements, substeps;
    auto operator<=>(const Place&) const = default;
  };
  SearchPlan::Orders orders(std::size_t method) const {
    return plan_.orders ? plan_.orders(method) : SearchPlan::Orders{};
  }
  int most_substeps(std::size_t method, int elements) const;
  double expected_s(std::size_t method, int elements, int substeps) const;
  double neighbour_error(const Trial& run, Neighbour which);
  void price(Trial& measured);
  bool stopped();
  std::vector<std::size_t> promising_first(const std::function<bool()>& probed);
  void climb(std::size_t method);
  /// One method with this many elements.
  void sweep(std::size_t method, int elements, double target);
  /// The cheapest method that is not refined yet; false: none is left, or the search
  /// ends.
  bool refine_next(double target);
  /// Near the answers of another method of its kind; false: there is none yet.
  bool follow(std::size_t method);

  SearchPlan plan_;
  std::size_t methods_;
  Measure measure_;
  Changed changed_;
  std::function<bool()> stop_;
  std::vector<Trial> runs_;
  std::map<std::pair<std::size_t, int>, double> price_;       // method, log2 of elements
  std::map<Place, std::optional<std::size_t>> seen_;          // of runs_; none: failed
  std::set<std::tuple<std::size_t, double, Bound>> refined_;  // methods and targets
  std::vector<std::size_t> order_;                            // methods, promising first
  std::size_t tried_ = 0, passed_over_ = 0;
  bool cut_ = false;
};

}  // namespace tress::experiments::cost_of_accuracy
