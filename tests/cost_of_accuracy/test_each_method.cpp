#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "tests/cost_of_accuracy/scratch.h"

namespace tress::test_each_method {

using namespace experiments;
using namespace experiments::cost_of_accuracy;

CommandLine asked(std::vector<std::string> models, std::vector<std::string> integrators) {
  CommandLine line;
  line.quick = true;
  line.repeat = 1;
  line.models = std::move(models);
  line.integrators = std::move(integrators);
  return line;
}

std::vector<Row> rows_of(const CommandLine& line, const std::string& scene) {
  std::vector<Row> rows;
  for (const Case& one : method_cases(line, TRESS_SCENES "/accuracy/" + scene)) {
    rows.push_back(one.identity);
    one.run(rows.back(), Deadline(600));
  }
  return rows;
}

bool alarm(const Verdicts& verdicts) {
  return std::ranges::any_of(verdicts.all(), &Verdicts::Verdict::alarm);
}

// The cheapest of its ladders: a longer step or fewer elements miss the target.
TEST(EachMethod, FindsTheCheapestRunOfAModel) {
  const auto rows =
      rows_of(asked({"super_helix"}, {"implicit_midpoint"}), "release.toml");
  ASSERT_EQ(rows.size(), 1u);
  const Row& row = rows.front();
  ASSERT_TRUE(row.ok()) << row.text("reason");
  EXPECT_EQ(row.text("kind"), "method");
  EXPECT_EQ(row.text("modes"), "bend");  // of the scene's own model
  EXPECT_EQ(row.text("elements"), "7");
  EXPECT_NEAR(row.number("dt_s"), 1 / 60.0, 1e-15);
  EXPECT_LE(row.number("error_rel"), row.number("target_error_rel"));
  EXPECT_GT(row.number("error_rel"), 100 * row.number("reference_gap"));
  EXPECT_EQ(row.number("unknowns"), 14);  // two curvatures of each element
  EXPECT_EQ(row.number("length_error_rel"), 0);
  EXPECT_FALSE(row.has("angular_error_rel"));
}

TEST(EachMethod, LooksAtMomentumOfWhatIsThrown) {
  const auto rows = rows_of(asked({"super_helix"}, {"implicit_midpoint"}), "flight.toml");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_LT(rows.front().number("angular_error_rel"), 0.01);
  EXPECT_LT(rows.front().number("linear_error_rel"), 0.01);
  Verdicts verdicts;
  check_method_claims(rows, verdicts);
  EXPECT_FALSE(alarm(verdicts));
}

TEST(EachMethod, LeavesOutModelsThatCannotDoTheScene) {
  CommandLine line = asked({}, {"implicit_midpoint"});
  line.dry_run = true;
  const auto has = [&line](const std::string& scene, std::string_view model) {
    return std::ranges::any_of(
        method_cases(line, TRESS_SCENES "/accuracy/" + scene),
        [model](const Case& one) { return one.identity.text("model") == model; });
  };
  EXPECT_TRUE(has("release.toml", "force_transport"));
  EXPECT_FALSE(has("flight.toml", "force_transport"));  // no free root
  EXPECT_TRUE(has("flight.toml", "der"));
}

TEST(EachMethod, RefusesSeveralStrands) {
  const Scratch folder;
  const std::string file =
      folder.write("two.toml", "title = \"two\"\n[[strand]]\n[[strand]]\n");
  EXPECT_THROW(method_cases(asked({}, {}), file), InputError);
}

Row thrown(double angular) {
  Row row;
  row.set("scene", "flight").set("kind", "method").set("model", "der");
  row.set("integrator", "implicit_midpoint").set("target_error_rel", 0.01);
  row.set("angular_error_rel", angular);
  return row;
}

TEST(EachMethod, AMomentumWorseThanTheTipBreaksTheClaim) {
  Verdicts kept, lost;
  check_method_claims({thrown(0.009)}, kept);
  check_method_claims({thrown(0.009), thrown(0.011)}, lost);
  EXPECT_FALSE(alarm(kept));
  EXPECT_TRUE(alarm(lost));
}

}  // namespace tress::test_each_method
