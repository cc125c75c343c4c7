#include "experiments/hard_cases/course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "experiments/numerics/tip_track.h"
#include "integrators/catalogue.h"

namespace tress::experiments::hard_cases {
namespace {

/// Also stops wherever the tip is compared: the method knows the motion within its long
/// steps better than an interpolant of their ends.
void stop_at_samples(double horizon, std::vector<double>& stops) {
  for (int k = 1; k <= Reference::samples; ++k) {
    stops.push_back(TipSamples::time(horizon, k, Reference::samples));
  }
  std::ranges::sort(stops);
  stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
}

/// These two factor a dense matrix if their Jacobian is exact.
bool dense(const Situation& s, std::string_view model) {
  return (model == "kirchhoff_nodal" || model == "force_transport") &&
         s.parameters.word("jacobian") == "exact";
}

double work(const Stats& stats, double unknowns, bool dense) {
  const double factors = dense ? unknowns * unknowns * unknowns / 1500 : 0;
  return unknowns * static_cast<double>(stats.residuals + stats.newton_iterations +
                                        stats.sweeps) +
         factors * static_cast<double>(stats.linearizations);
}

/// Steps of the same length, each followed by the impulses that it needs.
Simulation run_rubbing(Integrator& method, Situation& s, const Course& c,
                       const Observer& each_step) {
  MaterialPoints& points = *s.system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count())), u(x.size());
  const Loop loop = [](std::size_t count, const std::function<void(std::size_t)>& work) {
    for (std::size_t i = 0; i < count; ++i) work(i);
  };
  s.system->reset();
  Status status = method.start(0, s.start.q, s.start.v);
  s.rubbing->add(*s.system, method, c.options);
  double t = 0;
  const double end = c.stops.back();
  const double count = std::max(1.0, std::ceil(end / c.options.step - 1e-9));
  for (double i = 1; i <= count && status == Status::ok; ++i) {
    const double next = end * i / count;
    points.positions(t, method.q(), x);
    s.rubbing->before_step(x, loop);
    status = method.advance(next, {});
    if (status != Status::ok) break;
    points.positions(next, method.q(), x);
    points.velocities(next, method.q(), method.v(), u);
    status = s.rubbing->after_step(next, next - t, x, u, loop);
    t = next;
    if (!each_step(t, method.q(), method.v())) status = Status::fatal;
  }
  const std::string& why = s.rubbing->failure();
  return {
      status,
      why.empty() ? method.failure() : why,
      t,
      {{method.q().begin(), method.q().end()}, {method.v().begin(), method.v().end()}},
      method.stats(),
      method.limit()};
}

}  // namespace

Options Pace::applied(Options options) const {
  options.tolerance = tolerance;
  (tolerance > 0 ? options.max_step : options.step) = step;
  return options;
}

void Pace::identify(Row& row) const {
  row.set("dt_s", step);
  if (tolerance > 0) row.set("position_tol_rel", tolerance);
}

Course course(const Attempt& attempt) {
  constexpr double even = 1.5, jumping = 150;
  const HardCase& hard = *attempt.hard;
  const double dt = attempt.pace.step;
  const bool by_tolerance = attempt.pace.tolerance > 0;
  Course c{attempt.pace.applied(attempt.options), {}, even};
  const double t_end = hard.count > 0
                           ? static_cast<double>(hard.count) * attempt.shorter * dt
                           : hard.t_end;
  if (hard.stops != nullptr) {
    c.stops = hard.stops(dt, t_end);
    c.growth = jumping;
  } else {
    c.stops = {by_tolerance ? t_end : std::max(1.0, std::ceil(t_end / dt - 1e-9)) * dt};
  }
  if (by_tolerance && hard.horizon > 0) stop_at_samples(hard.horizon, c.stops);
  return c;
}

Watched watch(std::string_view integrator, const HardCase& hard, const Subject& subject,
              Situation& s, const Course& c, const WorkLimit& limit,
              const Observer& each_step) {
  std::optional<TipSamples> tip;
  if (hard.horizon > 0) {
    tip.emplace(*s.system, hard.horizon, Reference::samples, c.growth);
    s.system->reset();
    tip->start(s.start.q, s.start.v);
  }
  const Layout layout = s.system->layout();
  const double unknowns = layout.coordinates + layout.constraints;
  const bool full = dense(s, subject.model->id);
  const auto method = make_integrator(integrator, *s.system, c.options);
  bool cut = false;
  const Observer each = [&](double t, In q, In v) {
    if (tip) tip->step_to(t, q, v);
    cut = work(method->stats(), unknowns, full) > limit.most;
    return !cut && each_step(t, q, v);
  };
  Simulation end = s.rubbing ? run_rubbing(*method, s, c, each)
                             : run_method(*method, *s.system, s.start, c.stops, {}, each);
  return {std::move(end), tip ? std::move(tip->tips) : std::vector<double>(), cut};
}

}  // namespace tress::experiments::hard_cases
