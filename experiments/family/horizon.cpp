#include "experiments/family/horizon.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "contract/constants.h"
#include "experiments/numerics/tip_track.h"
#include "integrators/catalogue.h"
#include "integrators/control/point_norm.h"
#include "simulation/groom/random.h"

namespace tress::experiments::family {
namespace {

/// Positions and velocities of all points.
struct Points {
  std::vector<double> x, u;
};

/// A run that goes on from sample to sample.
class Run {
 public:
  explicit Run(const Side& side) : Run(side, initial_state(side.system)) {}

  Run(const Side& side, const State& start)
      : points_(*side.system.material_points()),
        method_(make_integrator(side.integrator, side.system, side.options)),
        x_(3 * static_cast<std::size_t>(points_.count())) {
    side.system.reset();
    status_ = method_->start(0, start.q, start.v);
  }

  /// Appends the tip at t; false: the run ends before.
  bool advance(double t, std::vector<double>& tips) {
    if (!go_to(t)) return false;
    points_.positions(t, method_->q(), x_);
    tips.insert(tips.end(), x_.end() - 3, x_.end());
    return true;
  }

  bool advance(double t, Points& now) {
    if (!go_to(t)) return false;
    now = {x_, x_};
    points_.positions(t, method_->q(), now.x);
    points_.velocities(t, method_->q(), method_->v(), now.u);
    return true;
  }

 private:
  bool go_to(double t) {
    if (status_ == Status::ok) status_ = method_->advance(t);
    return status_ == Status::ok;
  }

  MaterialPoints& points_;
  std::unique_ptr<Integrator> method_;
  std::vector<double> x_;
  Status status_ = Status::ok;
};

/// The first state with other velocities, random ones that lie `apart` from its own.
State deviated(System& system, std::uint64_t stream, double apart,
               integrators::PointNorm& norm) {
  system.reset();
  State state = initial_state(system);
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count())), u(x), w(x);
  points.positions(0, state.q, x);
  points.velocities(0, state.q, state.v, u);
  std::vector<double> q_typ(state.q.size()), step(state.v.size()), other = state.v;
  system.scale(q_typ, step);
  Random random(1, stream);
  for (std::size_t i = 0; i < step.size(); ++i) {
    step[i] *= random.uniform() - 0.5;
    other[i] += step[i];
  }
  points.velocities(0, state.q, other, w);
  norm.start(points, x);
  const double factor = apart / norm.of(x, u, x, w);  // velocities are linear in v
  for (std::size_t i = 0; i < step.size(); ++i) state.v[i] += factor * step[i];
  return state;
}

/// At the samples; fewer if the run ends before.
std::vector<Points> path(const Side& side, const State& start, double t_end, int samples,
                         int until) {
  Run run(side, start);
  std::vector<Points> all;
  for (int k = 1; k <= until; ++k) {
    Points& now = all.emplace_back();
    if (!run.advance(TipSamples::time(t_end, k, samples), now)) {
      all.pop_back();
      break;
    }
  }
  return all;
}

}  // namespace

double growth(const Side& side, double t_end, int samples, int until, double apart) {
  constexpr std::uint64_t tries = 8;
  const auto plain = path(side, initial_state(side.system), t_end, samples, until);
  const auto count = static_cast<std::size_t>(until);
  if (until == 0 || plain.size() < count) return 0;
  double most = 0;
  for (std::uint64_t stream = 0; stream < tries; ++stream) {
    integrators::PointNorm norm;
    const State start = deviated(side.system, stream, apart, norm);
    const auto other = path(side, start, t_end, samples, until);
    if (other.size() < count) continue;
    // From the end on: the tip's squares, and the strand's deviation where they begin.
    double squares = 0;
    for (std::size_t k = count; k-- > 0;) {
      const Points &a = plain[k], &b = other[k];
      const std::size_t tip = a.x.size() - 3;
      const double off = tress::norm(load3(&a.x[tip]) - load3(&b.x[tip])) / norm.length();
      squares += off * off;
      const double at =
          k > 0 ? norm.of(plain[k - 1].x, plain[k - 1].u, other[k - 1].x, other[k - 1].u)
                : apart;
      most = std::max(most, std::sqrt(squares / static_cast<double>(until)) / at);
    }
  }
  return most;
}

double free_growth(double t_end, double length) {
  return 1 + t_end / std::sqrt(length / earth_gravity);
}

Horizon horizon(const Side& one, const Side& other, double t_end, int samples,
                double length, double apart) {
  Run first(one), second(other);
  Horizon found;
  for (int k = 1; k <= samples; ++k) {
    const double t = TipSamples::time(t_end, k, samples);
    std::vector<double> tip = found.tip, beside = found.other;
    if (!first.advance(t, tip) || !second.advance(t, beside)) return found;
    // Not a number is apart, too.
    found.parted = !(tip_error(tip, beside, length) <= apart);
    if (found.parted) return found;
    found.tip = std::move(tip);
    found.other = std::move(beside);
  }
  return found;
}

}  // namespace tress::experiments::family
