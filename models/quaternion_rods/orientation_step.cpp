#include "models/quaternion_rods/orientation_step.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

Quaternion plus(const Quaternion& p, const Quaternion& q) {
  return {p.w + q.w, p.v + q.v};
}

Quaternion conjugate(const Quaternion& q) { return {q.w, -1.0 * q.v}; }

Quaternion of_norm_one(const Quaternion& q) { return (1 / std::sqrt(dot(q, q))) * q; }

/// m of the header by Newton's method on 1/sqrt of the left side, which is concave:
/// monotonous from m = |b+|.
double multiplier(double plus_square, double minus_square, double gap) {
  constexpr int most = 8;
  constexpr double rounding = 1e-15;
  double m = std::sqrt(plus_square);
  for (int k = 0; k < most; ++k) {
    const double far = m + gap;
    const double sum = plus_square / (m * m) + minus_square / (far * far);
    const double slope = plus_square / (m * m * m) + minus_square / (far * far * far);
    const double change = (std::sqrt(sum) - 1) * sum / slope;
    m += change;
    if (!(change > rounding * m)) break;
  }
  return m;
}

}  // namespace

void OrientationStep::add(const QuaternionJoint& joint, double h, const double* x,
                          const double* rate, Side side) {
  const Strained now(joint, x, rate);
  const std::size_t own = side == Side::behind ? 4 : 0;
  double slope[4] = {}, largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t l = 0; l < 4; ++l)
      slope[l] += now.stress[k] * now.gradient[k][own + l];
    largest = std::max(largest, joint.stiffness[k] + joint.friction[k] / h);
  }
  slope_ = plus(slope_, load_quaternion(slope));
  const Vec half = 0.5 * load3(joint.rest);
  const Quaternion rest{std::sqrt(std::max(0.0, 1 - dot(half, half))), half};
  const Quaternion aim = side == Side::behind ? load_quaternion(x) * rest
                                              : load_quaternion(x + 4) * conjugate(rest);
  hold_ += 4 * largest * std::max(0.0, dot(aim, now_));
  jointed_ = true;
}

Quaternion OrientationStep::taken() const {
  const Quaternion across = plus(slope_, -dot(slope_, now_) * now_);
  const Quaternion b = jointed_ ? plus(hold_ * now_, -1.0 * across) : now_;
  const double size = norm(pull_);
  double axes[3][4], turned[4];
  axis_gradient(b, axes);
  for (int l = 0; l < 4; ++l) {
    turned[l] = pull_.x * axes[0][l] + pull_.y * axes[1][l] + pull_.z * axes[2][l];
  }
  const double share = size > 0 ? 1 / (2 * size) : 0;
  const Quaternion other = share * load_quaternion(turned);
  const Quaternion with = 0.5 * plus(b, other), against = 0.5 * plus(b, -1.0 * other);
  const double square = dot(with, with);
  if (!(square > 0)) return now_;
  if (!jointed_) return of_norm_one(with);
  const double m = multiplier(square, dot(against, against), 4 * size);
  return of_norm_one(plus((1 / m) * with, (1 / (m + 4 * size)) * against));
}

}  // namespace tress::models
