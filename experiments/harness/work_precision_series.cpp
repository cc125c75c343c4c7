#include "experiments/harness/work_precision_series.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

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
  double x_mean = 0, y_mean = 0;
  for (const Point& p : points) {
    x_mean += std::log(p.step) / static_cast<double>(points.size());
    y_mean += std::log(p.error) / static_cast<double>(points.size());
  }
  double xx = 0, xy = 0;
  for (const Point& p : points) {
    const double x = std::log(p.step) - x_mean;
    xx += x * x;
    xy += x * (std::log(p.error) - y_mean);
  }
  return xy / xx;
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
