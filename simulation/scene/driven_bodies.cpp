#include "simulation/scene/driven_bodies.h"

#include <algorithm>

#include "contract/input_error.h"

namespace tress::simulation {

bool driven(const EffectChoice& choice) {
  if (!choice.parameters.knows("inertia_kg_m2")) return false;
  const std::string_view moves = choice.parameters.word("moves");
  return moves == "turns" || moves == "free";
}

bool has_driven_bodies(const Scene& scene) {
  return std::ranges::any_of(scene.effects, driven);
}

std::vector<DrivenName> driven_body_names(const Scene& scene) {
  const std::vector<std::string> all = effect_names(scene);
  std::vector<DrivenName> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const EffectChoice& choice = scene.effects[i];
    if (driven(choice)) {
      names.push_back({all[i], choice.parameters.word("moves") == "free"});
    }
  }
  return names;
}

void check_driven_bodies(const Scene& scene, const std::vector<std::string>& places,
                         std::size_t strands) {
  const auto body = std::ranges::find_if(scene.effects, driven);
  if (body == scene.effects.end()) return;
  const std::string& place =
      places[static_cast<std::size_t>(body - scene.effects.begin())];
  const std::string moves =
      "moves = \"" + std::string(body->parameters.word("moves")) + "\"";
  for (const EffectChoice& choice : scene.effects) {
    refuse_if(choice.parameters.knows("friction_law") &&
                  choice.parameters.word("friction_law") == "exact",
              moves +
                  " next to friction_law = \"exact\", whose solver takes the motion of "
                  "bodies as given",
              place, "use friction_law = \"regularised\" for all bodies");
  }
  refuse_if(
      strands > 1 && scene.failed_strands == FailedStrands::stay,
      "failed_strands = \"stay\" for strands that drive a body, which are one system",
      place, "leave out failed_strands");
  refuse_if(scene.strands_touch(),
            moves + " with effects between strands, which act on one strand at a time",
            place, "leave out the effects between strands");
  refuse_if(scene.rest == RestStrains::inverse,
            moves + " with rest = \"inverse\", which holds the body where it is", place,
            "leave out rest");
}

}  // namespace tress::simulation
