#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "experiments/run/list.h"

namespace tress::test_list {

using namespace experiments;

using testing::HasSubstr;

/// A free particle on a line: enough for an integrator to accept or refuse.
class Point final : public System {
 public:
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {.constant_mass = true}; }
  void initial_state(Out q, Out v) const override { q[0] = v[0] = 0; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double, In, In, In a, Out r) noexcept override {
    r[0] = a[0];
    return Status::ok;
  }
  Status linearize(double, In, In, In, Weights) noexcept override { return Status::ok; }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0];
    return Status::ok;
  }
};

constexpr Parameter parameters[] = {{.name = "mass", .help = "mass (kg)", .number = 2}};
constexpr Parameter own[] = {{.name = "gamma", .help = "its own", .number = 0.5}};

const ModelEntry models_listed[] = {
    {"point", "one particle", "Newton 1687", parameters,
     [](const Parameters&) -> std::unique_ptr<System> {
       return std::make_unique<Point>();
     }},
    {"other_point", "another", "Newton 1687", parameters,
     [](const Parameters&) -> std::unique_ptr<System> {
       return std::make_unique<Point>();
     }},
    {"broken", "cannot be made", "nobody", parameters,
     [](const Parameters&) -> std::unique_ptr<System> {
       throw std::runtime_error("lacks its parts");
     }},
};

const IntegratorEntry integrators_listed[] = {
    {.id = "willing",
     .summary = "drives all",
     .source = "Euler 1768",
     .formulations = {{Formulation::parametric, 3}, {Formulation::index3, 1}},
     .parameters = own,
     .make = nullptr},
    {.id = "choosy",
     .summary = "drives none",
     .source = "Gear 1971",
     .adaptive = true,
     .formulations = {{Formulation::parametric, 2}},
     .objection = [](System&, Formulation) { return std::string("needs a longer rope"); },
     .make = nullptr},
};

std::vector<std::string> words_of_line(const std::string& text,
                                       const std::string& first) {
  const std::size_t begin = text.rfind("\n  " + first + ' ');
  std::istringstream line(text.substr(begin + 1, text.find('\n', begin + 1) - begin - 1));
  std::vector<std::string> words;
  for (std::string word; line >> word;) words.push_back(word);
  return words;
}

TEST(List, MatrixShowsWhatWorksAndEachReasonOnce) {
  const std::string text = catalogue_text(models_listed, integrators_listed, {});
  const std::string matrix = text.substr(text.find("WHAT DRIVES WHAT"));
  EXPECT_THAT(words_of_line(matrix, "willing"),
              testing::ElementsAre("willing", "p", "1", "p", "1", "3"));
  EXPECT_THAT(words_of_line(matrix, "choosy"),
              testing::ElementsAre("choosy", "2", "2", "3"));
  const std::string reason = "needs a longer rope";
  EXPECT_NE(matrix.find(reason), std::string::npos);
  EXPECT_EQ(matrix.find(reason), matrix.rfind(reason));
  EXPECT_THAT(matrix, HasSubstr("3  lacks its parts"));
}

TEST(List, ShowsModelsWithParametersAndIntegratorsWithOrder) {
  const std::string text = catalogue_text(models_listed, integrators_listed, {});
  EXPECT_THAT(text, HasSubstr("one particle (Newton 1687)"));
  EXPECT_THAT(text, HasSubstr("mass (kg) [2]"));
  EXPECT_THAT(text, HasSubstr("order 2, adaptive, drives none [p] (Gear 1971)"));
  EXPECT_THAT(
      text, HasSubstr("order 3, drives all [p, 3 of order 1] (Euler 1768)\n      gamma"));
}

}  // namespace tress::test_list
