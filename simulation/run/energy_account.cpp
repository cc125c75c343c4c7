#include "simulation/run/energy_account.h"

#include <algorithm>
#include <cmath>

namespace tress::simulation {
namespace {

constexpr double sound_share = 0.1;
constexpr double whip = 30;  // square of tip speed over mean square speed

}  // namespace

void EnergyMeasure::move_with(const RootPose& root, const Points& p, In load, Out u) {
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    const double m = p.mass[i];
    const Vec r = load3(&p.x[3 * i]) - root.x, v = load3(&p.v[3 * i]);
    const Vec turning = cross(root.omega, r), w = root.v + turning, relative = v - w;
    const Vec carried = root.a + cross(root.alpha, r) + cross(root.omega, turning);
    kinetic += m * (dot(w, w) / 2 - dot(v, w));
    driven += m * dot(w, w) / 2;
    power -= dot(load3(&load[3 * i]), w) + m * dot(carried, relative);
    store3(relative, &u[3 * i]);
  }
}

void EnergyMeasure::touch(const Effect& effect, double t, In x, double segment,
                          double mass) {
  const double thrown = 2 * effect.surface_speed(t, x, segment);
  driven += mass * thrown * thrown / 2;
}

double EnergyAccount::share(double kinetic, double elastic) {
  return sound_share * (kinetic + std::max(0.0, elastic));
}

void EnergyAccount::start(double t, const EnergyMeasure& begin, double slack) {
  energy_ = begin.kinetic + begin.potential;
  slack_ = slack;
  seen_ = t;
  power_ = begin.power;
  work_ = 0;
  driven_ = begin.driven;
  lowest_ = begin.potential;
  excess_ = 0;
}

void EnergyAccount::gather(double t, const EnergyMeasure& now) {
  work_ += std::max({0.0, power_, now.power}) * (t - seen_) + now.work;
  seen_ = t;
  power_ = now.power;
  driven_ = std::max(driven_, now.driven);
  lowest_ = std::min(lowest_, now.potential);
  excess_ = std::max(excess_, gain(now) - (allowed() - slack_));
}

void EnergyAccount::shift(double t, const EnergyMeasure& before,
                          const EnergyMeasure& now) {
  energy_ += gain(now) - gain(before);
  lowest_ += now.potential - before.potential;
  seen_ = t;
  power_ = now.power;
}

double EnergyAccount::gain(const EnergyMeasure& now) const {
  return now.kinetic + now.potential - energy_;
}

double EnergyAccount::allowed() const {
  return slack_ + (1 + sound_share) * work_ + driven_;
}

double EnergyAccount::fastest(double mass) const {
  return std::sqrt(whip * 2 * (energy_ + allowed() - lowest_) / mass);
}

EnergyAccount::Memory EnergyAccount::memory() const {
  return {energy_, slack_, seen_, power_, work_, driven_, lowest_, excess_};
}

void EnergyAccount::recall(In memory) {
  energy_ = memory[0];
  slack_ = memory[1];
  seen_ = memory[2];
  power_ = memory[3];
  work_ = memory[4];
  driven_ = memory[5];
  lowest_ = memory[6];
  excess_ = memory[7];
}

}  // namespace tress::simulation
