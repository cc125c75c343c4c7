#include "integrators/control/point_norm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contract/constants.h"

namespace tress::integrators {
namespace {

double distance(In x, std::size_t i, In y, std::size_t j) {
  return std::hypot(x[3 * i] - y[3 * j], x[3 * i + 1] - y[3 * j + 1],
                    x[3 * i + 2] - y[3 * j + 2]);
}

}  // namespace

void PointNorm::start(const MaterialPoints& points, In x) {
  length_ = 0;
  std::vector<double> way(x.size() / 3);
  for (std::size_t i = 0; i < way.size(); ++i) {
    const int before = points.before(static_cast<int>(i));
    if (before < 0) continue;
    const auto j = static_cast<std::size_t>(before);
    way[i] = way[j] + distance(x, i, x, j);
    length_ = std::max(length_, way[i]);
  }
  time_ = std::sqrt(length_ / earth_gravity);
}

void PointNorm::look(In x, In y, double factor, bool velocity) {
  for (std::size_t i = 0; i < x.size() / 3; ++i) {
    const double error = factor * distance(x, i, y, i);
    if (error <= value_) continue;
    value_ = std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    point_ = i;
    velocity_ = velocity;
  }
}

double PointNorm::of(In x, In u, In y, In w) {
  value_ = 0;
  look(x, y, 1 / length_, false);
  look(u, w, time_ / length_, true);
  return value_;
}

std::string PointNorm::where() const {
  return (velocity_ ? "velocity of point " : "position of point ") +
         std::to_string(point_);
}

}  // namespace tress::integrators
