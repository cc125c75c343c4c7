#include "experiments/family/horizon.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "contract/constants.h"
#include "experiments/numerics/tip_track.h"
#include "integrators/catalogue.h"
#include "integrators/control/point_norm.h"
#include "simulation/scene/random.h"

namespace tress::experiments::family {
namespace {

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
    if (status_ == Status::ok) status_ = method_->advance(t);
    if (status_ != Status::ok) return false;
    points_.positions(t, method_->q(), x_);
    tips.insert(tips.end(), x_.end() - 3, x_.end());
    return true;
  }

 private:
  MaterialPoints& points_;
  std::unique_ptr<Integrator> method_;
  std::vector<double> x_;
  Status status_ = Status::ok;
};

/// The first state with other velocities, at a deviation of this size.
State deviated(System& system, double apart) {
  system.reset();
  State state = initial_state(system);
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count())), u(x), w(x);
  points.positions(0, state.q, x);
  points.velocities(0, state.q, state.v, u);
  std::vector<double> q_typ(state.q.size()), step(state.v.size()), other = state.v;
  system.scale(q_typ, step);
  Random random(1, 0);
  for (std::size_t i = 0; i < step.size(); ++i) {
    step[i] *= random.uniform() - 0.5;
    other[i] += step[i];
  }
  points.velocities(0, state.q, other, w);
  integrators::PointNorm norm;
  norm.start(points, x);
  const double factor = apart / norm.of(x, u, x, w);  // velocities are linear in v
  for (std::size_t i = 0; i < step.size(); ++i) state.v[i] += factor * step[i];
  return state;
}

}  // namespace

double growth(const Side& side, In tip, double t_end, int samples, double length,
              double apart) {
  Run run(side, deviated(side.system, apart));
  std::vector<double> tips;
  while (tips.size() < tip.size()) {
    const int k = 1 + static_cast<int>(tips.size() / 3);
    if (!run.advance(TipSamples::time(t_end, k, samples), tips)) break;
  }
  return tips.empty() ? 0 : tip_error(tips, tip.first(tips.size()), length) / apart;
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
