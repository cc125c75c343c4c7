#include <algorithm>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "experiments/validation/free_flight.h"
#include "experiments/validation/localised_buckling.h"
#include "experiments/validation/pendulum.h"
#include "experiments/validation/plectoneme.h"
#include "experiments/validation/spring.h"
#include "experiments/validation/test.h"
#include "experiments/validation/turned_ends.h"

namespace tress::experiments::validation {

const std::vector<ValidationTest>& validation_tests() {
  static const std::vector<ValidationTest> all = [] {
    std::vector<ValidationTest> tests;
    for (auto* family : {cantilever_tests,
                         vibration_tests,
                         buckling_tests,
                         localised_buckling_tests,
                         curl_tests,
                         hanging_tests,
                         pendulum_tests,
                         chain_tests,
                         ringing_tests,
                         spring_tests,
                         plane_tests,
                         stick_slip_tests,
                         capstan_tests,
                         ladder_tests,
                         touching_tests,
                         knot_tests,
                         wisp_tests,
                         plectoneme_tests,
                         plectoneme_exact_tests,
                         turned_end_tests}) {
      std::ranges::move(family(), std::back_inserter(tests));
    }
    return tests;
  }();
  return all;
}

const ValidationTest& find_validation_test(std::string_view name) {
  std::vector<std::string_view> names{free_flight};
  for (const ValidationTest& test : validation_tests()) {
    if (test.name == name) return test;
    names.push_back(test.name);
  }
  throw InputError("unknown test '" + std::string(name) + "'", "--set tests",
                   suggestion(name, names, "leave it out to run all of them"));
}

}  // namespace tress::experiments::validation
