#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "simulation/files/csv.h"
#include "tests/harness/toy_process.h"

namespace tress::test_effect_audit {

using namespace simulation;

using testing::HasSubstr;

// A held tip does not move: the distances are those of points along the strand.
TEST(EffectAudit, JudgesAHairWithAHeldTipByPointsAlongIt) {
  Toy process;
  process.write("held.toml", R"(
title = "held at both ends"
duration_s = 0.1
[model]
id = "super_helix"
[integrator]
id = "tr_bdf2"
dt_s = 0.002
[strand]
length_m = 0.1
elements = 10
root_tangent = [1, 0, 0]
shape = "helix"
curl_radius_m = 0.05
curl_pitch_m = 0
[effects.gravity]
[[supports]]
at = "tip"
)");
  const Toy::Result result =
      process.run("--scene held.toml --quick --out table.csv --set accuracy=0.001");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("held: gravity: keep (without it the strands move by "));
  for (const Row& row : parse_csv(process.read("table.csv"), "table.csv").rows) {
    EXPECT_EQ(row.text("error_of"), "strand");
    if (row.text("effect") != "gravity") continue;
    EXPECT_GT(row.number("error_without_rel"), 0.001);
  }
}

}  // namespace tress::test_effect_audit
