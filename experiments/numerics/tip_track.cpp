#include "experiments/numerics/tip_track.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/catalogue.h"
#include "simulation/run/simulation.h"
#include "simulation/run/timing.h"

namespace tress::experiments {

TipSamples::TipSamples(System& system, double t_end, int count, double growth)
    : points_(*system.material_points()),
      t_end_(t_end),
      count_(count),
      growth_(growth),
      x_(3 * static_cast<std::size_t>(points_.count())) {}

void TipSamples::start(In q, In v) {
  tips.clear();
  before_ = read(0, q, v);
}

void TipSamples::step_to(double t, In q, In v) {
  const double h = t - before_.t;
  // Only a step that ends beyond the next sample time is read.
  if (next() <= t + growth_ * h) {
    const End now = read(t, q, v);
    while (3 * static_cast<std::size_t>(count_) > tips.size() && next() <= t) {
      interpolate(now);
    }
    before_ = now;
  } else {
    before_.t = t;
  }
}

double TipSamples::next() const {
  return time(t_end_, static_cast<int>(tips.size() / 3) + 1, count_);
}

TipSamples::End TipSamples::read(double t, In q, In v) {
  const std::size_t last = x_.size() - 3;
  points_.positions(t, q, x_);
  const Vec x = load3(&x_[last]);
  points_.velocities(t, q, v, x_);
  return {t, x, load3(&x_[last])};
}

void TipSamples::interpolate(const End& now) {
  const double h = now.t - before_.t, s = (next() - before_.t) / h, r = 1 - s;
  const Vec x = r * r * (1 + 2 * s) * before_.x + s * s * (1 + 2 * r) * now.x +
                h * s * r * (r * before_.u - s * now.u);
  tips.insert(tips.end(), {x.x, x.y, x.z});
}

TipRun run_tip(std::string_view integrator, System& system, const Options& options,
               double t_end, int samples, int repeat, Guard* guard) {
  // Of all adaptive methods here SUNDIALS' increases steps the most, tenfold.
  constexpr double even = 1.5, uneven = 15;
  const auto method = make_integrator(integrator, system, options);
  const State start = initial_state(system);
  TipSamples seen(system, t_end, samples,
                  find_integrator(integrator).adaptive ? uneven : even);
  std::vector<double> stops{t_end};
  if (options.tolerance > 0) {
    stops.resize(static_cast<std::size_t>(samples));
    for (int k = 1; k <= samples; ++k) {
      stops[static_cast<std::size_t>(k) - 1] = TipSamples::time(t_end, k, samples);
    }
  }
  const auto run = [&](const Observer& observer) {
    return run_method(*method, system, start, stops, {}, observer);
  };
  system.reset();
  seen.start(start.q, start.v);
  if (guard != nullptr) guard->start(0, start.q, start.v);
  Simulation first = run([&](double t, In q, In v) {
    if (guard != nullptr && !(*guard)(t, q, v)) return false;
    seen.step_to(t, q, v);
    return true;
  });
  if (guard != nullptr) conclude(*guard, integrator, options, first);
  const bool timed = repeat > 0 && first.status == Status::ok;
  const double wall = timed ? time_run(repeat, [&] { static_cast<void>(run({})); }) : 0;
  return {first.status, first.failure,        first.stats,
          wall,         std::move(seen.tips), system.layout().coordinates,
          first.limit};
}

double tip_error(In tip, In reference, double length) {
  if (tip.size() != reference.size()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = 0; i < tip.size(); ++i) {
    sum += (tip[i] - reference[i]) * (tip[i] - reference[i]);
  }
  const double error = std::sqrt(3 * sum / static_cast<double>(tip.size())) / length;
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

double largest_tip_error(In tip, In reference, double length) {
  if (tip.size() != reference.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < tip.size(); i += 3) {
    const double distance = norm(load3(&tip[i]) - load3(&reference[i]));
    if (!std::isfinite(distance)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, distance);
  }
  return largest / length;
}

}  // namespace tress::experiments
