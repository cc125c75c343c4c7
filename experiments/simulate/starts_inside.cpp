#include "experiments/simulate/starts_inside.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/run/message.h"
#include "simulation/groom/guide_choice.h"

namespace tress::experiments::scene_runs {
namespace {

/// Files give places to a micrometre.
constexpr double rounding = 1e-6;  // m

}  // namespace

StartsInside::StartsInside(const Scene& scene)
    : scene_(scene),
      supports_(scene),
      first_point_(!scene.strands.empty() && scene.strands.front().free_root ? 0 : 1) {
  if (scene.strands.empty() || scene.rest == RestStrains::inverse) return;
  const std::vector<std::string> names = effect_names(scene);
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    const Parameters& given = scene.effects[i].parameters;
    if (!given.knows("strand_radius_m")) continue;
    std::shared_ptr<const Effect> effect = make_effect(scene, scene.effects[i]);
    if (effect == nullptr || !effect->penetration(0, {})) continue;
    bodies_.push_back({names[i], given.word("normal") == "rigid",
                       given.number("strand_radius_m"), std::move(effect)});
  }
}

/// A strand whose points are not where its geometry has them was led to its supports: it
/// begins in an equilibrium.
bool StartsInside::led_onto_supports(std::size_t strand, In x) const {
  if (!supports_.hold(strand)) return false;
  const std::vector<Vec> own = initial_points(scene_.strands.at(strand));
  double moved = 0;
  for (std::size_t i = 0; i < own.size() && 3 * i < x.size(); ++i) {
    moved = std::max(moved, norm(load3(&x[3 * i]) - own[i]));
  }
  return moved > rounding;
}

void StartsInside::look(In x) {
  const std::size_t strand = strands_++;
  if (led_onto_supports(strand, x)) return;
  for (InBody& body : bodies_) {
    const auto depth = [&](std::size_t first, std::size_t numbers) {
      return *body.effect->penetration(0, x.subspan(first, numbers)) - body.radius;
    };
    const std::size_t first = std::min(3 * first_point_, x.size());
    const double deepest = depth(first, x.size() - first);
    if (deepest <= rounding) continue;
    ++body.strands;
    if (deepest <= body.depth) continue;
    body.depth = deepest;
    body.deepest = strand;
    body.point = first_point_;
    while (depth(3 * body.point, 3) < deepest) ++body.point;
  }
}

std::vector<std::string> StartsInside::warnings() const {
  std::vector<std::string> all;
  for (const InBody& body : bodies_) {
    if (body.strands == 0) continue;
    const std::string of_all =
        strands_ == 1
            ? ""
            : fmt::format(", the deepest of {} of {} strands", body.strands, strands_);
    all.push_back(fmt::format(
        "strand {} begins {:.3g} m inside {} (point {}{}), and contact assumes a start "
        "outside: {}; move the strand or the body",
        body.deepest, body.depth, body.name, body.point, of_all,
        body.rigid ? "a rigid surface does not bring it out"
                   : "the surface expels it with energy that no load has given"));
  }
  return all;
}

void tell_starts_inside(const Scene& scene, const StartsInside& inside) {
  for (const std::string& warning : inside.warnings()) {
    tell("simulate: warning: {}: {}\n", scene.name, warning);
  }
}

}  // namespace tress::experiments::scene_runs
