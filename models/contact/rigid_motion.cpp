#include "models/contact/rigid_motion.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

constexpr int most_iterations = 30;  // two or three where the points moved rigidly
constexpr double flat = 1e-9;        // second singular value over the first
constexpr double done = 1e-14;

double square(const Frame& a) {
  return dot(a.e0, a.e0) + dot(a.e1, a.e1) + dot(a.e2, a.e2);
}

}  // namespace

RigidMotion rigid_motion(std::span<const Vec> before, std::span<const Vec> now) {
  Vec from, to;
  for (std::size_t i = 0; i < before.size(); ++i) {
    from = from + before[i];
    to = to + now[i];
  }
  const double share = 1 / std::max(1.0, static_cast<double>(before.size()));
  from = share * from;
  to = share * to;
  // Columns of sum (now - to)(before - from)^T.
  Frame h{{}, {}, {}};
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vec a = before[i] - from, b = now[i] - to;
    h = {h.e0 + a.x * b, h.e1 + a.y * b, h.e2 + a.z * b};
  }
  const double size = std::sqrt(square(h));
  if (!(size > 0)) return {};
  h = {(1 / size) * h.e0, (1 / size) * h.e1, (1 / size) * h.e2};
  // With H = U S V^T the matrix of cofactors is U cof(S) V^T: added, it leaves the polar
  // factor as it is and gives points in a plane their normal.
  const Frame normal{cross(h.e1, h.e2), cross(h.e2, h.e0), cross(h.e0, h.e1)};
  const double area = std::sqrt(square(normal));
  if (!(area > flat)) return {};
  h = {h.e0 + (1 / area) * normal.e0, h.e1 + (1 / area) * normal.e1,
       h.e2 + (1 / area) * normal.e2};
  for (int k = 0; k < most_iterations; ++k) {
    // The inverse's transpose has the cross products of columns over the determinant.
    const double by = 1 / dot(h.e0, cross(h.e1, h.e2));
    const Frame inverse{by * cross(h.e1, h.e2), by * cross(h.e2, h.e0),
                        by * cross(h.e0, h.e1)};
    // Scaled, so that it converges from far too.
    const double scale = std::pow(square(inverse) / square(h), 0.25);
    const auto mean = [&](const Vec& a, const Vec& b) {
      return (scale / 2) * a + (0.5 / scale) * b;
    };
    const Frame next{mean(h.e0, inverse.e0), mean(h.e1, inverse.e1),
                     mean(h.e2, inverse.e2)};
    const Frame change{next.e0 - h.e0, next.e1 - h.e1, next.e2 - h.e2};
    h = next;
    if (square(change) < done * done) break;
  }
  return is_rotation(h) ? RigidMotion{h, from, to} : RigidMotion{};
}

}  // namespace tress::models
