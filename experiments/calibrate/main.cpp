// Which internal friction, air drag and Young's modulus follow from a measured
// oscillation of a strand, and how accurately? Without measured data: does a fit recover
// the true values of simulated records?
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "experiments/calibrate/calibrate.h"
#include "experiments/calibrate/point_fit.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "simulation/files/files.h"

namespace tress::experiments::calibrate {
namespace {

constexpr Column columns[] = {
    {"data",
     "file, or the name of one in experiments/calibrate/data or of a scene, whose truth "
     "is known"},
    {"data_hash", "hash of the text of the data"},
    {"scene", "scenes of records of points"},
    {"signal", "displacement of the tip, envelope of the displacement, or points"},
    {"axis", "axis of the displacement"},
    {"fit", "fitted values; the others are known"},
    {"bounds", "limits of fitted parameters, in their units"},
    {"priors", "values and standard errors that were known before, in their units"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"elements", "number of elements"},
    {"confidence", "confidence level of the intervals"},
    {"records", "oscillations fitted at once"},
    {"points", "data points, or measured coordinates, of all records"},
    {"parameter", "fitted parameter of records of points: one row for each"},
    {"unit", "unit of start, value, low and high"},
    {"start", "value of the scene, from which the fit starts"},
    {"value", "fitted value"},
    {"low", "lower end of its interval; empty: the records do not determine it"},
    {"high", "upper end of its interval"},
    {"singular_value",
     "singular values of the derivatives of the weighted coordinates with respect to the "
     "unknowns (logarithms of positive parameters), descending from row to row"},
    {"undetermined", "combinations of parameters that the records do not determine"},
    {"internal_friction_kg_m3_s", "internal friction"},
    {"internal_friction_low_kg_m3_s",
     "lower end of its interval; empty: known, not fitted"},
    {"internal_friction_high_kg_m3_s", "upper end"},
    {"internal_friction_true_kg_m3_s",
     "internal friction with which simulated records were made"},
    {"drag_kg_m_s", "air drag per length"},
    {"drag_low_kg_m_s", "lower end of its interval; empty: known, not fitted"},
    {"drag_high_kg_m_s", "upper end"},
    {"drag_true_kg_m_s", "air drag with which simulated records were made"},
    {"youngs_modulus_pa", "Young's modulus"},
    {"youngs_modulus_low_pa", "lower end of its interval; empty: known, not fitted"},
    {"youngs_modulus_high_pa", "upper end of its interval"},
    {"youngs_modulus_true_pa", "Young's modulus with which simulated records were made"},
    {"correlation", "correlation of the logarithms of two fitted values, the largest"},
    {"condition",
     "condition number of the derivatives of the signal with respect to the fitted "
     "values"},
    {"residual_rms_m", "root mean square of measured less fitted"},
    {"reduced_chi2", "sum of squares over sigma_m, over the degrees of freedom"},
    {"autocorrelation",
     "autocorrelation of successive residuals: near 0 for errors of measurement"},
    {"profile", "whether intervals by profiles were computed"},
    {"profile_low",
     "lower end of the interval by the profile. There the sum of squares, with the "
     "other values fitted again, rises by the amount that belongs to the confidence "
     "level. Empty: "
     "not computed, or no end"},
    {"profile_high", "upper end of the interval by the profile"},
    {"step_shift",
     "move of the fitted value with half the step, the largest one of oscillations, "
     "half-intervals"},
    {"elements_shift",
     "move of the fitted value with twice the elements, the largest one of oscillations, "
     "half-intervals"},
    {"degrees", "degrees of freedom"},
    {"evaluations", "simulations of all records"},
};

/// For simulated records, non-ok rows are expected results.
bool finding(const Row& row) {
  return row.has("internal_friction_true_kg_m3_s") &&
         (row.status() == "not_identified" || row.status() == "time_error" ||
          row.status() == "space_error");
}

/// Writes measured and fitted coordinates next to the table, for pictures.
void write_points(const CommandLine& line, const std::vector<Row>& rows) {
  if (line.out == "-") return;
  const PointFit fit = point_fit(line, Settings(line, calibrate_settings()));
  const std::string csv = fit.points(rows);
  if (!csv.empty()) replace_file(beside(line.out, "_points.csv"), csv);
}

/// The fitted values with their intervals.
void answer(const CommandLine& line, const std::vector<Row>& rows) {
  if (!rows.empty() && rows.front().text("signal") == "points") {
    print_answer(line, point_answer(rows));
    write_points(line, rows);
    return;
  }
  std::vector<std::string> lines;
  for (const Row& row : rows) {
    const auto value = [&](std::string_view what, std::string_view key,
                           std::string_view unit) {
      const auto end = [&](std::string_view side) {
        return row.number(fmt::format("{}_{}_{}", key, side, unit));
      };
      const double fitted = row.number(fmt::format("{}_{}", key, unit));
      const bool known = !(end("low") < end("high"));
      return known ? fmt::format("{} {:.3g} (known)", what, fitted)
                   : fmt::format("{} {:.3g} ({:.3g} to {:.3g} at {:.3g} %)", what, fitted,
                                 end("low"), end("high"), 1e2 * row.number("confidence"));
    };
    const std::string fit = fmt::format(
        "{}, {}: {} kg m^3/s, {} kg/(m s)", row.text("data"), row.text("model"),
        value("internal friction", "internal_friction", "kg_m3_s"),
        value("drag", "drag", "kg_m_s"));
    lines.push_back(
        row.ok() ? fit
                 : fmt::format("{}; {}: {}", fit, row.status(), row.text("reason")));
  }
  print_answer(line, lines);
}

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene with the strand; without data: the information that a record of "
     "the strand would give",
     true},
};

constexpr Unused unused[] = {not_repeated, not_random};

}  // namespace
}  // namespace tress::experiments::calibrate

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::calibrate;
  const Experiment experiment{
      .name = "calibrate",
      .question = "which parameters of a scene follow from a record?",
      .example = "--set data=measured.csv --set length_m=0.15 --set fit=gamma",
      .sizes = {"8 rows, 10 s", "9 rows, with the slow one"},
      .timed = false,
      .columns = columns,
      .settings = calibrate_settings(),
      .options = command_options,
      .unused = unused,
      .cases = calibrate_cases,
      .checks = check_calibrate_claims,
      .finding = finding,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
