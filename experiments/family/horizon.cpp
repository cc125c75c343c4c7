#include "experiments/family/horizon.h"

#include <memory>

#include "experiments/numerics/tip_track.h"
#include "integrators/catalogue.h"

namespace tress::experiments::family {
namespace {

/// A run that goes on from sample to sample.
class Run {
 public:
  explicit Run(const Side& side)
      : points_(*side.system.material_points()),
        method_(make_integrator(side.integrator, side.system, side.options)),
        x_(3 * static_cast<std::size_t>(points_.count())) {
    side.system.reset();
    const State start = initial_state(side.system);
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

}  // namespace

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
