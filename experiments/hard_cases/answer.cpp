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
