#include "simulation/scene/turning_bodies.h"

#include <algorithm>

#include "contract/input_error.h"

namespace tress::simulation {

bool turns(const EffectChoice& choice) {
  return choice.parameters.knows("inertia_kg_m2") &&
         choice.parameters.word("moves") == "turns";
}

bool has_turning_bodies(const Scene& scene) {
  return std::ranges::any_of(scene.effects, turns);
}

std::vector<std::string> turning_body_names(const Scene& scene) {
  const std::vector<std::string> all = effect_names(scene);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (turns(scene.effects[i])) names.push_back(all[i]);
  }
  return names;
}

void check_turning_bodies(const Scene& scene, const std::vector<std::string>& places,
                          std::size_t strands) {
  const auto body = std::ranges::find_if(scene.effects, turns);
  if (body == scene.effects.end()) return;
  const std::string& place =
      places[static_cast<std::size_t>(body - scene.effects.begin())];
  for (const EffectChoice& choice : scene.effects) {
    refuse_if(
        choice.parameters.knows("friction_law") &&
            choice.parameters.word("friction_law") == "exact",
        "moves = \"turns\" next to friction_law = \"exact\", whose solver takes the "
        "motion of bodies as given",
        place, "use friction_law = \"regularised\" for all bodies");
  }
  refuse_if(
      strands > 1 && scene.failed_strands == FailedStrands::stay,
      "failed_strands = \"stay\" for strands that turn a body, which are one system",
      place, "leave out failed_strands");
  refuse_if(
      scene.strands_touch(),
      "moves = \"turns\" with effects between strands, which act on one strand at a "
      "time",
      place, "leave out the effects between strands");
  refuse_if(scene.rest == RestStrains::inverse,
            "moves = \"turns\" with rest = \"inverse\", which holds the body where it is",
            place, "leave out rest");
}

}  // namespace tress::simulation
