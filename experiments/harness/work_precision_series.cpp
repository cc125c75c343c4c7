#include "experiments/harness/work_precision_series.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "experiments/harness/fit.h"
#include "experiments/harness/pareto.h"

namespace tress {
namespace {

// Finest points that make a slope; coarser ones are often before the asymptotic range.
constexpr std::size_t fitted_points = 4;

// Errors this close to the reference's own, or to rounding, say nothing about order.
constexpr double rounding = 1e-12;

struct Point {
  double step, error;
};

double slope(const std::vector<Point>& points) {
  std::vector<double> steps, errors;
  for (const Point& p : points) {
    steps.push_back(p.step);
    errors.push_back(p.error);
  }
  return log_log_slope(steps, errors);
}

std::string series_of(const Row& row) {
  std::string key(row.text("scene"));
  return key.append("/")
      .append(row.text("integrator"))
      .append("/")
      .append(row.text("formulation"));
}

void add_orders(std::vector<Row>& rows) {
  std::map<std::string, std::vector<Point>> series;
  for (const Row& row : rows) {
    if (!row.ok() || !row.has("dt_s") || row.text("below_reference") == "true") continue;
    if (row.number("error_rel") > rounding) {
      series[series_of(row)].push_back({row.number("dt_s"), row.number("error_rel")});
    }
  }
  for (auto& [key, points] : series) {
    std::ranges::sort(points, {}, &Point::step);
    if (points.size() > fitted_points) points.resize(fitted_points);
  }
  for (Row& row : rows) {
    const auto found = series.find(series_of(row));
    if (row.has("dt_s") && found != series.end() && found->second.size() >= 3) {
      row.set("order_fit", slope(found->second));
    }
  }
}

}  // namespace

void add_series_columns(std::vector<Row>& rows) {
  add_orders(rows);
  add_pareto(rows, "error_rel",
             [](const Row& row) { return std::string(row.text("scene")); });
}

}  // namespace tress
