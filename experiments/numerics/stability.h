#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "simulation/run/simulation.h"

namespace tress::experiments {

/// Bounds that a stable run keeps, besides staying finite. Energy bounds are for passive
/// scenes; a moving root puts energy in, so driven scenes are bounded by the reach and
/// speed of the tip.
struct StabilityBounds {
  static constexpr double none = std::numeric_limits<double>::infinity();
  double energy = none;  // J, mechanical energy gain since the start
  double reach = none;   // m, distance of the tip from the root
  double speed = none;   // m/s, of the tip relative to the root
};

/// Bound that was violated first.
enum class Broken { nothing, not_finite, energy, reach, speed, stretch, no_solution };
std::string_view name(Broken broken);

/// One judged run; maxima are over the part that was run.
struct StabilityRun {
  Broken broken = Broken::nothing;
  double t = 0;            // s, at the end of the run
  double energy_gain = 0;  // J, 0 unless bounded
  double reach = 0;        // m
  double speed = 0;        // m/s
  Stats stats;
  std::string failure;  // the integrator's message for no_solution

  bool stable() const { return broken == Broken::nothing; }
};

/// Detects the first bound that a run violates; an Observer that never allocates. The
/// root is the system's first material point, the tip its last.
class StabilityJudge {
 public:
  /// Throws InputError when a bound needs a form that the system lacks.
  StabilityJudge(System& system, const StabilityBounds& bounds, const State& start);

  /// False as soon as a bound is violated.
  bool operator()(double t, In q, In v);
  /// Verdict on the watched run, once it has ended.
  StabilityRun verdict(const Simulation& run) const;

 private:
  void see(double& largest, double value, double bound, Broken kind);

  StabilityBounds bounds_;
  Energetics* energetics_ = nullptr;
  MaterialPoints* points_ = nullptr;
  double energy_start_ = 0;
  std::vector<double> x_, u_;
  StabilityRun run_;
};

/// Runs steps of exactly `options.step` until `t_end` is reached or passed, so that the
/// requested step is judged, not one that divides t_end. With `options.tolerance` it runs
/// adaptively to t_end. Stops when a bound is violated. Empty when Options::max_work is
/// used up first. Throws as StabilityJudge.
std::optional<StabilityRun> judge_run(std::string_view integrator, System& system,
                                      const Options& options, const State& start,
                                      double t_end, const StabilityBounds& bounds);

/// The runs of one search, with a common work limit (total_work()), so that a row's
/// result depends on no clock.
class StabilityRuns {
 public:
  StabilityRuns(std::string_view integrator, System& system, const Options& options,
                State start, double t_end, const StabilityBounds& bounds,
                double most_work)
      : integrator_(integrator),
        system_(system),
        options_(options),
        start_(std::move(start)),
        t_end_(t_end),
        bounds_(bounds),
        left_(most_work) {}

  /// judge_run() at this step (s); empty when the work is used up.
  std::optional<StabilityRun> judge(double dt);

 private:
  std::string_view integrator_;
  System& system_;
  Options options_;
  State start_;
  double t_end_;
  StabilityBounds bounds_;
  double left_;
};

/// Parameters of the search for the largest stable step.
struct StepSearch {
  double coarsest = 0.1;     // s, "cap": larger steps are not tried
  double finest = 1e-6;      // s
  double ratio = 1.7782794;  // of successive steps in the scan: four per decade
  double resolution = 1.05;  // target dt_first_unstable / dt_max
  /// Stability is not always monotone: steps below a stable one are tested until
  /// everything down to 1/depth of it was stable too.
  double depth = 30;
};

/// NaN: not tried, or not found.
struct StepLimit {
  double stable;        // s, largest step with all tested steps up to it stable
  double unstable;      // s, smallest unstable step tested
  Broken limited_by;    // the violation there; nothing: all tested steps were stable
  double stable_above;  // s, largest stable step above `unstable`: not monotone
  double finest;        // s, smallest step tested
  int runs;             // steps tested
  int stable_runs;      // of these, the ones up to `stable`
  bool resolved;  // unstable / stable is within the resolution, or nothing was unstable
  bool complete;  // and all was stable down to the depth, within the work limit
};

/// Steps that were tested (s), each with the bound that it violated.
using TestedSteps = std::map<double, Broken>;

/// Returns the limit that these steps show, however they were chosen; `complete` is
/// false.
StepLimit step_limit(const TestedSteps& tested, double resolution);

/// Scans from coarse to fine. At the first stable step it bisects (geometrically) between
/// `stable` and `unstable`, then continues down to the depth, where the next unstable
/// step restarts the procedure. An empty result of `judge` ends the search.
StepLimit find_step_limit(const StepSearch& search,
                          const std::function<std::optional<Broken>(double dt)>& judge);

}  // namespace tress::experiments
