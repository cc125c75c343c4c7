#include <chrono>
#include <cmath>
#include <numbers>

#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {
namespace {

constexpr double amplitude = 50;                // of the clamp, mm
constexpr double omega = 2 * std::numbers::pi;  // of the clamp, 1/s

}  // namespace

double Swing::mass() const {
  return density * std::numbers::pi * radius * radius * link_length();
}

double Swing::moment() const {
  return mass() * (link_length() * link_length() / 12 + radius * radius / 4);
}

double Swing::stiffness(int hinge) const {
  const double bending = young * std::numbers::pi * std::pow(radius, 4) / 4;
  return (hinge == 0 ? 2 : 1) * bending / link_length();
}

Vec Swing::gravity(double t) {
  const double velocity = amplitude * omega * std::sin(omega * t);
  const double acceleration = amplitude * omega * omega * std::cos(omega * t);
  return {0, -acceleration - damping * velocity, gravity_z};
}

double Swing::clamp(double t) { return amplitude * (1 - std::cos(omega * t)); }

double Simulator::advance(double t, double dt, int steps) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  for (int i = 0; i < steps; ++i) step(t + i * dt);
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Vec rotation_vector(double w, const Vec& xyz) {
  const double sine = norm(xyz);
  if (sine == 0) return {};
  const double angle = 2 * std::atan2(w < 0 ? -sine : sine, std::abs(w));
  return (angle / sine) * xyz;
}

}  // namespace tress::experiments::other_simulators
