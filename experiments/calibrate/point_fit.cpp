#include "experiments/calibrate/point_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "simulation/files/csv.h"
#include "simulation/files/parse.h"
#include "simulation/fit/record_runs.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::experiments::calibrate {
namespace {

constexpr double most_work = 2e7;  // per run
constexpr std::string_view of_oscillations[] = {"fit",       "signal",  "axis",
                                                "horizon_s", "noise_m", "noise_seed"};

/// Sets the parameters: those of --set by, or of the scene.
void set_parameters(const CommandLine& line, std::string_view given, const Scene& scene,
                    FitTask& task) {
  if (!given.empty()) {
    task.by = names_of(given);
    task.place = line.place("set:by");
    return;
  }
  refuse_if(scene.tables == nullptr || !scene.tables->gradient,
            fmt::format("scene {} does not say what to fit", scene.name),
            line.place("set:scenes"),
            "give --set by=youngs_modulus_pa, or [gradient] by in the scene");
  const Table& gradient = *scene.tables->gradient;
  task.by = names_of(gradient.values().word("by"));
  task.place = gradient.place("by");
}

/// Refuses points that no pose of their strand comes near: of a file in another unit.
void check_distances(const PointRecord& record, const Scene& scene) {
  constexpr double most_lengths = 10;
  for (const Observation& one : record.observations) {
    if (one.strand >= scene.strands.size()) continue;  // check_fit() refuses it
    const Strand& strand = scene.strands[one.strand];
    if (strand.free_root) continue;
    const Vec at = strand.root.at(one.t).x;
    const double root = std::array{at.x, at.y, at.z}[one.component];
    const double distance = std::abs(one.value - root), length = strand.length();
    refuse_if(
        distance > most_lengths * length,
        fmt::format("{}_m = {:g} m is {:.3g} m from the root of a strand of {:.3g} "
                    "m, more than {:g} times its length",
                    "xyz"[one.component], one.value, distance, length, most_lengths),
        record.place(one, &RowPlace::time), "give coordinates in metres");
  }
}

}  // namespace

bool are_points(const std::vector<std::string>& files) {
  if (files.empty()) return false;
  const std::string& file = files.front();
  const CsvTable table = read_csv(file);
  refuse_if(table.header.empty(), "the file is empty", file + ":1:1",
            "give the columns time_s, x_m, y_m, z_m of points, or t_s, amplitude_m of "
            "oscillations");
  return has_points(table.header);
}

PointFit point_fit(const CommandLine& line, const Settings& settings) {
  const Parameters& own = settings.experiment();
  for (const std::string_view key : of_oscillations) {
    refuse_if(
        settings.chosen(key),
        fmt::format("'{}' is of records of oscillations, and these are of points", key),
        line.place(fmt::format("set:{}", key)),
        key == "fit" ? "name the parameters by --set by" : "leave it out");
  }
  refuse_if(own.word("scenes").empty(),
            "records of points need the scene of their strand", line.place("set:data"),
            "give --scene my.toml");
  leave_strands_to_the_scene(line);
  settings.leave_models_to_the_scene();
  refuse_if(line.integrators.size() > 1, "several methods for one fit",
            line.place("integrators"), "give one");
  PointFit all;
  all.scenes = read_scenes(listed_files(own.word("scenes"), line.place("set:scenes")));
  for (Scene& scene : all.scenes) {
    if (!line.integrators.empty()) {
      scene.integrator = find_integrator(line.integrators.front()).id;
    }
    scene.options = settings.options(scene.options);
    if (scene.options.max_work == 0) scene.options.max_work = most_work;
  }
  for (const std::string& file : split(own.word("data"), ',', line.place("set:data"))) {
    all.records.push_back(read_point_record(file));
  }
  refuse_if(
      all.scenes.size() > 1 && all.scenes.size() != all.records.size(),
      fmt::format("{} scenes for {} records", all.scenes.size(), all.records.size()),
      line.place("set:scenes"), "give one scene for all records, or one for each");
  for (std::size_t i = 0; i < all.records.size(); ++i) {
    check_distances(all.records[i], all.scenes[all.scenes.size() > 1 ? i : 0]);
  }
  all.bounds = own.word("bounds");
  all.priors = own.word("priors");
  set_parameters(line, own.word("by"), all.scenes.front(), all.asked);
  all.asked.bounds = parse_bounds(all.bounds, line.place("set:bounds"));
  all.asked.priors = parse_priors(all.priors, line.place("set:priors"));
  all.asked.profile = own.word("profile") == "on";
  all.asked.confidence = own.number("confidence");
  check_fit(all.task());
  return all;
}

FitTask PointFit::task() const {
  FitTask all = asked;
  for (std::size_t i = 0; i < records.size(); ++i) {
    all.records.push_back({&scenes[scenes.size() > 1 ? i : 0], &records[i]});
  }
  return all;
}

Row PointFit::identity() const {
  Row hashed;
  std::string data, scene;
  std::size_t strands = 0;
  for (const PointRecord& one : records) {
    data += (data.empty() ? "" : ",") + one.file;
    hashed.set("record " + one.file, one.hash);
  }
  for (const Scene& one : scenes) {
    scene += (scene.empty() ? "" : ",") + one.name;
    hashed.set("scene " + one.name, scene_text(one));
    strands += one.strands.size();
  }
  const Scene& first = scenes.front();
  Row row;
  row.set("data", data).set("data_hash", run_id("records and scenes", hashed));
  row.set("scene", scene)
      .set("signal", "points")
      .set("fit", fmt::format("{}", fmt::join(asked.by, ",")));
  row.set("bounds", bounds).set("priors", priors);
  row.set("profile", asked.profile ? "on" : "off");
  row.set("model", first.model->id).set("integrator", first.integrator);
  row.set("elements", first.strands.empty() ? 0 : first.strands.front().segments.size());
  row.set("confidence", asked.confidence);
  return row;
}

std::vector<Row> PointFit::rows(const Row& identity) const {
  std::size_t points = 0;
  for (const PointRecord& one : records) points += one.observations.size();
  const SceneFit fit = fit_scenes(task());
  std::vector<Row> all;
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FittedParameter& one = fit.parameters[k];
    Row row = identity;
    row.set("records", records.size()).set("points", points);
    row.set("parameter", one.name).set("unit", one.unit).set("start", one.start);
    row.set("value", one.value).set("low", one.low).set("high", one.high);
    row.set("profile_low", one.profile_low).set("profile_high", one.profile_high);
    row.set("step_shift", one.step_shift).set("elements_shift", one.elements_shift);
    if (k < fit.singular.size()) row.set("singular_value", fit.singular[k]);
    row.set("residual_rms_m", fit.rms).set("reduced_chi2", fit.reduced_chi2);
    row.set("autocorrelation", fit.autocorrelation).set("degrees", fit.degrees);
    row.set("evaluations", fit.evaluations);
    if (!fit.undetermined.empty()) row.set("undetermined", fit.undetermined);
    if (one.status != "ok") row.failed(one.status, one.reason);
    all.push_back(std::move(row));
  }
  return all;
}

std::string PointFit::points(const std::vector<Row>& rows) const {
  const FitTask fit = task();
  const RecordRuns runs(fit);
  std::vector<double> values, fitted(runs.count()), by(runs.count() * rows.size());
  for (const Row& row : rows) values.push_back(row.number("value"));
  if (!runs.run(values, RecordRuns::Finer::no, fitted, by).empty()) return {};
  std::string csv = csv_line(std::vector<std::string>{"record", "strand", "point",
                                                      "time_s", "component", "measured_m",
                                                      "sigma_m", "fitted_m"});
  std::size_t k = 0;
  for (const PointRecord& record : records) {
    for (std::size_t i = 0; i < record.observations.size(); ++i, ++k) {
      const Observation& one = record.observations[i];
      csv += csv_line(std::vector<std::string>{
          record.file, std::to_string(one.strand),
          one.point ? std::to_string(*one.point) : "tip", fmt::format("{:.9g}", one.t),
          std::string(1, "xyz"[one.component]), fmt::format("{:.9g}", one.value),
          record.sigma.empty() ? "" : fmt::format("{:.4g}", record.sigma[i]),
          fmt::format("{:.9g}", fitted[k])});
    }
  }
  return csv;
}

std::vector<std::string> point_answer(const std::vector<Row>& rows) {
  std::vector<std::string> lines, reasons;
  for (const Row& row : rows) {
    std::string text = fmt::format("{} = {:.4g} {}", row.text("parameter"),
                                   row.number("value"), row.text("unit"));
    if (row.has("low")) {
      text += fmt::format(" ({:.4g} to {:.4g} at {:.3g} %)", row.number("low"),
                          row.number("high"), 1e2 * row.number("confidence"));
    }
    if (row.text("profile") == "on" && row.has("low")) {
      const auto end = [&](std::string_view key) {
        return row.has(key) ? fmt::format("{:.4g}", row.number(key))
                            : std::string("open");
      };
      text += fmt::format("; by its profile {} to {}", end("profile_low"),
                          end("profile_high"));
    }
    if (row.has("step_shift")) {
      text += fmt::format(
          "; half the step moves it by {:.2g}, twice the elements by {:.2g} of half the "
          "interval",
          row.number("step_shift"), row.number("elements_shift"));
    }
    if (!row.ok()) text += fmt::format("; {}", row.status());
    lines.push_back(std::move(text));
    std::string reason(row.text("reason"));
    if (!row.ok() && std::ranges::count(reasons, reason) == 0) {
      reasons.push_back(std::move(reason));
    }
  }
  if (!rows.empty()) {
    const Row& row = rows.front();
    lines.push_back(
        fmt::format("{} coordinates; root mean square of measured less fitted {:.3g} mm",
                    row.text("points"), 1e3 * row.number("residual_rms_m")));
    const bool known = row.has("reduced_chi2") && row.has("degrees");
    if (known && simulation::too_small(row.number("reduced_chi2"),
                                       static_cast<int>(row.number("degrees")))) {
      lines.push_back(fmt::format(
          "residuals are too small for sigma_m (reduced chi^2 {:.2g}): sigma_m is too "
          "large, and so are the intervals",
          row.number("reduced_chi2")));
    }
  }
  lines.insert(lines.end(), reasons.begin(), reasons.end());
  return lines;
}

}  // namespace tress::experiments::calibrate
