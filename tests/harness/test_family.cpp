#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "experiments/family/family.h"

namespace tress::family {

using namespace experiments;
using namespace experiments::family;
namespace {

TEST(Family, LatinHypercube_HasOneHairInEveryPartOfEveryRange) {
  constexpr int count = 48;
  const auto hairs = latin_hypercube(count, 1);
  std::set<int> lengths, sections, levels;
  std::vector<int> drive_counts(drives);
  for (const Hair& hair : hairs) {
    lengths.insert(static_cast<int>((hair.length - 0.03) / 0.37 * count));
    sections.insert(static_cast<int>((hair.ellipticity - 1) / 0.6 * count));
    levels.insert(static_cast<int>(hair.level * count));
    ++drive_counts[static_cast<std::size_t>(hair.drive)];
  }
  EXPECT_EQ(lengths.size(), count);
  EXPECT_EQ(sections.size(), count);
  EXPECT_EQ(levels.size(), count);
  EXPECT_EQ(drive_counts, std::vector<int>(drives, count / drives));
  EXPECT_EQ(std::ranges::count(hairs, 0.0, &Hair::internal_friction), count / 4);
}

TEST(Family, LatinHypercube_FollowsItsSeed) {
  EXPECT_EQ(latin_hypercube(8, 1)[3].length, latin_hypercube(8, 1)[3].length);
  EXPECT_NE(latin_hypercube(8, 1)[3].length, latin_hypercube(8, 2)[3].length);
}

TEST(Family, Quantile_InterpolatesBetweenOrderStatistics) {
  EXPECT_DOUBLE_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_DOUBLE_EQ(quantile({0, 10}, 0.1), 1);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.9), 7);
}

TEST(Family, RankCorrelation_SeesOrderOnlyAndSharesTies) {
  const std::vector<double> x{1, 2, 3, 4}, steep{1, 10, 100, 1000}, falling{4, 3, 2, 1};
  EXPECT_DOUBLE_EQ(rank_correlation(x, steep), 1);
  EXPECT_DOUBLE_EQ(rank_correlation(x, falling), -1);
  EXPECT_DOUBLE_EQ(rank_correlation(x, std::vector<double>(4, 5.0)), 0);
  // Ranks 0, 1, 2, 3 and 0.5, 0.5, 2, 3: covariance 4.5, variances 5 and 4.5.
  EXPECT_NEAR(rank_correlation(x, std::vector<double>{1, 1, 2, 3}), 4.5 / std::sqrt(22.5),
              1e-15);
}

TEST(Family, Stump_FindsTheThresholdThatDecides) {
  const std::vector<double> x{1, 2, 3, 4, 5, 6};
  const Stump rule = best_stump(x, {true, true, true, false, false, false}, 2);
  EXPECT_TRUE(rule.found);
  EXPECT_DOUBLE_EQ(rule.threshold, 3.5);
  EXPECT_DOUBLE_EQ(rule.share_below, 1);
  EXPECT_DOUBLE_EQ(rule.share_above, 0);
  EXPECT_DOUBLE_EQ(rule.right, 1);
  // What holds for all is decided by nothing.
  EXPECT_FALSE(best_stump(x, std::vector<bool>(6, true), 2).found);
}

TEST(Family, Summary_CountsHairsWithoutAnAnswerApart) {
  const Claim& claim = studies().front().claims.front();
  std::vector<Row> rows;
  for (const Hair& hair : latin_hypercube(8, 1)) {
    Row row;
    hair.describe(row);
    const bool short_one = hair.length < 0.2;
    rows.push_back(hair.number == 8 ? no_answer(row, claim, "not_met", "why")
                                    : answer(row, claim, hair.length, short_one));
  }
  const Row summary = summarize(rows).front();
  EXPECT_EQ(summary.text("hairs"), "7");
  EXPECT_EQ(summary.text("no_answer"), "1");
  EXPECT_EQ(summary.text("correlated_with"), "length_m");
  EXPECT_EQ(summary.number("rank_correlation"), 1);
}

TEST(Family, Straightened_LeavesTheRestOfTheHairAlone) {
  const Hair hair = latin_hypercube(8, 1).front(), straight = straightened(hair);
  EXPECT_EQ(straight.natural_curvature, 0);
  EXPECT_EQ(straight.winding(), 0);
  EXPECT_EQ(straight.gravito_bending(), hair.gravito_bending());
}

}  // namespace
}  // namespace tress::family
