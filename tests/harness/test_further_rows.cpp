#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "simulation/files/csv.h"
#include "tests/harness/toy_process.h"

namespace tress::test_further_rows {

using namespace simulation;

using testing::ElementsAre;
using testing::HasSubstr;

CsvTable table(const Toy& toy, const std::string& file) {
  return parse_csv(toy.read(file), file);
}

std::vector<std::string> cells(const CsvTable& of, const std::string& column) {
  std::vector<std::string> result;
  for (const Row& row : of.rows) result.emplace_back(row.text(column));
  return result;
}

TEST(FurtherRows, FollowTheRowOfTheirCase) {
  Toy toy;
  ASSERT_EQ(toy.run("--out toy.csv --jobs 3 --set particles=3 --set further=2").code, 0);
  const CsvTable rows = table(toy, "toy.csv");
  EXPECT_THAT(cells(rows, "square"),
              ElementsAre("0", "-1", "-2", "1", "-1", "-2", "4", "-1", "-2"));
  const std::string id(rows.rows[3].text("run_id"));
  EXPECT_EQ(id.size(), 16u);
  EXPECT_EQ(rows.rows[4].text("run_id"), id + ".001");
  EXPECT_EQ(rows.rows[5].text("run_id"), id + ".002");
}

TEST(FurtherRows, AreKeptByAResumedRun) {
  Toy toy;
  const std::string arguments = "--out toy.csv --set particles=2 --set further=2";
  ASSERT_EQ(toy.run(arguments).code, 0);
  const std::string before = toy.read("toy.csv");
  ASSERT_EQ(toy.run(arguments + " --resume").code, 0);
  EXPECT_EQ(toy.read("toy.csv"), before);
  EXPECT_THAT(toy.executed(), ElementsAre(0, 1));
}

TEST(FurtherRows, OfACaseThatCrashesAreItsOwnAlone) {
  Toy toy;
  const Toy::Result result =
      toy.run("--out toy.csv --set particles=3 --set further=2 --set odd_row=crash");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(cells(table(toy, "toy.csv"), "status"),
              ElementsAre("ok", "ok", "ok", "ok", "ok", "ok", "crashed"));
}

TEST(RunId, SelectsRowsOfThePlan) {
  Toy toy;
  const std::string arguments = "--set particles=4 --set further=1 --set promise=broken";
  ASSERT_EQ(toy.run(arguments + " --out all.csv").code, 3);
  const CsvTable all = table(toy, "all.csv");
  // The second row of the third case, and the first case.
  const std::string ids = std::string(all.rows[5].text("run_id")) + ',' +
                          std::string(all.rows[0].text("run_id"));
  const std::string one = arguments + " --out one.csv --run-id ";
  ASSERT_EQ(toy.run(one + ids).code, 0) << "claims need the whole table";
  EXPECT_THAT(cells(table(toy, "one.csv"), "run_id"),
              ElementsAre(all.rows[0].text("run_id"), all.rows[1].text("run_id"),
                          all.rows[4].text("run_id"), all.rows[5].text("run_id")));
  EXPECT_THAT(toy.executed(), ElementsAre(0, 1, 2, 3, 0, 2));
  EXPECT_THAT(toy.read("one.meta.json"), HasSubstr(" run-id=" + ids));
  EXPECT_EQ(toy.run(arguments + " --out one.csv --resume").code, 2)
      << "the whole table does not continue one of some rows";
}

TEST(RunId, ThatNoRowHasIsRefused) {
  Toy toy;
  for (const char* bad :
       {"0123456789abcdef", "''", "a,,b", "../x", "0123456789abcde", "0123456789abcdeg",
        "0123456789abcdef0", "0123456789abcdef.", "0123456789abcdef.x"}) {
    const Toy::Result result = toy.run(std::string("--out toy.csv --run-id ") + bad);
    EXPECT_EQ(result.code, 2) << bad;
    EXPECT_EQ(result.error_lines(), 1) << bad;
    EXPECT_THAT(result.err, HasSubstr("--run-id"));
  }
  EXPECT_TRUE(toy.executed().empty());
  EXPECT_FALSE(toy.exists("toy.csv"));
}

TEST(OwnOptions, SayWhatSetSays) {
  Toy toy;
  ASSERT_EQ(toy.run("--only quit --pause 0.001 --set particles=1").code, 0);
  EXPECT_THAT(toy.files(), ElementsAre("results", "results/toy.quit.csv",
                                       "results/toy.quit.meta.json"));
  const Toy::Result twice = toy.run("--pause 1 --set nap=2 --out toy.csv");
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("set twice"));
  const Toy::Result wrong = toy.run("--pause soon --out toy.csv");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--pause"));
}

}  // namespace tress::test_further_rows
