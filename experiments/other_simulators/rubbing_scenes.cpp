#include <cmath>

#include "experiments/other_simulators/rubbing.h"

namespace tress::experiments::other_simulators {

Vec Slope::gravity() const {
  const double angle = std::atan(tangent);
  return 9810 * Vec{std::sin(angle), 0, -std::cos(angle)};
}

Vec Slope::moments() {
  const Vec square{half.x * half.x, half.y * half.y, half.z * half.z};
  return (mass / 3) * Vec{square.y + square.z, square.x + square.z, square.x + square.y};
}

double Capstan::link_length() const {
  return 2 * (radius + link_radius) * std::tan(turn() / 2);
}

double Capstan::moment() const { return mass * link_length() * link_length() / 12; }

// From -x over the top to +x.
double Capstan::angle(int i) const { return (i + 0.5) * turn() - std::numbers::pi / 2; }

Vec Capstan::centre(int i) const {
  const double r = radius + link_radius;
  return {r * std::sin(angle(i)), 0, r * std::cos(angle(i))};
}

Vec Capstan::joint(int i) const {
  const double r = (radius + link_radius) / std::cos(turn() / 2);
  const double at = i * turn() - std::numbers::pi / 2;
  return {r * std::sin(at), 0, r * std::cos(at)};
}

double Capstan::slides_at() const {
  const double grip = friction * std::tan(turn() / 2);
  return std::pow((1 + grip) / (1 - grip), links);
}

}  // namespace tress::experiments::other_simulators
