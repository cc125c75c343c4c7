#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "simulation/files/files.h"
#include "simulation/scene/scene.h"
#include "tests/harness/toy_process.h"
#include "tests/simulation/mutations.h"

namespace tress::test_malformed {

using namespace simulation;

std::vector<std::string> shipped_texts() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(TRESS_SCENES)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<std::string> texts;
  texts.reserve(files.size());
  for (const auto& file : files) texts.push_back(read_file(file.string()));
  return texts;
}

/// "problem (mutant.toml:line:column): remedy", one line.
bool has_place_and_remedy(const std::string& message) {
  static const std::regex form(R"([ -~\x80-\xff]+ \(mutant\.toml:\d+:\d+\): [ -~]+)");
  return std::regex_match(message, form);
}

/// Through the reader, and those that it refuses through the program as well: it says
/// the same and leaves nothing behind.
TEST(MalformedScenes, TwoHundredAreEachRefusedWithPlaceAndRemedy) {
  const std::vector<std::string> texts = shipped_texts();
  ASSERT_FALSE(texts.empty());
  testing_support::Mutations mutations(1);
  Toy simulate;
  int refused = 0;
  for (int i = 0; i < 2000 && refused < 200; ++i) {
    std::string text = texts[static_cast<std::size_t>(i) % texts.size()];
    for (std::size_t n = 1 + mutations.pick(3); n-- > 0;) text = mutations.spoilt(text);
    try {
      const Scene scene = parse_scene(text, "mutant.toml");
      EXPECT_NE(scene.model, nullptr);  // still a scene
    } catch (const InputError& error) {
      EXPECT_TRUE(has_place_and_remedy(error.what())) << error.what();
      ++refused;
      simulate.write("mutant.toml", text);
      const Toy::Result run = simulate.run("mutant.toml --out out --progress none");
      EXPECT_EQ(run.code, 2) << run.err;
      EXPECT_EQ(run.err, std::string("simulate: error: ") + error.what() + '\n');
      EXPECT_FALSE(simulate.exists("out"));
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << "\n" << text;
    }
  }
  EXPECT_EQ(refused, 200);
}

}  // namespace tress::test_malformed
