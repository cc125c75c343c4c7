// What paired_scenes compares, on small tables.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/pair_tables.h"

namespace tress::test_pair_tables {

using namespace testing_support;

const Columns table = {
    {"t_s", {0, 1}},       {"tip_x_m", {0.1, 0.2}},    {"kinetic_j", {0, 2}},
    {"elastic_j", {4, 1}}, {"failed_strands", {0, 0}}, {"fastest_m_s", {0, 1}}};

TEST(PairTables, FindEveryKindOfDifference) {
  EXPECT_EQ(apart(table, table, 2).most(), 0);
  EXPECT_EQ(apart(table, table, 2).unequal, "");
  Columns other = table;
  other["kinetic_j"][1] = 2.4;
  EXPECT_DOUBLE_EQ(apart(other, table, 2).energy, 0.1);
  EXPECT_EQ(apart(other, table, 1).energy, 0);
  other = table;
  other["tip_x_m"][0] = 0.12;
  EXPECT_DOUBLE_EQ(apart(other, table, 2).place, 0.1);
  other["tip_x_m"][0] = std::nan("");
  EXPECT_TRUE(std::isinf(apart(other, table, 2).place));
  for (const char* const exact : {"t_s", "failed_strands"}) {
    other = table;
    other[exact][1] += 1;
    EXPECT_EQ(apart(other, table, 2).unequal, exact);
  }
  other = table;
  other["elastic_j"].pop_back();
  EXPECT_EQ(apart(other, table, 2).unequal, "elastic_j");
}

TEST(PairTables, CompareTheColumnsThatBothHave) {
  Columns other = table;
  other.erase("fastest_m_s");
  other["dt_s"] = {1, 1};
  EXPECT_EQ(apart(table, other, 2).most(), 0);
}

std::string usd(const std::string& name, const std::string& last,
                const std::string& first = "1, 0, 0") {
  const auto file = std::filesystem::temp_directory_path() / ("tress_pair_" + name);
  std::ofstream(file)
      << "    point3f[] points.timeSamples = {\n            0: [(0, 0, 0), (" + first +
             ")],\n            1.5: [(0, 0, 0), (" + last + ")],\n    }\n";
  return file.string();
}

TEST(PairTables, ComparePointsOfAllFrames) {
  const std::string one = usd("one", "1, 0.5, 0");
  EXPECT_EQ(points_apart(one, one), 0);
  EXPECT_DOUBLE_EQ(points_apart(usd("other", "1, 0.25, 0"), one), 0.25);
  const std::string more = usd("more", "1, 0.5, 0), (1, 1, 1", "1, 0.25, 0");
  EXPECT_DOUBLE_EQ(points_apart(more, one), 0.25);
  const std::string others = usd("others", "1, 1, 1), (1, 1, 1", "1, 1, 1), (1, 1, 1");
  EXPECT_TRUE(std::isnan(points_apart(others, one)));
  Apart not_drawn;
  not_drawn.energy = 1;
  not_drawn.points = points_apart(others, one);
  EXPECT_EQ(not_drawn.most(), 1);
  EXPECT_TRUE(std::isinf(points_apart("none", one)));
}

TEST(PairTables, ReadAFailureFromAMessage) {
  const Failure alone = failure_in(
      "simulate: s: 3 frames, 0.01 s simulated in 0.1 s; unstable: a segment is off its "
      "length by 0.537 of it (at most 0.5) at t = 0.0125 s, strand 6, element 0: try");
  EXPECT_EQ(alone.strand, 6);
  EXPECT_EQ(alone.t, 0.0125);
  EXPECT_FALSE(failure_in("simulate: s: 3 frames").some());
  Failure same = alone;
  same.t = 0.013;
  EXPECT_EQ(different_failures({same}, {alone}, 1e-3), "");
  EXPECT_EQ(different_failures({same}, {alone}, 0), "a strand fails at another time");
  same.strand = 5;
  EXPECT_EQ(different_failures({same}, {alone}, 1e-3), "other strands fail");
  same = alone;
  same.kind = "solution";
  EXPECT_EQ(different_failures({same}, {alone}, 1e-3),
            "a strand fails for another reason");
  EXPECT_EQ(different_failures({}, {failure_in("ended")}, 0),
            "no failed strand is named");
}

}  // namespace tress::test_pair_tables
