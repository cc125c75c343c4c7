#include "experiments/numerics/drift_monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::experiments {
namespace {

// Beyond this length error the run counts as diverged.
constexpr double longest = 10;

double largest(In x) {
  double most = 0;
  for (const double entry : x) {
    if (!std::isfinite(entry)) return std::numeric_limits<double>::infinity();
    most = std::max(most, std::abs(entry));
  }
  return most;
}

}  // namespace

DriftMonitor::DriftMonitor(System& system, In q, In v, double escape)
    : constraints_(system.constraint_form()),
      energetics_(system.energetics()),
      points_(system.material_points()),
      escape_(escape),
      g_(static_cast<std::size_t>(system.layout().constraints)),
      g_dot_(g_.size()),
      g_start_(g_.size()) {
  if (energetics_ != nullptr) {
    const Energy e = energetics_->energy(0, q, v);
    energy_start_ = e.total();
    kinetic_max_ = e.kinetic;
  }
  if (constraints_ != nullptr && constraints_->value(0, q, g_start_) == Status::ok) {
    g_max_ = g_final_ = largest(g_start_);
  }
}

bool DriftMonitor::operator()(double t, In q, In v) {
  if (energetics_ != nullptr) {
    const Energy e = energetics_->energy(t, q, v);
    energy_error_ = std::max(energy_error_, std::abs(e.total() - energy_start_));
    kinetic_max_ = std::max(kinetic_max_, e.kinetic);
  }
  const auto stretch = points_ != nullptr ? points_->stretch(t, q) : std::nullopt;
  if (!stretch) {
    length_error_ = std::numeric_limits<double>::quiet_NaN();
  } else {
    length_error_ = std::max(length_error_, *stretch);
    escaped_ = !(*stretch <= longest);
  }
  if (constraints_ == nullptr) return !escaped_;
  if (constraints_->value(t, q, g_) != Status::ok) return false;
  if (constraints_->rate(t, q, v, g_dot_) != Status::ok) return false;
  g_final_ = largest(g_);
  g_max_ = std::max(g_max_, g_final_);
  g_rate_max_ = std::max(g_rate_max_, largest(g_dot_));
  if (g_final_ > threshold_) recovery_time_ = t;
  for (std::size_t k = 0; k < g_.size(); ++k) {
    if (g_start_[k] != 0) overshoot_ = std::max(overshoot_, -g_[k] / g_start_[k]);
  }
  escaped_ = escaped_ || !(g_final_ <= escape_);
  return !escaped_;
}

double DriftMonitor::energy_drift() const {
  if (energetics_ == nullptr) return std::numeric_limits<double>::quiet_NaN();
  return kinetic_max_ > 0 ? energy_error_ / kinetic_max_ : 0;
}

MomentumDrift::MomentumDrift(Energetics& energetics, In q, In v)
    : energetics_(energetics) {
  start_ = now_ = energetics_.momentum(0, q, v).value();
}

void MomentumDrift::see(double t, In q, In v) {
  now_ = energetics_.momentum(t, q, v).value();
  linear_ = std::max(linear_, distance(now_.linear, start_.linear));
  angular_ = std::max(angular_, distance(now_.angular, start_.angular));
}

double MomentumDrift::norm(const Three& x) { return std::hypot(x[0], x[1], x[2]); }

double MomentumDrift::distance(const Three& x, const Three& y) {
  return norm({x[0] - y[0], x[1] - y[1], x[2] - y[2]});
}

}  // namespace tress::experiments
