#include "simulation/scene/turning_bodies.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"

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
  refuse_if(
      strands > 1,
      fmt::format("moves = \"turns\" with {} strands, which the body would make one "
                  "system",
                  strands),
      place, "use a scene with one strand");
  const SceneSupports supports(scene);
  if (supports.any()) {
    throw InputError(fmt::format("moves = \"turns\" with {}, whose forces leave out the "
                                 "body's motion",
                                 supports.table_name()),
                     place, "leave out " + supports.table_name());
  }
  refuse_if(SceneJoints(scene).any(),
            "moves = \"turns\" with [joints], whose forces leave out the body's motion",
            place, "leave out [joints]");
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
