#include "simulation/head/head_guard.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tress::simulation {
namespace {

constexpr double share = 0.1;  // of errors in sound steps

double specific_speed(const models::HeadEnergy& one) {
  return std::sqrt(2 * (one.kinetic + one.elastic) / one.mass);
}

}  // namespace

double fastest(std::span<const models::HeadEnergy> each) {
  double most = 0;
  for (const models::HeadEnergy& one : each) most = std::max(most, specific_speed(one));
  return most;
}

HeadGuard::HeadGuard(HeadReach reach, double speed)
    : reach_(std::move(reach)), speed_(speed) {}

HeadGuard::Bound HeadGuard::at(double t) const {
  const models::RootPose pose = reach_.motion.at(t);
  const double turns = norm(pose.omega), r = reach_.radius;
  const double speed = norm(pose.v) + turns * r;
  return {speed, norm(reach_.gravity - pose.a) + (norm(pose.alpha) + turns * turns) * r +
                     reach_.drag * speed};
}

void HeadGuard::start(double fastest) { speed_ = fastest + at(0).speed; }

void HeadGuard::step(double t, double h, double longest) {
  const double parts = std::max(1.0, std::ceil(h / longest - 1e-9)), part = h / parts;
  for (double i = 0; i < parts; ++i) {
    const double from = t + i * part;
    speed_ += part * std::max(at(from).growth, at(from + part).growth);
  }
}

bool HeadGuard::breached(double t, const models::HeadEnergy& one) const {
  return !(specific_speed(one) <= (1 + share) * (speed_ + at(t).speed));
}

}  // namespace tress::simulation
