#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "simulation/files/csv.h"
#include "tests/harness/toy_process.h"

namespace tress::test_calibrate_points {

using namespace simulation;
using testing::HasSubstr;

const std::string scene = CALIBRATE_DATA "/swinging_curl.toml";
const std::string record = CALIBRATE_DATA "/swinging_curl.csv";

// The tip of a curl by der with 80 elements, fitted by super_helix with 40. All intervals
// hold the truth, and neither step nor elements limit them.
TEST(CalibratePoints, FindsStiffnessFrictionAndDragOfTheShippedRecord) {
  Toy calibrate;
  const Toy::Result run = calibrate.run("--scene " + scene + " --set data=" + record +
                                        " --out fit.csv --progress none");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("youngs_modulus_pa = "));
  EXPECT_THAT(run.out, HasSubstr("75 coordinates; root mean square"));
  const CsvTable table = parse_csv(calibrate.read("fit.csv"), "fit.csv");
  ASSERT_EQ(table.rows.size(), 3u) << run.err;
  const double truth[] = {3e9, 1e-10, 5e-5};
  for (std::size_t k = 0; k < 3; ++k) {
    const Row& row = table.rows[k];
    EXPECT_EQ(row.text("signal"), "points");
    EXPECT_EQ(row.text("points"), "75");
    EXPECT_LT(row.number("low"), truth[k]) << row.text("parameter");
    EXPECT_GT(row.number("high"), truth[k]) << row.text("parameter");
    EXPECT_TRUE(row.has("singular_value"));
  }
}

TEST(CalibratePoints, RefusesWithPlaceAndRemedyBeforeAnyRun) {
  Toy calibrate;
  const auto refused = [&](const std::string& arguments) {
    const Toy::Result run = calibrate.run(arguments + " --out t.csv --progress none");
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_EQ(run.error_lines(), 1) << run.err;
    return run.err;
  };
  const std::string both = "--scene " + scene + " --set data=" + record;
  EXPECT_THAT(refused("--set data=" + record), HasSubstr("give --scene my.toml"));
  EXPECT_THAT(refused(both + " --set fit=gamma"), HasSubstr("by --set by"));
  EXPECT_THAT(refused(both + " --set by=youngs_moduls_pa"), HasSubstr("did you mean"));
  EXPECT_THAT(refused(both + " --set bounds=youngs_modulus_pa:1"),
              HasSubstr("NAME:LOW:HIGH"));
  EXPECT_THAT(refused(both + " --elements 5"), HasSubstr("--elements"));
  EXPECT_THAT(refused("--set by=radius_m"), HasSubstr("records of points"));
  calibrate.write("bad.csv", "time_s,x_m\n0.1,oops\n");
  EXPECT_THAT(refused("--scene " + scene + " --set data=bad.csv"),
              HasSubstr("bad.csv:2:5"));
}

}  // namespace tress::test_calibrate_points
