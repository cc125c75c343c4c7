#include <limits>

#include "experiments/other_simulators/rubbing.h"
#include "experiments/other_simulators/simbody_block.h"

namespace tress::experiments::other_simulators {
namespace {

double slope(const Slope& slope, double dt) {
  const Vec g = slope.gravity(), half = Slope::half, moments = Slope::moments();
  const SimbodyBlock block{
      {g.x, g.y, g.z}, {half.x, half.y, half.z}, {moments.x, moments.y, moments.z},
      Slope::mass,     slope.friction,           Slope::settling,
      Slope::watched};
  try {
    return block.way(dt);
  } catch (const std::exception&) {  // its step leads nowhere
    return std::numeric_limits<double>::quiet_NaN();
  }
}

constexpr RubbingMethod methods[] = {{"compliant, semi-explicit Euler", slope, nullptr}};

}  // namespace

std::span<const RubbingMethod> simbody_rubbing() { return methods; }

}  // namespace tress::experiments::other_simulators
