#include "simulation/gradient/contact_at_stops.h"

#include <algorithm>

#include "contract/forms/contact_form.h"
#include "simulation/gradient/run_stops.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {

bool near_change(std::span<const double> changes, double t, double step) {
  constexpr double rounding = 1e-9;
  return std::ranges::any_of(changes, [&](double change) {
    return change >= t - rounding * step && change <= t + (1 + rounding) * step;
  });
}

bool begins_inside(const Scene& scene, std::size_t strand) {
  constexpr double rounding = 1e-9;  // over the length of the strand
  const auto system = exact_system_of(scene, strand);
  ContactForm* const contacts = system->contact_form();
  if (contacts == nullptr || contacts->complementarity() == nullptr) return false;
  std::vector<double> q(static_cast<std::size_t>(system->layout().coordinates)), v(q);
  system->initial_state(q, v);
  if (contacts->complementarity()->take(0, q, v, q, v) == 0) return false;
  const std::vector<double> x = points_at(*system, 0, q);
  const Effects effects = make_effects(scene);
  return std::ranges::any_of(effects, [&](const auto& effect) {
    const double depth = effect->penetration(0, x).value_or(0);
    return depth > rounding * scene.strands[strand].length();
  });
}

}  // namespace tress::simulation
