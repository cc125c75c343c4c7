#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "experiments/numerics/fit.h"
#include "experiments/scaling/scaling.h"

namespace tress::experiments::scaling {
namespace {

// Smaller strands mostly measure the constant cost of a step.
constexpr double first_fitted = 20;

std::string series_of(const Row& row) {
  return joined(row, {"structure", "model", "solver", "jacobian", "modes", "grows"});
}

/// Trees have a fixed size.
bool in_series(const Row& row) {
  return row.text("structure") == straight || row.has("grows");
}

struct Which {
  std::string_view structure, solver, elements;
  std::string_view modes = "bend_twist";
};

const Row* stiff(const std::vector<Row>& rows, const Which& which) {
  const auto found = std::ranges::find_if(rows, [&which](const Row& row) {
    return row.ok() && row.text("structure") == which.structure &&
           row.text("model") != "articulated_chain" &&
           row.text("solver") == which.solver && row.text("jacobian") == "elastic" &&
           row.text("modes") == which.modes && row.text("elements") == which.elements;
  });
  return found == rows.end() ? nullptr : &*found;
}

void tell_ratio(const std::vector<Row>& rows, const Which& dear, const Which& cheap,
                const std::string& what, Verdicts& verdicts) {
  const Row* more = stiff(rows, dear);
  const Row* less = stiff(rows, cheap);
  if (more == nullptr || less == nullptr) return;
  verdicts.figure(what,
                  more->number("cost_per_step_s") / less->number("cost_per_step_s"));
}

}  // namespace

void add_exponents(std::vector<Row>& rows) {
  struct Series {
    std::vector<double> sizes, costs;
  };
  std::map<std::string, Series> all;
  for (const Row& row : rows) {
    if (!row.ok() || !in_series(row)) continue;
    const bool of_strands = row.text("grows") == "strands";
    if (!of_strands && row.number("elements") < first_fitted) continue;
    Series& series = all[series_of(row)];
    series.sizes.push_back(row.number(of_strands ? "strands" : "elements"));
    series.costs.push_back(row.number("cost_per_step_s"));
  }
  for (Row& row : rows) {
    const auto found = all.find(series_of(row));
    if (!in_series(row) || found == all.end()) continue;
    if (found->second.sizes.size() < 3) continue;
    row.set("exponent", log_log_slope(found->second.sizes, found->second.costs));
  }
}

void tell_scaling_figures(const std::vector<Row>& rows, Verdicts& verdicts) {
  const Row* usual = stiff(rows, {straight, "recursive", "20"});
  if (usual != nullptr) {
    verdicts.figure("recursive: p of cost ~ N^p, N = 20 to 500",
                    usual->number("exponent"));
    verdicts.figure("recursive, N = 20: seconds per element and step",
                    usual->number("cost_per_element_step_s"));
  }
  tell_ratio(rows, {straight, "composite", "30"}, {straight, "recursive", "30"},
             "composite over recursive at N = 30", verdicts);
  tell_ratio(rows, {straight, "composite", "100"}, {straight, "recursive", "100"},
             "composite over recursive at N = 100", verdicts);
  tell_ratio(rows, {"willow", "composite", "242"}, {"willow", "recursive", "242"},
             "willow: composite over recursive", verdicts);
  tell_ratio(rows, {straight, "recursive", "20"},
             {straight, "recursive", "20", "bend_planar"},
             "recursive, N = 20: bend_twist over bend_planar", verdicts);
}

}  // namespace tress::experiments::scaling
