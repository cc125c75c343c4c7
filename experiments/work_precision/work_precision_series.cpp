#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "experiments/numerics/fit.h"
#include "experiments/work_precision/work_precision.h"

namespace tress::experiments::work_precision {
namespace {

// Number of finest points in a slope; coarser ones are often pre-asymptotic.
constexpr std::size_t fitted_points = 4;

// Errors this close to the reference's own, or to rounding, do not indicate the order.
constexpr double rounding = 1e-12;

/// Largest gap of a reference that gives an order: 10^-5.5, more than five digits.
constexpr double largest_gap = 3.2e-6;

struct Point {
  double size, error;  // of a step or an element
};

/// Errors below it that do not fall by half with the step are at the floor of rounding,
/// which differs between methods. Four times the floor change a slope of two halvings by
/// log2(5/4) / 2 = 0.16 at most.
constexpr double looked_at = 1e-10, clear_of_floor = 4;

/// Leaves out the finest points of a series, sorted by size, at the floor of rounding.
void drop_floor(std::vector<Point>& points) {
  double floor = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (points[i].error > looked_at || points[i].error < points[i + 1].error / 2) break;
    floor = std::max({floor, points[i].error, points[i + 1].error});
  }
  std::erase_if(points, [&](const Point& p) { return p.error < clear_of_floor * floor; });
}

double slope(const std::vector<Point>& points) {
  std::vector<double> sizes, errors;
  for (const Point& p : points) {
    sizes.push_back(p.size);
    errors.push_back(p.error);
  }
  return log_log_slope(sizes, errors);
}

bool is_total(const Row& row) { return row.text("error_kind") == "total"; }

/// Columns that identify a curve of total errors.
std::string curve_of(const Row& row) {
  return joined(row, {"scene", "model", "integrator", "solver"});
}

/// Time errors fall with the step, total ones with the length of an element.
std::string series_of(const Row& row) {
  return is_total(row) ? joined(row, {"scene", "model", "integrator", "solver", "dt_s"})
                       : joined(row, {"scene", "model", "integrator", "formulation",
                                      "solver", "elements"});
}

/// The smallest step of every series of total errors: where time error is least.
std::map<std::string, double> finest_steps(const std::vector<Row>& rows) {
  std::map<std::string, double> finest;
  for (const Row& row : rows) {
    if (!is_total(row) || !row.ok()) continue;
    const double step = row.number("dt_s");
    const auto [place, fresh] = finest.emplace(curve_of(row), step);
    place->second = std::min(place->second, step);
  }
  return finest;
}

void add_orders(std::vector<Row>& rows) {
  const auto finest = finest_steps(rows);
  const auto fitted = [&finest](const Row& row) {
    // For the swing, steps are balanced with elements and Newton's iteration ends early.
    if (!row.ok() || !row.has("dt_s") || row.text("scene") == swing.name) return false;
    return !is_total(row) || row.number("dt_s") == finest.at(curve_of(row));
  };
  std::map<std::string, std::vector<Point>> series;
  for (const Row& row : rows) {
    if (!fitted(row) || row.text("below_reference") == "true") continue;
    if (row.has("reference_gap") && row.number("reference_gap") > largest_gap) continue;
    const double x = is_total(row) ? 1 / row.number("elements") : row.number("dt_s");
    if (row.number("error_rel") > rounding) {
      series[series_of(row)].push_back({x, row.number("error_rel")});
    }
  }
  for (auto& [key, points] : series) {
    std::ranges::sort(points, {}, &Point::size);
    drop_floor(points);
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

void add_pareto(std::vector<Row>& rows, std::string_view error,
                const std::function<std::string(const Row&)>& group) {
  struct Run {
    Row* row;
    double wall, error;
  };
  std::map<std::string, std::vector<Run>> groups;
  for (Row& row : rows) {
    if (!row.ok()) continue;
    groups[group(row)].push_back({&row, row.number("wall_s"), row.number(error)});
  }
  for (const auto& [key, runs] : groups) {
    for (const Run& run : runs) {
      const bool dominated = std::ranges::any_of(runs, [&run](const Run& other) {
        return other.wall < run.wall && other.error < run.error;
      });
      run.row->set("pareto", !dominated);
    }
  }
}

void add_series_columns(std::vector<Row>& rows) {
  add_orders(rows);
  add_pareto(rows, "error_rel", [](const Row& row) {
    // Total errors compete across numbers of elements, time errors do not.
    return is_total(row) ? joined(row, {"scene", "error_kind"})
                         : joined(row, {"scene", "error_kind", "elements"});
  });
}

}  // namespace tress::experiments::work_precision
