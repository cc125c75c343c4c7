// Options that all experiments share: each experiment honours or refuses them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace tress::test_shared_options {

std::string contents(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::vector<std::string> experiments() {
  std::istringstream list(contents(TRESS_BINARY_DIR "/experiments/list.txt"));
  std::vector<std::string> names;
  for (std::string name; std::getline(list, name);) {
    if (name != "simulate") names.push_back(name);  // has options of its own
  }
  return names;
}

struct Plan {
  int code;
  std::string text;  // of standard output and error

  bool says(std::string_view words) const {
    return text.find(words) != std::string::npos;
  }
  /// Values of "column=value" in the rows.
  std::set<std::string> values(const std::string& column) const {
    std::set<std::string> all;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      if (word.starts_with(column + "=")) all.insert(word.substr(column.size() + 1));
    }
    return all;
  }
};

/// The rows that would run, in the repository: scenes lie there.
Plan plan(const std::string& experiment, const std::string& options) {
  const std::string command = "cd '" TRESS_SOURCE_DIR "' && '" TRESS_BINARY_DIR
                              "/experiments/" +
                              experiment + "' --quick --dry-run " + options + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  Plan result;
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) {
    result.text.append(buffer, n);
  }
  result.code = WEXITSTATUS(pclose(pipe));
  return result;
}

struct Option {
  std::string name, value, column;
};
const Option choices[] = {{"models", "articulated_chain", "model"},
                          {"integrators", "implicit_midpoint", "integrator"},
                          {"elements", "12", "elements"}};

class SharedOptions : public testing::TestWithParam<std::string> {};

bool refused(const Plan& plan, const Option& option) {
  return plan.code == 2 &&
         (plan.says("has no use for --" + option.name) ||
          plan.says("no row of these options has the " + option.column));
}

TEST_P(SharedOptions, ChooseRowsOrAreRefused) {
  // Its rows are scenes; what is chosen is searched within each.
  const bool within = GetParam() == "cost_of_accuracy";
  for (const Option& option : choices) {
    const Plan chosen = plan(GetParam(), "--" + option.name + " " + option.value);
    if (refused(chosen, option) || chosen.text.empty()) continue;
    EXPECT_EQ(chosen.code, 0) << chosen.text;
    if (within) continue;
    // Its rows are models; methods lie within each.
    if (GetParam() == "cost_of_gradient" && option.name == "integrators") continue;
    // Rows of constraint_drift name the system, of which the model is a part.
    if (GetParam() == "constraint_drift" && option.name == "models") {
      EXPECT_EQ(chosen.values("system"), std::set{option.value});
    } else {
      std::set expected{option.value};
      // The rod that all are compared with.
      if (GetParam() == "force_transport" && option.name == "elements") {
        expected.insert("80");
      }
      EXPECT_EQ(chosen.values(option.column), expected) << option.name;
    }
  }
}

TEST_P(SharedOptions, SeedAndRepeatAreReadOrRefused) {
  std::string source;
  for (const auto& file : std::filesystem::directory_iterator(
           TRESS_SOURCE_DIR "/experiments/" + GetParam())) {
    if (file.path().extension() == ".cpp") source += contents(file.path().string());
  }
  for (const Option& option : {Option{"seed", "2", ""}, Option{"repeat", "2", ""}}) {
    if (source.find("line." + option.name) != std::string::npos) continue;
    EXPECT_TRUE(refused(plan(GetParam(), "--" + option.name + " 2"), option))
        << option.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Experiments, SharedOptions, testing::ValuesIn(experiments()),
                         [](const auto& tested) { return tested.param; });

}  // namespace tress::test_shared_options
