#include "simulation/groom/frames.h"

#include <cmath>

#include "math/quaternion.h"

namespace tress::simulation {
namespace {

// For any user input, including 1e200.
double size(const Vec& x) { return std::hypot(x.x, x.y, x.z); }

Vec reflected(const Vec& x, const Vec& normal) {
  const double square = dot(normal, normal);
  return square > 0 ? x - 2 * dot(normal, x) / square * normal : x;
}

}  // namespace

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

Frame carried(const Frame& frame, const Vec& step, const Vec& next) {
  const Vec e1 = across(
      next, reflected(reflected(frame.e1, step), next - reflected(frame.e0, step)));
  return frame_of(next, e1);
}

Vec rotation_between(const Frame& f, const Frame& g) {
  Quaternion q = quaternion_of({f.back(g.e0), f.back(g.e1), f.back(g.e2)});
  if (q.w < 0) q = -1.0 * q;
  const double sine = norm(q.v);
  return sine > 0 ? 2 * std::atan2(sine, q.w) / sine * q.v : Vec{};
}

}  // namespace tress::simulation
