#include "simulation/groom/random.h"

#include <cmath>
#include <numbers>

namespace tress::simulation {
namespace {

/// Spreads neighbouring seeds (splitmix64, Steele, Lea & Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream)
    : bits_(mixed(mixed(seed) + stream)) {}

double Random::uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }

double Random::normal() {
  const double radius = std::sqrt(-2 * std::log1p(-uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

}  // namespace tress::simulation
