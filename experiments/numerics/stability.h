#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "simulation/run/simulation.h"

namespace tress::experiments {

/// What a stable run keeps, besides staying finite. Energy bounds are for passive scenes;
/// a moving root puts energy in, so driven scenes are bounded by where the tip gets and
/// how fast.
struct StabilityBounds {
  static constexpr double none = std::numeric_limits<double>::infinity();
  double energy = none;  // J, mechanical energy above that of the start
  double reach = none;   // m, distance of the tip from the root
  double speed = none;   // m/s, of the tip relative to the root
};

/// Which of it did not hold first.
enum class Broken { nothing, not_finite, energy, reach, speed, stretch, no_solution };
std::string_view name(Broken broken);

/// One judged run; the maxima are over the part that was run.
struct StabilityRun {
  Broken broken = Broken::nothing;
  double t = 0;            // s, where it ended
  double energy_gain = 0;  // J, 0 when not asked for
  double reach = 0;        // m
  double speed = 0;        // m/s
  Stats stats;
  std::string failure;  // the integrator's words for no_solution

  bool stable() const { return broken == Broken::nothing; }
};

/// Watches one run for what breaks first; an Observer that never allocates. The root is
/// the system's first material point, the tip its last.
class StabilityJudge {
 public:
  /// Throws InputError when a bound needs a form that the system lacks.
  StabilityJudge(System& system, const StabilityBounds& bounds, const State& start);

  /// False as soon as a bound is broken.
  bool operator()(double t, In q, In v);
  /// Of the run that was watched, once it has ended.
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

/// Steps of exactly `options.step` until `t_end` is reached or passed, so that what is
/// judged is the step asked for, not one that divides t_end; ends where a bound breaks.
/// Empty when Options::max_work is used up before. Throws as StabilityJudge.
std::optional<StabilityRun> judge_run(std::string_view integrator, System& system,
                                      const Options& options, const State& start,
                                      double t_end, const StabilityBounds& bounds);

/// The runs of one search, which together may take so much work (total_work()): a row's
/// result then depends on no clock.
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

  /// judge_run() of this step (s); empty when the work is used up.
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

/// How the largest stable step is looked for.
struct StepSearch {
  double coarsest = 0.1;     // s, "cap": larger steps are not tried
  double finest = 1e-6;      // s
  double ratio = 1.7782794;  // of neighbours in the scan: four per decade
  double resolution = 1.05;  // dt_first_unstable / dt_max of the answer
  /// Stability is not always monotone: steps below a stable one are tested until
  /// everything down to a `depth`-th of it was stable too.
  double depth = 30;
};

/// Steps that were not tried or not met are NaN.
struct StepLimit {
  double stable;        // s, largest step such that all tested up to it were stable
  double unstable;      // s, smallest unstable step tested
  Broken limited_by;    // what broke there; nothing: all steps tested were stable
  double stable_above;  // s, largest stable step above `unstable`: not monotone
  double finest;        // s, smallest step tested
  int runs;
  bool resolved;  // unstable / stable is within the resolution, or nothing was unstable
  bool complete;  // and all was stable down to the depth: nobody gave up
};

/// Scans from coarse to fine. At the first stable step it bisects (geometrically) between
/// `stable` and `unstable`, then goes on down to the depth, where the next unstable step
/// begins anew. An empty answer of `judge` ends the search.
StepLimit find_step_limit(const StepSearch& search,
                          const std::function<std::optional<Broken>(double dt)>& judge);

}  // namespace tress::experiments
