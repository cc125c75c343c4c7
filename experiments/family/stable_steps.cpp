// Largest stable step of backward_euler with the exact Jacobian, rod by rod.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <string>

#include "experiments/family/family.h"
#include "experiments/numerics/stability.h"
#include "experiments/problems/strand_scenes.h"

namespace tress::experiments::family {
namespace {

constexpr Claim claims[] = {
    {"exact_step_100ms",
     "backward_euler with the exact Jacobian is stable at every step tried up to 100 ms",
     "largest stable step of super_helix with twist (s); 1e-4: none from 1 ms on"},
    {"exact_step_100ms_bend",
     "backward_euler without twist (modes = bend) is stable at every step up to 100 ms",
     "largest stable step of super_helix without twist (s); 1e-4: none from 1 ms on"},
    {"super_helix_step_longer", "super_helix is stable at steps at least as long as der",
     "largest stable step of super_helix over that of der"}};

constexpr double t_end = 0.5;  // s
// Half a decade apart. Stability is not monotone: a step counts when all shorter ones of
// the ladder are stable. One shorter step decides between two models that are both
// unstable at the first of those; for other rods it would take most of the study's time.
constexpr std::array ladder{1e-3, 0.01 / 3, 0.01, 0.1 / 3, 0.1};
constexpr double shorter = 1e-3 / 3;
constexpr double nothing_stable = 1e-4;  // s, value of "none of these" in ratios

/// Returns the bound of strand_speed_bound, where air moves at w or less relative to the
/// clamp. Drag c = nu/(rho A) per mass gives u u' <= c (w - u) u <= c w^2/4. That adds c
/// w^2 t/2 to u^2, the square of the root mean square speed. The tip's speed is at most
/// sqrt(30) of that.
double speed_bound(const Rod& rod, const Parameters& p) {
  const double c = rod.drag / rod.mass_per_length();
  const double w = rod.drive == Drive::wind ? wind_speed(rod) : root_speed(rod);
  const double calm = strand_speed_bound(p, t_end);  // sqrt(30) sqrt(2 g L)
  return std::sqrt(calm * calm + 30 * c * w * w * t_end / 2);
}

StabilityBounds bounds_of(const Rod& rod, const Parameters& p, System& system) {
  const bool driven = rod.drive != Drive::release;
  const StrandScene scene{"family", "", {}, t_end, StabilityBounds::none, driven};
  StabilityBounds bounds = stability_bounds(scene, p, system);
  if (driven) bounds.speed = speed_bound(rod, p);
  return bounds;
}

/// The longest of ascending steps such that it and all shorter ones are stable; 0 if
/// there is none.
double longest_stable(const Rod& rod, std::string_view model, std::string_view modes,
                      std::span<const double> steps) {
  const int elements = elements_of(rod);
  const auto system = make_system(rod, model, elements, modes);
  const StabilityBounds bounds =
      bounds_of(rod, parameters_of(rod, model, elements), *system);
  const State start = perturbed_start(*system);
  const auto broken = std::ranges::find_if_not(steps, [&](double dt) {
    Options options;
    options.step = dt;
    return judge_run("backward_euler", *system, options, start, t_end, bounds)->stable();
  });
  return broken == steps.begin() ? 0 : *std::prev(broken);
}

std::vector<Row> run(const Rod& rod, const Row& row) {
  double twisting = longest_stable(rod, "super_helix", "bend_twist", ladder);
  const double bending = longest_stable(rod, "super_helix", "bend", ladder);
  double der = longest_stable(rod, "der", "", ladder);
  Row with = row;
  with.set("elements", elements_of(rod));
  const auto longest = [&](const Claim& claim, double dt) {
    return answer(with, claim, std::max(dt, nothing_stable), dt >= ladder.back());
  };
  const std::array rows{longest(claims[0], twisting), longest(claims[1], bending)};
  if (twisting == 0 && der == 0) {
    twisting = longest_stable(rod, "super_helix", "bend_twist", {&shorter, 1});
    der = longest_stable(rod, "der", "", {&shorter, 1});
  }
  const Row both = Row(with).set("reduced", twisting).set("maximal", der);
  const double ratio = std::max(twisting, nothing_stable) / std::max(der, nothing_stable);
  return {rows[0], rows[1], answer(both, claims[2], ratio, twisting >= der)};
}

}  // namespace

const Study stable_steps{"stable_steps", claims, run};

}  // namespace tress::experiments::family
