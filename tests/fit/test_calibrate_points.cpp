#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "contract/read_file.h"
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
  EXPECT_THAT(run.err, Not(HasSubstr("claims of the study")));
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
  // Next to it, what pictures are drawn from: as far apart as the table tells, but for
  // the digits of both.
  const CsvTable points = parse_csv(calibrate.read("fit_points.csv"), "fit_points.csv");
  ASSERT_EQ(points.rows.size(), 75u);
  double squares = 0;
  for (const Row& row : points.rows) {
    EXPECT_EQ(row.text("point"), "tip");
    EXPECT_EQ(row.number("sigma_m"), 5e-4);
    squares += std::pow(row.number("measured_m") - row.number("fitted_m"), 2);
  }
  const double rms = table.rows[0].number("residual_rms_m");
  EXPECT_NEAR(std::sqrt(squares / 75), rms, 1e-4 * rms);
}

/// Rows of a record until 1.2 s.
std::string beginning(const std::string& csv) {
  std::istringstream all(csv);
  std::string text, line;
  for (bool header = true; std::getline(all, line); header = false) {
    if (header || std::stod(line) <= 1.2) text += line + "\n";
  }
  return text;
}

// A rod buckles at 0.3 s in a gripper whose pose is known with errors. Its side is that
// of the record, which begins at 0.5 s: else nothing of the fit would be within 0.1 m.
// One trial of 0.7 s determines the bending stiffness, a quarter of the truth where the
// fit starts, within 5 %. All four take minutes: data/README.md.
TEST(CalibratePoints, FindsTheStiffnessOfARodThatBuckles) {
  Toy calibrate;
  calibrate.write("beginning.csv",
                  beginning(tress::read_file(CALIBRATE_DATA "/buckling_0.csv")));
  const Toy::Result run =
      calibrate.run("--scene " CALIBRATE_DATA
                    "/buckling_0.toml --set data=beginning.csv --out fit.csv "
                    "--progress none");
  EXPECT_NE(run.code, 2) << run.err;
  const CsvTable table = parse_csv(calibrate.read("fit.csv"), "fit.csv");
  ASSERT_EQ(table.rows.size(), 3u) << run.err;
  const double modulus = table.rows[0].number("value"),
               radius = table.rows[1].number("value");
  // Of an ellipse of half-axes sqrt(2) r and r/sqrt(2): 10 N m^2.
  const double bending = modulus * std::numbers::pi * std::pow(radius, 4) / 8;
  EXPECT_NEAR(bending, 10, 0.05 * 10);
  EXPECT_LT(table.rows[0].number("residual_rms_m"), 6e-4);  // 0.5 mm are noise
  const double friction = 0.3;                              // N m^2 s
  EXPECT_LT(table.rows[2].number("low"), friction);
  EXPECT_GT(table.rows[2].number("high"), friction);
}

TEST(CalibratePoints, RefusesWithPlaceAndRemedyBeforeAnyRun) {
  Toy calibrate;
  const auto refused = [&](const std::string& arguments) {
    const auto before = calibrate.files();
    const Toy::Result run = calibrate.run(arguments + " --out t.csv --progress none");
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_EQ(run.error_lines(), 1) << run.err;
    EXPECT_EQ(calibrate.files(), before) << arguments;
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
  calibrate.write("nan.csv", "time_s,x_m,y_m\n0.1,0,nan\n");
  EXPECT_THAT(refused("--scene " + scene + " --set data=nan.csv"),
              HasSubstr("(nan.csv:2:7): give a number, or leave the cell empty"));
  calibrate.write("short.csv", "time_s,x_m,y_m\n0.1,0,0\n0.2,0\n0.3,0,0\n");
  EXPECT_THAT(refused("--scene " + scene + " --set data=short.csv"),
              HasSubstr("(short.csv:3:1): give one cell for each column"));
  calibrate.write("empty.csv", "");
  calibrate.write("blank.csv", "\n\n");
  for (const char* by : {"", " --set by=radius_m"}) {
    for (const std::string file : {"empty.csv", "blank.csv"}) {
      EXPECT_THAT(refused("--scene " + scene + " --set data=" + file + by),
                  HasSubstr("the file is empty (" + file + ":1:1): give the columns"));
    }
  }
  calibrate.write("semicolons.csv", "time_s;x_m;y_m\n0,1;0,02;0\n");
  EXPECT_THAT(
      refused("--scene " + scene + " --set data=semicolons.csv"),
      HasSubstr("separated by ';' (semicolons.csv:1:7): separate columns by ','"));
  EXPECT_THAT(refused(both + " --set by=linear_drag.drag_kg_m_s.w"),
              HasSubstr("linear_drag.drag_kg_m_s is one number (--set by"));
  calibrate.write("header.csv", "t,x,y,z\n0.1,0,0,0\n");
  EXPECT_THAT(refused("--scene " + scene + " --set data=header.csv"),
              HasSubstr("time_s, x_m, y_m, z_m"));
  EXPECT_THAT(refused(both + "," + record), HasSubstr("a record that is given twice"));
}

// A record, a bound or a prior that does not fit the scene, and a scene whose run has no
// derivatives.
TEST(CalibratePoints, RefusesWhatDoesNotFitTheSceneBeforeAnyRun) {
  Toy calibrate;
  const auto refused = [&](const std::string& arguments) {
    const auto before = calibrate.files();
    const Toy::Result run = calibrate.run("--scene " + scene + " " + arguments +
                                          " --out t.csv --progress none");
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_EQ(run.error_lines(), 1) << run.err;
    EXPECT_EQ(calibrate.files(), before) << arguments;
    return run.err;
  };
  calibrate.write("strand.csv", "time_s,strand,x_m\n0.1,0,0\n0.2,1,0\n0.3,0,0\n");
  EXPECT_THAT(refused("--set data=strand.csv"),
              HasSubstr("has no strand 1 (strand.csv:3:5): it has 1, the first is 0"));
  calibrate.write("millimetres.csv", "time_s,x_m\n0.1,0\n0.2,80\n0.3,0\n");
  EXPECT_THAT(
      refused("--set data=millimetres.csv"),
      AllOf(HasSubstr("x_m = 80 m is "), HasSubstr("more than 10 times its length"),
            HasSubstr("millimetres.csv:3:1"), HasSubstr("give coordinates in metres")));
  calibrate.write("point.csv", "time_s,x_m,point\n0.1,0,0\n0.2,0,41\n0.3,0,0\n");
  EXPECT_THAT(refused("--set data=point.csv"),
              HasSubstr("no point 41 (point.csv:3:7): it has points 0 to 40"));
  calibrate.write("late.csv", "time_s,x_m\n0.1,0\n0.6,0\n0.2,0\n0.3,0\n");
  EXPECT_THAT(refused("--set data=late.csv"),
              HasSubstr("the last time_s = 0.6 is after the end of scene swinging_curl, "
                        "which lasts 0.5 s (late.csv:3:1): set duration_s = 0.6"));
  calibrate.write("few.csv", "time_s,x_m\n0.1,0\n0.2,0\n0.3,0\n");
  EXPECT_THAT(refused("--set data=few.csv"),
              HasSubstr("measured coordinates: 3 for 3 parameters"));
  EXPECT_THAT(refused("--set data=" + record + " --set by=linear_dragg.drag_kg_m_s"),
              HasSubstr("(--set by=linear_dragg.drag_kg_m_s)"));
  const auto with = [&](const std::string& setting) {
    return refused("--set data=" + record + " --set " + setting);
  };
  EXPECT_THAT(with("bounds=youngs_modulus_pa:5e9:1e9"),
              HasSubstr("(--set bounds=youngs_modulus_pa:5e9:1e9): give a lower limit"));
  EXPECT_THAT(with("bounds=youngs_modulus_pa:1e9:2e9"), HasSubstr("change the scene"));
  EXPECT_THAT(with("bounds=youngs_modulus_pa:1e9:1e99"), HasSubstr("its range"));
  EXPECT_THAT(with("bounds=radius_m:1e-6:1e-4"), HasSubstr("which is not fitted (--set"));
  EXPECT_THAT(with("priors=youngs_modulus_pa:3e9:0"), HasSubstr("(--set priors="));
  EXPECT_THAT(with("priors=radius_m:4e-5:1e-6"), HasSubstr("which is not fitted (--set"));
  EXPECT_THAT(refused("--set data=" + record + " --integrators velocity_verlet"),
              HasSubstr("no gradient"));
}

}  // namespace tress::test_calibrate_points
