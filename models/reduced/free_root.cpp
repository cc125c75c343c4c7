#include "models/reduced/free_root.h"

#include <cmath>

namespace tress::models {
namespace {

// Angle at which the rotation vector is reset to zero, well below 2 pi.
constexpr double largest_angle = 1.5;

Vec position(In q) { return {q[0], q[1], q[2]}; }
Vec rotation(In q) { return {q[3], q[4], q[5]}; }

}  // namespace

void FreeRootFrame::initial_state(Out q, Out v) const {
  store3(start_.position, &q[0]);
  store3(Vec{}, &q[3]);
  store3(start_.velocity, &v[0]);
  store3(start_.frame.back(start_.spin), &v[3]);  // at theta = 0, W = I
}

void FreeRootFrame::place(In q) {
  joint_ = Helix(rotation(q), 1);
  at_ = joint_.tip();
  frame_ = reference_ * joint_.rotation(at_);
}

FrameMotion FreeRootFrame::motion(In q, In v, In a) const {
  const Vec rate = rotation(v), second = rotation(a);
  // omega = W theta' in the reference's components; E^T W = W^T.
  const Vec alpha = joint_.W(second).at(at_) + joint_.dW(rate, rate).at(at_);
  return {frame_,
          position(q),
          frame_.back(position(v)),
          joint_.W_transposed(at_, rate),
          frame_.back(position(a)),
          joint_.rotation(at_).back(alpha)};
}

void FreeRootFrame::residual(const Vec& force, const Vec& moment, Out r) const {
  store3(frame_ * force, &r[0]);
  store3(joint_.W(moment).at(at_), &r[3]);
}

bool FreeRootFrame::rebase(InOut q, InOut v) {
  const Vec theta = rotation(q);
  if (dot(theta, theta) < largest_angle * largest_angle) return false;
  const Helix joint(theta, 1);
  const Helix::At<double> at = joint.tip();
  reference_ = reference_ * joint.rotation(at);
  // Columns lose orthogonality by a rounding error per reset: orthonormalise them again.
  Frame& f = reference_;
  f.e0 = (1 / std::sqrt(dot(f.e0, f.e0))) * f.e0;
  f.e1 = f.e1 - dot(f.e0, f.e1) * f.e0;
  f.e1 = (1 / std::sqrt(dot(f.e1, f.e1))) * f.e1;
  f.e2 = cross(f.e0, f.e1);
  store3(joint.W_transposed(at, rotation(v)), &v[3]);
  store3(Vec{}, &q[3]);
  return true;
}

}  // namespace tress::models
