#include "experiments/validation/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "contract/input_error.h"
#include "experiments/numerics/fit.h"
#include "experiments/validation/free_flight.h"
#include "simulation/files/parse.h"

namespace tress::experiments::validation {
namespace {

constexpr Column columns[] = {
    {"test", "published test"},
    {"model", "catalogue id"},
    {"variant", "model's length formulation, where there is a choice"},
    {"elements", "number of elements"},
    {"parameter", "parameter of the test; the manifest's glossary defines it"},
    {"measured", "value that the model gives"},
    {"reference", "value of the continuous rod"},
    {"error_rel", "|measured/reference - 1|"},
    {"accepted_error_rel", "largest error_rel that passes"},
    {"judged", "whether the test sets a tolerance for this number of elements"},
    {"passed", "error_rel <= tolerance"},
    {"order", "error ~ elements^-order at this parameter"},
    {"integrator", "free_flight: method; the other tests have one of their own"},
    {"dt_s", "free_flight: fixed step"},
    {"rtol", "free_flight: relative and absolute tolerance, adaptive methods"},
    {"t_end_s", "length of the flight"},
    {"linear_error_rel",
     "largest change of linear momentum over the flight, over its initial value"},
    {"angular_error_rel",
     "largest change of angular momentum about the origin over the flight, over "
     "its initial value"},
    {"angular_change_rel", "change of the size of angular momentum from start to end"},
    {"energy_change_rel", "change of mechanical energy from start to end, over it"},
    {"steps", "accepted steps of the flight"},
};

constexpr Parameter settings_table[] = {
    {.name = "tests",
     .help = "tests to run, as in cantilever,free_flight; empty: all",
     .text = true},
    {.name = "parameters",
     .help = "values of the tests' parameter instead of their own, as in 0.1;10",
     .rows = true},
};

struct Work {
  const ValidationTest* test;
  ModelVariant variant;
  int elements;
  double parameter;
};

void measure(const Work& work, Row& row, const Deadline& deadline) {
  const ValidationTest& test = *work.test;
  const double reference = test.reference(work.parameter);
  const bool judged = work.elements >= test.judged_from;
  row.set("reference", reference)
      .set("accepted_error_rel", test.tolerance)
      .set("judged", judged);
  try {
    const double measured =
        test.measure({work.variant, work.elements, work.parameter, deadline});
    const double error = std::abs(measured / reference - 1);
    row.set("measured", measured).set("error_rel", error);
    row.set("passed", error <= test.tolerance);
  } catch (const InputError& refused) {
    row.failed("refused", refused.what());
  } catch (const std::runtime_error& failure) {
    row.failed("failed", failure.what());
  }
}

std::vector<std::string> chosen_tests(const CommandLine& line, const Settings& settings) {
  const std::string_view names = settings.experiment().word("tests");
  if (!names.empty()) return split(names, ',', "--set tests");
  std::vector<std::string> all;
  // Only free_flight has a choice of integrators.
  if (line.integrators.empty()) {
    for (const ValidationTest& test : validation_tests()) all.emplace_back(test.name);
  }
  all.emplace_back(free_flight);
  return all;
}

std::string range_text(const ValidationTest& test) {
  const auto [low, high, whole] = test.range;
  if (low == high) return fmt::format("{}: this test has no parameter", low);
  return fmt::format("{} from {} to {}: {}", whole ? "a whole number" : "a number", low,
                     high, test.parameter);
}

ValidationTest::Grid grid(const ValidationTest& test, const CommandLine& line,
                          const Settings& settings) {
  ValidationTest::Grid grid = line.quick  ? test.quick
                              : line.full ? test.full
                                          : test.usual;
  if (!line.elements.empty()) grid.elements = line.elements;
  const auto parameters = settings.experiment().numbers("parameters");
  if (!parameters.empty()) grid.parameters.assign(parameters.begin(), parameters.end());
  for (const double p : grid.parameters) {
    const auto [low, high, whole] = test.range;
    if (p >= low && p <= high && !(whole && p != std::floor(p))) continue;
    throw InputError(fmt::format("{} has no parameter {}", test.name, p),
                     "--set parameters", "give " + range_text(test));
  }
  return grid;
}

Row identity(const ValidationTest& test, const ModelVariant& variant) {
  Row row;
  row.set("test", test.name).set("model", variant.model->id);
  if (!variant.words.empty()) row.set("variant", variant.words);
  return row;
}

/// The test's grid for every variant of every model, or one row with the reason why the
/// test refuses it.
void add_cases(const ValidationTest& test, const CommandLine& line,
               const Settings& settings, std::vector<Case>& all) {
  if (!line.integrators.empty()) {
    throw InputError(std::string(test.name) + " has an integrator of its own",
                     line.place("integrators"),
                     "leave it out, or ask for --set tests=free_flight");
  }
  const auto [parameters, elements] = grid(test, line, settings);
  for (const ModelVariant& variant : length_variants()) {
    if (!wanted(line.models, variant.model->id)) continue;
    const Row name = identity(test, variant);
    std::string reason = test.refusal ? test.refusal(variant) : "";
    const bool slow = std::ranges::find(test.slow, variant.model->id) != test.slow.end();
    if (reason.empty() && slow && line.quick && line.models.empty()) {
      reason = "takes minutes: left out by --quick";
    }
    if (!reason.empty()) {
      all.push_back(
          {name, [reason](Row& row, const Deadline&) { row.failed("refused", reason); }});
      continue;
    }
    for (const double parameter : parameters) {
      for (const int n : elements) {
        Row row = name;
        row.set("elements", n).set("parameter", parameter);
        const Work work{&test, variant, n, parameter};
        all.push_back({row, [work](Row& of_case, const Deadline& deadline) {
                         measure(work, of_case, deadline);
                       }});
      }
    }
  }
}

}  // namespace

std::span<const Column> validation_columns() { return columns; }

std::vector<Gloss> validation_glossary() {
  std::vector<Gloss> all;
  for (const ValidationTest& test : validation_tests()) {
    all.push_back({"test",
                   test.name,
                   {{"what", test.what},
                    {"source", test.source},
                    {"parameter", test.parameter},
                    {"quantity", test.quantity},
                    {"why", test.why}}});
  }
  all.push_back(free_flight_gloss());
  return all;
}

std::span<const Parameter> validation_settings() { return settings_table; }

std::vector<Case> validation_cases(const CommandLine& line, const Settings& settings) {
  std::vector<Case> all;
  for (const std::string& name : chosen_tests(line, settings)) {
    if (name == free_flight) {
      std::ranges::move(free_flight_cases(line, settings), std::back_inserter(all));
    } else {
      add_cases(find_validation_test(name), line, settings, all);
    }
  }
  return all;
}

void fit_validation_orders(std::vector<Row>& rows) {
  // Equilibria are accurate to 1e-9 of their sizes, thresholds to a relative 1e-6.
  constexpr double rounding = 2e-6;
  struct Series {
    std::vector<double> elements, errors;
    std::vector<Row*> rows;
  };
  std::map<std::string, Series> all;
  for (Row& row : rows) {
    const double error = row.number("error_rel");
    if (!row.ok() || !(error > rounding)) continue;
    Series& series = all[joined(row, {"test", "model", "variant", "parameter"})];
    series.elements.push_back(row.number("elements"));
    series.errors.push_back(error);
    series.rows.push_back(&row);
  }
  for (const auto& [key, series] : all) {
    if (std::ranges::minmax(series.elements).min ==
        std::ranges::minmax(series.elements).max) {
      continue;
    }
    const double order = -log_log_slope(series.elements, series.errors);
    for (Row* row : series.rows) row->set("order", order);
  }
}

void check_validation(const std::vector<Row>& rows, Verdicts& verdicts) {
  for (const ValidationTest& test : validation_tests()) {
    for (const std::string_view model : test.claimed) {
      const std::string claim = std::string(test.name) + ", " + std::string(model) +
                                ": " + std::string(test.quantity) +
                                " as in the reference";
      std::optional<double> worst;
      for (const Row& row : rows) {
        if (row.text("test") != test.name || row.text("model") != model) continue;
        // A killed row does not record whether it is judged.
        const bool judged = row.has("judged")
                                ? row.text("judged") == "true"
                                : row.number("elements") >= test.judged_from;
        if (!judged) continue;
        const double error = row.number("error_rel");
        worst = std::isnan(error) ? INFINITY : std::max(worst.value_or(0), error);
      }
      if (worst) {
        verdicts.check(claim, *worst <= test.tolerance, *worst);
      } else {
        verdicts.not_judged(claim);
      }
    }
  }
  check_free_flight(rows, verdicts);
}

}  // namespace tress::experiments::validation
