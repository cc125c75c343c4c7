// The verdicts of effect_audit, by what an effect changes and how well that is known.
#include <gtest/gtest.h>

#include "experiments/effect_audit/verdict.h"

namespace tress::experiments::effect_audit {
namespace {

constexpr double accuracy = 0.01;

TEST(EffectVerdict, KeepsAndDropsByMoreThanTheErrorOfTheChange) {
  EXPECT_EQ(verdict({0.05, 0.03, 0.002}, accuracy), "keep");
  EXPECT_EQ(verdict({0.005, 0.004, 0.002}, accuracy), "drop");
  EXPECT_EQ(verdict({0.05, 0.041, 0.002}, accuracy), "too close to call");
  EXPECT_EQ(verdict({0.005, 0.006, 0.002}, accuracy), "too close to call");
}

// Linear drag of the curly clump: worth 1.03 % where 1 % was asked for, at a
// discretisation of 1.08 %. It must not be dropped.
TEST(EffectVerdict, NeverDropsWhatExceedsTheAccuracy) {
  EXPECT_EQ(verdict({0.0103, 0.0004, 0.0108}, accuracy),
            "cannot tell: discretisation 1.1 %");
  for (const double discretisation : {0.001, 0.01, 0.02, 0.5}) {
    EXPECT_NE(verdict({1.001 * accuracy, 0, discretisation}, accuracy), "drop");
  }
}

// A coarse scene still tells that an effect is small: its change is known to its own
// error.
TEST(EffectVerdict, DropsASmallEffectOfACoarseScene) {
  EXPECT_EQ(verdict({0.004, 0.002, 0.018}, accuracy), "drop");
}

// A scene that fails without an effect needs it; a row that was killed tells nothing.
TEST(EffectVerdict, OfARowThatWasKilledIsNone) {
  const auto row = [](const char* effect, const char* status) {
    simulation::Row made;
    made.set("effect", effect).failed(status, "why");
    return made;
  };
  EXPECT_TRUE(finding(row("gravity", "diverged")));
  EXPECT_TRUE(finding(row("gravity", "refused")));
  EXPECT_FALSE(finding(row("gravity", "timeout")));
  EXPECT_FALSE(finding(row("gravity", "crashed")));
  EXPECT_FALSE(finding(row("none", "diverged")));
}

}  // namespace
}  // namespace tress::experiments::effect_audit
