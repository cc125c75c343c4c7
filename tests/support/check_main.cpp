// main() of the tests that run suites over catalogues: without arguments of its own that
// of GoogleTest; with --plugin=FILE (again for another) these suites alone, on what the
// plug-ins bring, with a line for each contract. ./tress check calls it so.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "contract/input_error.h"
#include "simulation/plugin/load_plugin.h"

namespace tress::testing_support {
namespace {

constexpr int usage_error = 2, checks_failed = 3;

/// One line for each test of a suite, over its cases.
class Summary final : public testing::EmptyTestEventListener {
  struct Count {
    int passed = 0, failed = 0;
    std::map<std::string, int> skipped;  // by reason
  };

  void OnTestEnd(const testing::TestInfo& test) override {
    const std::string suite = test.test_suite_name(), name = test.name();
    Count& count =
        counts_[suite.substr(suite.find('/') + 1) + "." + name.substr(0, name.find('/'))];
    const testing::TestResult& result = *test.result();
    if (result.Passed()) ++count.passed;
    if (result.Failed()) ++count.failed;
    if (!result.Skipped() && !result.Failed()) return;
    for (int i = 0; i < result.total_part_count(); ++i) {
      const testing::TestPartResult& part = result.GetTestPartResult(i);
      if (part.skipped()) ++count.skipped[part.message()];
      if (part.failed()) {
        std::printf("%s.%s: %s\n\n", suite.c_str(), name.c_str(), part.message());
      }
    }
  }

  void OnTestProgramEnd(const testing::UnitTest&) override {
    for (const auto& [name, count] : counts_) {
      const char* verdict = count.failed > 0   ? "FAIL"
                            : count.passed > 0 ? "PASS"
                                               : "NONE";
      std::printf("%s %s: %d passed", verdict, name.c_str(), count.passed);
      if (count.failed > 0) std::printf(", %d failed", count.failed);
      for (const auto& [reason, cases] : count.skipped) {
        std::printf(", %d left out: %s", cases, reason.c_str());
      }
      std::printf("\n");
    }
  }

  std::map<std::string, Count> counts_;
};

int check(int argc, char** argv, const std::vector<std::string>& plugins) {
  for (const std::string& file : plugins) simulation::load_plugin(file);
  testing::InitGoogleTest(&argc, argv);
  if (testing::GTEST_FLAG(filter) == "*") testing::GTEST_FLAG(filter) = "Catalogue/*";
  testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
  delete listeners.Release(listeners.default_result_printer());
  listeners.Append(new Summary);
  return RUN_ALL_TESTS() == 0 ? 0 : checks_failed;
}

}  // namespace
}  // namespace tress::testing_support

int main(int argc, char** argv) {
  using namespace tress::testing_support;
  constexpr std::string_view option = "--plugin=";
  std::vector<std::string> plugins;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word.starts_with(option)) plugins.emplace_back(word.substr(option.size()));
  }
  if (plugins.empty()) {
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
  }
  try {
    return check(argc, argv, plugins);
  } catch (const tress::InputError& error) {
    std::fprintf(stderr, "check: error: %s\n", error.what());
    return usage_error;
  }
}
