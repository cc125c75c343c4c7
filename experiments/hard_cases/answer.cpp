#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "experiments/hard_cases/hard_cases.h"

namespace tress::experiments::hard_cases {
namespace {

bool has(const Row& row, Outcome outcome) { return row.text("outcome") == name(outcome); }

/// What became of a method's or a model's runs.
struct Count {
  int runs = 0, stable = 0, accurate = 0;

  void add(const Row& row) {
    const bool is_accurate = has(row, Outcome::accurate);
    ++runs;
    if (is_accurate || has(row, Outcome::stable)) ++stable;
    if (is_accurate) ++accurate;
  }
};

struct OfModel {
  std::string id;
  Count all;
  std::map<std::string, Count> methods;  // by integrator and variant

  /// The methods of which every run stayed stable.
  std::vector<std::string> stable() const {
    std::vector<std::string> found;
    for (const auto& [method, count] : methods) {
      if (count.stable == count.runs) found.push_back(method);
    }
    return found;
  }
};

std::string method(const Row& row) {
  const std::string_view variant = row.text("variant");
  return fmt::format("{}{}", row.text("integrator"),
                     variant.empty() ? "" : fmt::format(" ({})", variant));
}

std::string sentence(const OfModel& model, bool compared) {
  const std::vector<std::string> stable = model.stable();
  const std::string accurate =
      compared ? fmt::format(", {} of them accurate", model.all.accurate) : "";
  const std::string methods =
      stable.empty()
          ? "no method is stable in all of its runs"
          : fmt::format("stable in all of their runs, {} of {} methods: {}",
                        stable.size(), model.methods.size(), fmt::join(stable, ", "));
  return fmt::format("{}: {} of {} runs are stable{}; {}", model.id, model.all.stable,
                     model.all.runs, accurate, methods);
}

/// The criteria of the user's scene that ended runs, by name, with their numbers.
std::vector<std::string> broken_criteria(const std::vector<Row>& rows) {
  std::map<std::pair<std::string, std::string>, int> broken;
  for (const Row& row : rows) {
    const std::string_view measure = row.text("measure_name");
    const bool named = measure == "depth_m" || measure == "stretch";
    if (!has(row, Outcome::unstable) || !named || row.has("error_rel")) continue;
    if (!(row.number("measure") > row.number("limit"))) continue;
    ++broken[{std::string(measure), std::string(row.text("limit"))}];
  }
  std::vector<std::string> lines;
  for (const auto& [criterion, runs] : broken) {
    const auto& [measure, limit] = criterion;
    lines.push_back(fmt::format(
        "{} of the unstable runs end at the criterion {} > {:.3g} alone; --set most_{}=X "
        "moves it",
        runs, measure, std::stod(limit), measure));
  }
  return lines;
}

}  // namespace

std::vector<std::string> hard_answer(const std::vector<Row>& rows) {
  std::vector<OfModel> models;
  std::size_t refused = 0;
  bool compared = false;  // with a reference
  double simulated = 0;
  for (const Row& row : rows) {
    if (has(row, Outcome::refused)) {
      ++refused;
      continue;
    }
    auto model = std::ranges::find(models, row.text("model"), &OfModel::id);
    if (model == models.end()) {
      model = models.insert(model, OfModel{std::string(row.text("model")), {}, {}});
    }
    model->all.add(row);
    model->methods[method(row)].add(row);
    compared = compared || row.has("error_rel");
    if (row.has("t_s") && row.ok()) simulated = std::max(simulated, row.number("t_s"));
  }
  std::ranges::stable_sort(models, std::greater<>(), [](const OfModel& model) {
    return static_cast<double>(model.all.stable) / model.all.runs;
  });
  std::vector<std::string> lines;
  for (const OfModel& model : models) lines.push_back(sentence(model, compared));
  for (std::string& line : broken_criteria(rows)) lines.push_back(std::move(line));
  if (refused > 0) {
    lines.push_back(
        fmt::format("not supported: {} of {} runs; the column 'why' has the reasons",
                    refused, rows.size()));
  }
  if (simulated > 0) {
    lines.push_back(fmt::format(
        "valid for the first {:.3g} s, the time that was simulated", simulated));
  }
  return lines;
}

}  // namespace tress::experiments::hard_cases
