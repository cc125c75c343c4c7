#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "integrators/catalogue.h"

/// Reads the sources: time stepping is in integrators/ alone, and each of its numbers is
/// defined once.
namespace tress::test_one_definition {

struct Source {
  std::string path, text;
};

/// Sources of C++ below these folders.
std::vector<Source> sources(const std::vector<std::string>& folders) {
  const std::filesystem::path root = TRESS_SOURCE_DIR;
  std::vector<Source> all;
  for (const std::string& folder : folders) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(root / folder)) {
      const auto kind = entry.path().extension();
      if (kind != ".h" && kind != ".cpp" && kind != ".cu") continue;
      std::ifstream file(entry.path());
      all.push_back({std::filesystem::relative(entry.path(), root).string(),
                     {std::istreambuf_iterator<char>(file), {}}});
    }
  }
  return all;
}

/// Without comments and what is quoted, such as help texts.
std::string code(const std::string& text) {
  static const std::regex words(R"re("(\\.|[^"\\\n])*"|//[^\n]*|/\*[^*]*\*/)re");
  std::string kept;
  for (std::sregex_token_iterator part(text.begin(), text.end(), words, -1), end;
       part != end; ++part) {
    kept += part->str() + ' ';
  }
  return kept;
}

// Of heads comments do not name them either: each method steps each kernel.
TEST(Models, NameNoIntegrator) {
  const auto models = sources({"models"});
  ASSERT_GT(models.size(), 200U);
  std::string any;
  for (const auto& entry : integrators::integrator_catalogue()) {
    any += (any.empty() ? "" : "|") + std::string(entry.id);
  }
  const std::regex ids("\\b(" + any + ")\\b");
  ASSERT_TRUE(std::regex_search("options.method == tr_bdf2", ids));
  for (const Source& source : models) {
    const bool head = source.path.starts_with("models/head/");
    const std::string text = head ? source.text : code(source.text);
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, ids))
        << source.path << " names " << found.str();
    EXPECT_EQ(source.text.find("#include \"integrators/"), std::string::npos)
        << source.path;
  }
}

// Of one strand's stages and steps, and of strands in lanes.
TEST(Integrators, DefineEachNumberOnce) {
  const auto all = sources({"contract", "integrators", "models", "simulation/run"});
  for (const char* definition : {R"(double d = 1 - std::numbers::sqrt2 / 2)",
                                 R"(double w = std::numbers::sqrt2 / 4)",
                                 R"(\(3 \* w \+ 1\) / 3)",
                                 R"(\.share = 1\.2\b)",
                                 R"(\.power = 1\.25\b)",
                                 R"(stagnation = 1e4\b)",
                                 R"(largest\w* = 1e-6\b)",
                                 R"(most_grown = )",
                                 R"(patience = 3\b)",
                                 R"(shortest\w* = 1e-4\b)",
                                 R"(1 - \w+ / 4\))",
                                 R"(\bmargin = 0\.1\b)",
                                 R"(rate > 0\.5\b)",
                                 R"(safety = 0\.9\b)",
                                 R"(\bleast\w* = 0\.2\b)",
                                 R"(\bmost(_factor)? = 5\b)",
                                 R"(unsolved\w* = 0\.25\b)",
                                 R"(ceiling = 0\.5\b)",
                                 R"(ceiling\w* = 1\.05\b)",
                                 R"(1\. / 15)",
                                 R"(= 1e-11\b)"}) {
    const std::regex number(definition);
    std::string places;
    std::ptrdiff_t found = 0;
    for (const Source& source : all) {
      const std::string text = code(source.text);
      const auto here =
          std::distance(std::sregex_iterator(text.begin(), text.end(), number), {});
      found += here;
      if (here > 0) places += source.path + ' ';
    }
    EXPECT_EQ(found, 1) << definition << ": " << places;
  }
}

}  // namespace tress::test_one_definition
