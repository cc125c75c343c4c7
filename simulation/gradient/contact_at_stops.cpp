#include "simulation/gradient/contact_at_stops.h"

#include <algorithm>
#include <memory>

#include "models/effects/effect.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/strand_options.h"

namespace tress::simulation {
namespace {

using models::Points;

/// Records the points on which effects act: nodes, or the points of a quadrature.
class SeenPoints final : public models::Effect {
 public:
  std::string_view name() const override { return "seen_points"; }
  models::Needs needs() const override { return {.position = true}; }
  void add_load(double, const Points& p, InOut) const noexcept override {
    x.clear();
    for (std::size_t i = static_cast<std::size_t>(p.held); i < p.length.size(); ++i) {
      if (!(p.length[i] > 0)) continue;  // touches nothing
      for (std::size_t k = 0; k < 3; ++k) x.push_back(p.x[3 * i + k]);
    }
  }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

  mutable std::vector<double> x;  // (3 points), m
};

std::vector<double> touchable_points(const Scene& scene, std::size_t strand) {
  const auto points = std::make_shared<SeenPoints>();
  const Strand& one = scene.strands[strand];
  const auto system = scene.model->on_strand(one, StrandOptions(scene).of(one), {points});
  std::vector<double> q(static_cast<std::size_t>(system->layout().coordinates)), v(q),
      a(q), r(q);
  system->initial_state(q, v);
  static_cast<void>(system->residual(0, q, v, a, r));
  return points->x;
}

}  // namespace

bool near_change(std::span<const double> changes, double t, double step) {
  constexpr double rounding = 1e-9;
  return std::ranges::any_of(changes, [&](double change) {
    return change >= t - rounding * step && change <= t + (1 + rounding) * step;
  });
}

bool begins_inside(const Scene& scene, std::size_t strand) {
  constexpr double rounding = 1e-9;  // over the length of the strand
  const models::Effects effects = make_effects(scene);
  if (!models::hold_contacts(effects)) return false;
  const std::vector<double> x = touchable_points(scene, strand);
  return std::ranges::any_of(effects, [&](const auto& effect) {
    const bool exact = effect->for_strand(0) != nullptr;
    const double depth = exact ? effect->penetration(0, x).value_or(0) : 0;
    return depth > rounding * scene.strands[strand].length();
  });
}

}  // namespace tress::simulation
