#include "experiments/numerics/stability.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "contract/input_error.h"

namespace tress::experiments {
namespace {

bool finite(In x) {
  return std::ranges::all_of(x, [](double entry) { return std::isfinite(entry); });
}

/// Distance between the first and the last of `points` (3 each).
double first_to_last(const std::vector<double>& points) {
  const std::size_t tip = points.size() - 3;
  return std::hypot(points[tip] - points[0], points[tip + 1] - points[1],
                    points[tip + 2] - points[2]);
}

[[noreturn]] void missing(const std::string& what) {
  throw InputError("stability of this scene is judged by the model's " + what,
                   "stability judge", "choose a model that has it");
}

}  // namespace

std::string_view name(Broken broken) {
  switch (broken) {
    case Broken::nothing:
      return "nothing";
    case Broken::not_finite:
      return "not finite";
    case Broken::energy:
      return "energy";
    case Broken::reach:
      return "reach";
    case Broken::speed:
      return "speed";
    case Broken::stretch:
      return "stretch";
    case Broken::no_solution:
      break;
  }
  return "no solution";
}

StabilityJudge::StabilityJudge(System& system, const StabilityBounds& bounds,
                               const State& start)
    : bounds_(bounds) {
  if (bounds.energy < StabilityBounds::none) {
    energetics_ = system.energetics();
    if (energetics_ == nullptr) missing("energy");
    energy_start_ = energetics_->energy(0, start.q, start.v).total();
  }
  if (bounds.reach < StabilityBounds::none || bounds.speed < StabilityBounds::none) {
    points_ = system.material_points();
    if (points_ == nullptr) missing("material points");
    x_.resize(3 * static_cast<std::size_t>(points_->count()));
    u_.resize(x_.size());
  }
}

/// Comparisons are written so that NaN violates a bound.
bool StabilityJudge::operator()(double t, In q, In v) {
  if (energetics_ != nullptr) {
    const double gain = energetics_->energy(t, q, v).total() - energy_start_;
    see(run_.energy_gain, gain, bounds_.energy, Broken::energy);
  }
  if (points_ != nullptr) {
    points_->positions(t, q, x_);
    points_->velocities(t, q, v, u_);
    see(run_.reach, first_to_last(x_), bounds_.reach, Broken::reach);
    see(run_.speed, first_to_last(u_), bounds_.speed, Broken::speed);
  }
  return run_.stable();
}

void StabilityJudge::see(double& largest, double value, double bound, Broken kind) {
  largest = std::max(largest, value);
  if (value <= bound || !run_.stable()) return;
  run_.broken = std::isfinite(value) ? kind : Broken::not_finite;
}

StabilityRun StabilityJudge::verdict(const Simulation& run) const {
  StabilityRun result = run_;
  result.t = run.t;
  result.stats = run.stats;
  if (run.status != Status::ok && result.stable()) {
    const bool blown_up = !finite(run.state.q) || !finite(run.state.v);
    result.broken = blown_up ? Broken::not_finite : Broken::no_solution;
    result.failure = run.failure;
  }
  return result;
}

std::optional<StabilityRun> judge_run(std::string_view integrator, System& system,
                                      const Options& options, const State& start,
                                      double t_end, const StabilityBounds& bounds) {
  // 1e-9: a whole number of steps up to rounding gets no extra step.
  const double steps = std::max(1.0, std::ceil(t_end / options.step - 1e-9));
  const double end = options.tolerance > 0 ? t_end : steps * options.step;
  StabilityJudge judge(system, bounds, start);
  const Simulation run =
      simulate(integrator, system, options, start, end,
               [&judge](double t, In q, In v) { return judge(t, q, v); });
  StabilityRun verdict = judge.verdict(run);
  if (verdict.broken == Broken::no_solution &&
      work_used_up(options, run.stats, system.layout().coordinates)) {
    return {};
  }
  return verdict;
}

std::optional<StabilityRun> StabilityRuns::judge(double dt) {
  if (left_ <= 0) return {};
  options_.step = dt;
  options_.max_work = left_;
  auto run = judge_run(integrator_, system_, options_, start_, t_end_, bounds_);
  left_ -= run ? total_work(run->stats, system_.layout().coordinates) : left_;
  return run;
}

StepLimit step_limit(const TestedSteps& tested, double resolution) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  StepLimit limit{unknown, unknown, Broken::nothing, unknown, unknown,
                  0,       0,       false,           false};
  limit.runs = static_cast<int>(tested.size());
  if (!tested.empty()) limit.finest = tested.begin()->first;
  for (const auto& [dt, broken] : tested) {
    const bool below = std::isnan(limit.unstable);
    if (broken == Broken::nothing) {
      (below ? limit.stable : limit.stable_above) = dt;
      limit.stable_runs += below ? 1 : 0;
    } else if (below) {
      limit.unstable = dt;
      limit.limited_by = broken;
    }
  }
  const bool some_stable = !std::isnan(limit.stable);
  limit.resolved = some_stable && !(limit.unstable > limit.stable * resolution);
  return limit;
}

StepLimit find_step_limit(const StepSearch& search,
                          const std::function<std::optional<Broken>(double dt)>& judge) {
  TestedSteps tested;
  StepLimit limit = step_limit(tested, search.resolution);
  const auto test = [&](double dt) {
    const std::optional<Broken> broken = judge(dt);
    if (broken) tested[dt] = *broken;
    limit = step_limit(tested, search.resolution);
    return broken.has_value();
  };

  // 1e-6: rounding must not lose the last step of the scan.
  const double ratio = search.ratio;
  const int count =
      1 + static_cast<int>(std::log(search.coarsest / search.finest) / std::log(ratio) +
                           1e-6);
  for (int i = 0; i < count; ++i) {
    const double dt = search.coarsest * std::pow(ratio, -i);
    if (!test(dt)) return limit;
    while (!std::isnan(limit.stable) && !limit.resolved) {
      if (!test(std::sqrt(limit.stable * limit.unstable))) return limit;
    }
    if (limit.stable >= search.depth * dt) break;
  }
  limit.complete = true;
  return limit;
}

}  // namespace tress::experiments
