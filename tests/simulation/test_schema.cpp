#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "simulation/files/files.h"
#include "simulation/run/tip_paths.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/scene_check.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_text/schema.h"

namespace tress::test_schema {

using namespace simulation;

TEST(SceneSchema, IsThePageInTheScenesFolder) {
  EXPECT_EQ(read_file(TRESS_SCENES "/README.md"), scene_schema())
      << "write it anew: simulate --print-schema > scenes/README.md";
}

TEST(SceneDefaults, AreAShortSceneInWhichSomethingMoves) {
  const std::string text = scene_defaults();
  const Scene scene = parse_scene(text, "defaults.toml");
  EXPECT_EQ(scene.model->id, "super_helix");
  EXPECT_FALSE(scene.source.empty());
  EXPECT_EQ(scene.strands.size(), 1u);
  EXPECT_EQ(scene.effects.size(), 2u);
  EXPECT_LT(std::ranges::count(text, '\n'), 56);
  // Rest at an angle under gravity: it begins to fall, and nothing else drives it.
  EXPECT_EQ(scene.effects[0].entry->id, "gravity");
  EXPECT_EQ(dot(scene.strands[0].root.frame.e0,
                scene.effects[0].parameters.vec("gravity_m_s2")),
            0);
}

/// It runs to its end under the guard, and its steps resolve the motion: steps an eighth
/// as long move the tip by less than 1 % of the length. Hair swings out within a second:
/// the air takes at least half of the energy that it falls with.
TEST(SceneDefaults, RunAsTheyAreAndDamp) {
  Scene scene = parse_scene(scene_defaults(), "defaults.toml");
  scene.guard = true;
  const TipPaths paths = tip_paths(scene, 0);
  Scene fine = scene;
  fine.options.step /= 8;
  EXPECT_LT(distance_rel(paths, tip_paths(fine, 0), scene), 0.01);
  World world(scene);
  double largest = 0;
  for (std::size_t f = 1; f <= scene.last_frame(); ++f) {
    ASSERT_EQ(world.advance(scene.time_of(f)), Status::ok) << world.failure();
    largest = std::max(largest, world.energies().kinetic);
  }
  EXPECT_LT(world.energies().kinetic, 0.5 * largest);
}

/// What it shows has the values that hold without it, but for the method, its step and
/// what damps.
TEST(SceneDefaults, AreDefaults) {
  const Scene scene = parse_scene(scene_defaults(), "defaults.toml");
  const Scene bare =
      parse_scene("title = \"t\"\n[strand]\n[effects.gravity]\n", "bare.toml");
  EXPECT_EQ(scene.model, bare.model);
  EXPECT_EQ(scene.duration, bare.duration);
  EXPECT_EQ(scene.frame_rate, bare.frame_rate);
  EXPECT_EQ(scene.strands[0].segments.size(), bare.strands[0].segments.size());
}

/// A scene with the table `entry`, all of whose keys that every choice takes are there.
/// Whether a key of an effect applies where all others have their defaults.
bool used_by_default(const models::EffectEntry& effect, std::string_view key) {
  std::map<std::string_view, std::vector<Use>> by_choice;
  for (const auto& [choice, word, keys] : effect.uses) {
    by_choice[choice].push_back({word, keys});
  }
  return std::ranges::all_of(by_choice, [&](const auto& one) {
    const Parameter& choice =
        *std::ranges::find(effect.parameters, one.first, &Parameter::name);
    return used(one.second, words_of(choice.choices).front(), key);
  });
}

bool used_by_default(const TableEntry& entry, std::string_view key) {
  if (entry.name == "integrator") {
    Scene scene;
    scene.integrator =
        std::ranges::find(entry.parameters, "id", &Parameter::name)->default_text();
    return key == "id" || idle_option(scene, option_of(key)).empty();
  }
  constexpr std::string_view of_effect = "effects.";
  if (!entry.name.starts_with(of_effect)) return true;
  const std::string_view id = std::string_view(entry.name).substr(of_effect.size());
  const auto effect = std::ranges::find(models::effects(), id, &models::EffectEntry::id);
  return effect == models::effects().end() || used_by_default(*effect, key);
}

std::string with_table(const TableEntry& entry) {
  std::string text = "title = \"t\"\n";
  if (entry.name != "strand" && entry.name != "groom") text += "[strand]\n";
  // A straight strand on a support at its tip must stretch.
  if (entry.name == "supports") text += "[model]\nid = \"der\"\n";
  text += "[" + entry.name + "]\n";
  std::string_view word;
  for (const Parameter& p : entry.parameters) {
    if (p.name == entry.choice) word = words_of(p.choices).front();
  }
  for (const Parameter& p : entry.parameters) {
    // Rows and texts are empty by default: there they would say nothing.
    const bool says_nothing = (p.rows || p.text) && p.fallback.empty();
    const bool excluded = p.name == "poisson_ratio";  // by shear_modulus_pa
    if (says_nothing || excluded || !used(entry.uses, word, p.name)) continue;
    if (!used_by_default(entry, p.name)) continue;
    text += std::string(p.name) + " = " + default_value(p) + "\n";
  }
  return text;
}

TEST(SceneTables, TakeEveryKeyAtItsDefault) {
  for (const TableEntry& entry : table_entries()) {
    // The ends of joints have no default, and a natural shape needs rows.
    if (entry.name == "joints" || entry.name == "effects.natural_shape") continue;
    const std::string text = with_table(entry);
    SCOPED_TRACE(text);
    const Scene scene = parse_scene(text, "defaults.toml");
    EXPECT_EQ(scene.effects.size() == 1 || scene.tables->driven.any(),
              entry.name.starts_with("effects."));
    EXPECT_EQ(scene.strands.size(), entry.name == "groom" ? 100u : 1u);
  }
}

/// Whether a strand of some model can be driven as `text`, which ends in [integrator],
/// says: not every method takes every model.
bool some_model_takes(const IntegratorEntry& entry, const std::string& text) {
  for (const ModelEntry& model : model_catalogue()) {
    if (model.on_strand == nullptr) continue;
    for (const auto& [formulation, order] : entry.formulations) {
      try {
        parse_scene(text + "formulation = \"" + std::string(name(formulation)) +
                        "\"\n[strand]\n[model]\nid = \"" + std::string(model.id) + "\"\n",
                    "word.toml");
        return true;
      } catch (const InputError&) {
        continue;  // what is sought is one that goes
      }
    }
  }
  return false;
}

TEST(SceneTables, RefuseAnOptionOfAnotherIntegratorAndNameItsOwner) {
  try {
    parse_scene("title = \"t\"\n[strand]\n[integrator]\nid = \"rk4\"\nrho_inf = 0.5\n",
                "other.toml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("other.toml:5:"), std::string::npos) << text;
    EXPECT_NE(text.find("generalized_alpha"), std::string::npos) << text;
  }
}

TEST(SceneTables, TakeEveryWordWithItsKeys) {
  for (const TableEntry& entry : table_entries()) {
    for (const Use& use : entry.uses) {
      if (use.word == "skin") continue;  // has files, which test_mesh_body gives it
      std::string text = "title = \"t\"\n[" + entry.name + "]\n" +
                         std::string(entry.choice) + " = \"" + std::string(use.word) +
                         "\"\n";
      for (const Parameter& p : entry.parameters) {
        for (const std::string_view key : words_of(use.keys)) {
          if (p.name == key) text += std::string(key) + " = " + default_value(p) + "\n";
        }
      }
      if (entry.name == "root") text += "[strand]\n";
      if (entry.name == "integrator") {
        EXPECT_TRUE(some_model_takes(find_integrator(use.word), text)) << text;
        continue;
      }
      EXPECT_NO_THROW(parse_scene(text, "word.toml")) << text;
    }
  }
}

}  // namespace tress::test_schema
