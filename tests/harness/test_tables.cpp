#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "contract/input_error.h"
#include "experiments/problems/reference.h"
#include "experiments/run/journal.h"
#include "experiments/run/sundials_speed.h"
#include "simulation/files/csv.h"
#include "simulation/run/timing.h"

namespace tress::test_tables {

using namespace experiments;

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Row, NumbersReadBackToTheSameBits) {
  for (const double x : {0.1, 1.0 / 3.0, -0.0, 5e-324, std::numeric_limits<double>::max(),
                         6.02214076e23, std::nextafter(1.0, 2.0)}) {
    Row row;
    row.set("x", x);
    const double back = row.number("x");
    EXPECT_EQ(std::signbit(back), std::signbit(x));
    EXPECT_EQ(back, x);
  }
}

TEST(Row, NumbersThatAreNotFiniteAreEmptyCells) {
  Row row;
  row.set("nan", std::nan("")).set("inf", std::numeric_limits<double>::infinity());
  EXPECT_EQ(row.text("nan"), "");
  EXPECT_EQ(row.text("inf"), "");
  EXPECT_TRUE(std::isnan(row.number("nan")));
}

TEST(Row, EveryTypeHasOneText) {
  Row row;
  row.set("i", 3).set("l", 10'000'000'000L).set("b", true).set("c", "word");
  row.set("s", std::string("text")).set("i", 4);
  EXPECT_EQ(row.text("i"), "4");
  EXPECT_EQ(row.text("l"), "10000000000");
  EXPECT_EQ(row.text("b"), "true");
  EXPECT_EQ(row.text("c"), "word");
  EXPECT_EQ(row.text("s"), "text");
}

TEST(RunId, DependsOnExperimentAndIdentityButNotOnTheirOrder) {
  const std::string id = run_id("toy", Row().set("a", 1).set("b", "x"));
  EXPECT_EQ(id.size(), 16u);
  EXPECT_EQ(id, run_id("toy", Row().set("b", "x").set("a", 1)));
  EXPECT_NE(id, run_id("toz", Row().set("a", 1).set("b", "x")));
  EXPECT_NE(id, run_id("toy", Row().set("a", 2).set("b", "x")));
  EXPECT_NE(run_id("toy", Row().set("a", "bc")), run_id("toy", Row().set("ab", "c")));
}

TEST(Csv, RoundTripKeepsEveryCell) {
  const std::vector<std::string> header{"plain", "hard, \"name\""};
  Row row;
  row.set("plain", "a,b\"c\nd\r\n").set(header[1], 0.1);
  const std::vector<std::string> names{"plain", header[1], "status", "reason", "run_id"};
  const std::vector<Row> rows{row, Row().failed("diverged", "at t = 0.25 s")};
  const CsvTable back = parse_csv(to_csv(names, rows), "x");
  EXPECT_EQ(back.header, names);
  ASSERT_EQ(back.rows.size(), 2u);
  EXPECT_EQ(back.rows[0].text("plain"), "a,b\"c\nd\r\n");
  EXPECT_EQ(back.rows[0].number(header[1]), 0.1);
  EXPECT_EQ(back.rows[0].text("status"), "ok");
  EXPECT_EQ(back.rows[1].text("plain"), "");
  EXPECT_EQ(back.rows[1].text("reason"), "at t = 0.25 s");
}

TEST(Csv, ReadsCarriageReturnsAndAMissingLastLineEnd) {
  const CsvTable table = parse_csv("a,b\r\n1,\r\n,2", "x");
  EXPECT_THAT(table.header, ElementsAre("a", "b"));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].text("a"), "1");
  EXPECT_EQ(table.rows[1].text("b"), "2");
}

TEST(Csv, BeginsAfterAByteOrderMark) {
  const CsvTable table = parse_csv(
      "\xEF\xBB\xBF"
      "a,b\n1,2\n",
      "t.csv");
  EXPECT_EQ(table.header.front(), "a");
  EXPECT_EQ(table.rows[0].text("a"), "1");
}

/// What parse_csv() refuses a text with.
std::string message(std::string_view text) {
  try {
    static_cast<void>(parse_csv(text, "t.csv"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Csv, ErrorsNameFileLineAndColumn) {
  EXPECT_THAT(message("a,b\n1,x\"y\n"), HasSubstr("t.csv:2:4"));
  EXPECT_THAT(message("a\n\"open"), HasSubstr("t.csv:2:6"));
  EXPECT_THAT(message("a,b\n1,2\n1\n1,2\n"),
              HasSubstr("a line of 1 cells, where the header has 2 (t.csv:3:1)"));
  EXPECT_THAT(message("a,a\n"), HasSubstr("appears twice"));
}

TEST(Csv, OtherSeparatorsAreNamedWithPlaceAndRemedy) {
  for (const auto& [text, problem] :
       {std::pair("a;b\n0,1;0,2\n", "separated by ';' (t.csv:1:2)"),
        {"a\tb\n1\t2\n", "separated by tabs (t.csv:1:2)"},
        {"  a  b\n1 2\n", "separated by spaces (t.csv:1:4)"},
        {"\"a\";\"b\"\n", "separated by ';' (t.csv:1:4)"},
        {"a,b\n1;2\n", "separated by ';' (t.csv:2:2)"}}) {
    EXPECT_THAT(message(text), HasSubstr(problem)) << text;
    EXPECT_THAT(message(text), HasSubstr("): separate columns by ','")) << text;
  }
  EXPECT_EQ(message("a\n1 2\n"), "accepted");
  EXPECT_THAT(message("a,b\n \n"), HasSubstr("a line of 1 cells"));
}

TEST(Csv, ABlankFileIsAnEmptyTable) {
  for (const char* text : {"", "\n", " \r\n\t\n", "\xEF\xBB\xBF\n"}) {
    EXPECT_TRUE(parse_csv(text, "t.csv").header.empty()) << text;
  }
}

TEST(Journal, LineRoundTripKeepsEveryCell) {
  Row row;
  row.set("run_id", "0123")
      .set("x", 0.1)
      .set("note", "a\n\"b\"")
      .failed("crashed", "why");
  const std::string line = to_json_line(row);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const Row back = from_json_line(line);
  EXPECT_EQ(back.number("x"), 0.1);
  EXPECT_EQ(back.text("note"), "a\n\"b\"");
  EXPECT_EQ(back.status(), "crashed");
}

TEST(Reference, NormsAreWhatTheirNamesSay) {
  const double value[] = {1, 2, 3}, reference[] = {1, 5, 7}, scale[] = {1, 3, 2};
  const ErrorNorms norms = error_norms(value, reference, scale);
  EXPECT_EQ(norms.max, 4);
  EXPECT_DOUBLE_EQ(norms.rms, std::sqrt((0.0 + 9 + 16) / 3));
  EXPECT_EQ(norms.relative, 2);
}

TEST(Reference, ValuesThatAreNotFiniteAreInfinitelyWrong) {
  const double value[] = {std::nan(""), 1}, reference[] = {0, 1}, scale[] = {1};
  EXPECT_TRUE(std::isinf(error_norms(value, reference, scale).relative));
}

TEST(Reference, ScdCountsDigitsOfTheWorstComponent) {
  const double reference[] = {2, 0, -4}, value[] = {2 * (1 + 1e-3), 5, -4 * (1 + 1e-5)};
  // 1 + 1e-3 is rounded to 2^-53, so the digits are off by about 1e-13.
  EXPECT_NEAR(scd(value, reference), 3, 1e-12);
  EXPECT_EQ(scd(reference, reference), 16);
}

TEST(Reference, ErrorsBelowTenTimesTheGapAreMarked) {
  const double first[] = {1.0}, second[] = {1.0 + 0x1p-20}, scale[] = {1.0};
  const ReferenceGap gap(first, second, scale);
  EXPECT_EQ(gap.gap(), 0x1p-20);
  Row good, lost, failed;
  gap.mark(good, 10 * 0x1p-20);
  gap.mark(lost, 9 * 0x1p-20);
  gap.mark(failed.failed("diverged", "early"), 0);
  EXPECT_EQ(good.status(), "ok");
  EXPECT_EQ(lost.status(), "below_reference");
  EXPECT_EQ(failed.status(), "diverged");
}

TEST(Timing, MedianAndMinimumOfTheRepeatsWithoutTheWarmUp) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  int calls = 0;
  const Timing timing = time_it(4, [&calls] { ++calls; });
  EXPECT_EQ(calls, 5);
  EXPECT_EQ(timing.repeats, 4);
  EXPECT_LE(timing.min_s, timing.median_s);
}

TEST(SundialsSpeed, RatioIsAPositiveNumber) {
  const double ratio = sundials_speed_ratio();
  EXPECT_TRUE(std::isfinite(ratio));
  EXPECT_GT(ratio, 0);
}

}  // namespace tress::test_tables
