#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "experiments/harness/files.h"
#include "experiments/scenes/scene.h"
#include "experiments/scenes/scene_tables.h"
#include "experiments/scenes/schema.h"

namespace tress {
namespace {

TEST(SceneSchema, IsThePageInTheScenesFolder) {
  EXPECT_EQ(read_file(TRESS_SCENES "/README.md"), scene_schema())
      << "write it anew: simulate --print-schema > scenes/README.md";
}

TEST(SceneDefaults, AreAScene) {
  const Scene scene = parse_scene(scene_defaults(), "defaults.toml");
  EXPECT_EQ(scene.title, "defaults");
  EXPECT_EQ(scene.model->id, "super_helix");
  EXPECT_EQ(scene.strands.size(), 1u);
  EXPECT_TRUE(scene.effects.empty());
}

/// The defaults of which the table `name` is switched on.
std::string with_table(const std::string& name) {
  std::istringstream lines(scene_defaults());
  std::string scene, line;
  bool inside = false;
  while (std::getline(lines, line)) {
    if (line.starts_with("[") || line.starts_with("#[")) {
      inside = line == "#[" + name + "]" || line == "#[[" + name + "]]";
    }
    const bool key = line.starts_with("#") && !line.starts_with("# ");
    // Keys of other shapes than the default stay away, and files that do not exist.
    const bool idle = line.starts_with("#curl_") || line.starts_with("#wave") ||
                      line.starts_with("#fuzz") || line.starts_with("#correlation") ||
                      line.ends_with("= \"\"");
    scene += (inside && key && !idle ? line.substr(1) : line) + "\n";
  }
  return scene;
}

TEST(SceneDefaults, HoldEveryTableAtItsDefaults) {
  for (const TableEntry& entry : table_entries()) {
    if (entry.needed) continue;
    SCOPED_TRACE(entry.name);
    const std::string text = with_table(entry.name);
    EXPECT_NE(text, scene_defaults());
    const Scene scene = parse_scene(text, "defaults.toml");
    const bool one_effect = scene.effects.size() == 1 || scene.interaction.has_value();
    EXPECT_EQ(one_effect, entry.name.starts_with("effects."));
    EXPECT_EQ(scene.strands.size(), entry.name == "groom" ? 101u : 1u);
  }
}

TEST(SceneDefaults, HoldEveryWordWithItsKeys) {
  for (const TableEntry& entry : table_entries()) {
    for (const Use& use : entry.uses) {
      std::string text = "title = \"t\"\n[" + entry.name + "]\n" +
                         std::string(entry.choice) + " = \"" + std::string(use.word) +
                         "\"\n";
      for (const Parameter& p : entry.parameters) {
        for (const std::string_view key : words_of(use.keys)) {
          if (p.name == key) text += std::string(key) + " = " + default_value(p) + "\n";
        }
      }
      if (entry.name == "root") text += "[strand]\n";
      EXPECT_NO_THROW(parse_scene(text, "word.toml")) << text;
    }
  }
}

}  // namespace
}  // namespace tress
