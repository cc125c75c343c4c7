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
