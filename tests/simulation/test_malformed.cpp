#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "simulation/files/files.h"
#include "simulation/scene/scene.h"
#include "tests/harness/toy_process.h"
#include "tests/simulation/mutations.h"
#include "tests/support/refusal.h"

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

std::string refusal_of(const std::string& text) {
  return testing_support::refusal([&] { parse_scene(text, "s.toml"); });
}

/// Tables are counted before any is read: once, 300 000 took 22 s of processor time.
TEST(MalformedScenes, OfTooManyStrandsAreRefusedBeforeOneIsMade) {
  std::string text = "title = \"t\"\n";
  for (int i = 0; i < 300'000; ++i) text += "[[strand]]\n";
  const std::clock_t start = std::clock();
  EXPECT_EQ(refusal_of(text),
            "300000 tables [[strand]] (s.toml:10002:1): give at most 10000: one [groom] "
            "makes many strands");
  EXPECT_THROW(parse_outline(text, "s.toml"), InputError);
  EXPECT_LT(static_cast<double>(std::clock() - start), 4.0 * CLOCKS_PER_SEC);
}

/// A whole number that a double would round is refused, what is below the least double is
/// 0, and what is beyond the largest, or longer than TOML's reader takes, is refused with
/// its place.
TEST(MalformedScenes, HaveNoNumbersThatAreReadAsOthers) {
  const std::string top = "title = \"t\"\n[strand]\n";
  EXPECT_EQ(refusal_of("title = \"t\"\nseed = 9007199254740993\n")
                .find("seed = 900719925474"
                      "0993 is out of "
                      "range (s.toml:2:8)"),
            0u);
  EXPECT_EQ(parse_scene("seed = 9007199254740991\n" + top, "s.toml").seed,
            9007199254740991u);
  const Scene tiny = parse_scene(top + "position_m = [1e-400, 1e-320, 0]\n", "s.toml");
  EXPECT_EQ(tiny.strands[0].root.position.x, 0);
  EXPECT_EQ(tiny.strands[0].root.position.y, 1e-320);
  for (const std::string& number :
       {std::string("1e400"), "0.1" + std::string(300, '0')}) {
    const std::string said = refusal_of(top + "length_m = " + number + "\n");
    EXPECT_NE(said.find("(s.toml:3:"), std::string::npos) << said;
  }
}

/// A byte order mark, line ends of two bytes and names of any characters are no faults.
TEST(Scenes, OfOtherEditorsAreRead) {
  const std::string text =
      "\xEF\xBB\xBFtitle = \"Frisur \xE2\x80\x93 \xE9\xAB\xAA, \\\"x\\\" "
      "<&>\"\r\n[strand]\r\n"
      "elements = 4\r\n";
  const Scene scene = parse_scene(text, "sc\xC3\xA8ne, \"\xE9\xAB\xAA\" <&>.toml");
  EXPECT_EQ(scene.title, "Frisur \xE2\x80\x93 \xE9\xAB\xAA, \"x\" <&>");
  EXPECT_EQ(scene.name, "sc\xC3\xA8ne, \"\xE9\xAB\xAA\" <&>");
  EXPECT_EQ(scene.strands[0].segments.size(), 4u);
}

/// Keys and values of any length and any bytes are quoted readably.
TEST(MalformedScenes, AreQuotedInOneShortLine) {
  const std::string key(4000, 'k');
  for (const std::string& text : {key + " = 1\n", "[effects." + key + "]\n",
                                  "[" + key + "]\n", "[model]\nid = \"" + key + "\"\n"}) {
    EXPECT_LT(refusal_of("title = \"t\"\n[strand]\n" + text).size(), 1500u);
  }
  const std::string said =
      refusal_of("title = \"t\"\n[model]\nid = \"a\\u0000b\\u001b[1m\"\n");
  EXPECT_EQ(said.find("id = 'a\\x00b\\x1b[1m' is unknown (s.toml:3:6)"), 0u) << said;
}

}  // namespace tress::test_malformed
