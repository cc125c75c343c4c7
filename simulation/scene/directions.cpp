#include "simulation/scene/directions.h"

#include <cmath>
#include <string>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

// For any user input, including 1e200.
double size(const Vec& x) { return std::hypot(x.x, x.y, x.z); }

}  // namespace

Vec direction(const Table& table, std::string_view key) {
  const Vec given = table.values().vec(key);
  const double length = size(given);
  if (length > 0) return Vec{given.x / length, given.y / length, given.z / length};
  throw InputError(std::string(key) + " has no direction", table.place(key),
                   "give three numbers that are not all 0");
}

Vec across(const Vec& axis, const Vec& x) {
  // Twice, to remove the rounding error that the first pass leaves along the axis.
  Vec rest = x - dot(axis, x) * axis;
  rest = rest - dot(axis, rest) * axis;
  const double left = size(rest);
  return left > 1e-9 * size(x) ? 1 / left * rest : Vec{};
}

Frame frame_of(const Vec& tangent, const Vec& normal) {
  return {tangent, normal, cross(tangent, normal)};
}

}  // namespace tress::simulation
