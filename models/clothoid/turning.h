#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "math/quaternion.h"
#include "models/clothoid/collocation.h"

namespace tress::models {

/// Frames along an element whose Darboux vector is linear, seen from its start. With y in
/// [-1, 1] and pure quaternions a = l mean/4, b = l half/4, multiplied from the right,
///
///     dq/dy = q (a + y b),    q_{n+1} = (q_n a + q_{n-1} b)/(n + 1),   q(y) = sum q_n
///     y^n
///
/// about the middle, so that terms fall like (l |kappa|/4)^n/n!. Beyond about 4 rad the
/// element is split into equal parts; up to 1000 rad, and NaN beyond.
template <class Real>
class TurningOf {
 public:
  /// Quaternion of these scalars.
  using Quaternion = QuaternionOf<Real>;

  /// Prepares the series of an element.
  TurningOf(const LinearStrainOf<Real>& kappa, const Real& length)
      : a_((length / Real(4)) * kappa.mean), b_((length / Real(4)) * kappa.half) {
    const Real square = dot(a_, a_) + dot(b_, b_);
    const double size = std::sqrt(2 * largest(square));  // at least |a| + |b|
    // Also NaN gets one part.
    if (size > 1) parts_ = static_cast<int>(std::ceil(std::min(size, most_parts + 1.0)));
    if (parts_ > most_parts) {
      parts_ = 1;
      a_ = Vec3<Real>(Vec{std::nan(""), 0, 0});
    }
  }

  /// Calls put(b, frame) for the points of every block, and returns the tip's frame.
  template <class Put>
  FrameOf<Real> place(const Collocation<Real>& rule, Put put) {
    if (parts_ == 1) {
      const Quaternion start = series(a_, b_);
      const QuaternionOf<Pack> from{Pack(start.w), Vec3<Pack>(start.v)};
      for (int b = 0; b < rule.blocks(); ++b) put(b, axes(from * value(rule.place(b))));
      return axes(start * end());
    }
    std::array<QuaternionOf<Pack>, AlongOf<Real>::most_blocks> at;
    Quaternion start{Real(1), {}};
    for (int part = 0; part < parts_; ++part) {
      const double share = 1.0 / parts_, middle = (2 * part + 1) * share - 1;
      const Quaternion back =
          series(share * (a_ + Real(middle) * b_), Real(share * share) * b_);
      const Quaternion from = start * back;
      const QuaternionOf<Pack> wide{Pack(from.w), Vec3<Pack>(from.v)};
      for (int b = 0; b < rule.blocks(); ++b) {
        const Pack y = Pack(parts_) * (rule.place(b) - Pack(middle));
        pick(y, wide * value(y), at[static_cast<std::size_t>(b)]);
      }
      start = from * end();
    }
    for (int b = 0; b < rule.blocks(); ++b) put(b, axes(at[static_cast<std::size_t>(b)]));
    return axes(start);
  }

 private:
  static constexpr int most_parts = 256, most_terms = 40;
  static constexpr double negligible = 1e-17;

  static Quaternion times(const Quaternion& q, const Vec3<Real>& v) {
    return {-1.0 * dot(q.v, v), q.w * v + cross(q.v, v)};
  }

  /// Terms of the series; returns the conjugate of q(-1).
  Quaternion series(const Vec3<Real>& a, const Vec3<Real>& b) {
    term_[0] = {Real(1), {}};
    term_[1] = {Real(0), a};
    count_ = 2;
    double before = largest(dot(a, a));
    for (; count_ < most_terms; ++count_) {
      const auto n = static_cast<std::size_t>(count_);
      const Quaternion by_a = times(term_[n - 1], a), by_b = times(term_[n - 2], b);
      const Real over(1.0 / count_);
      term_[n] = {over * (by_a.w + by_b.w), over * (by_a.v + by_b.v)};
      const double now = largest(dot(term_[n], term_[n]));
      if (now <= negligible * negligible && before <= negligible * negligible) break;
      before = now;
    }
    Quaternion even{Real(0), {}}, odd{Real(0), {}};
    for (int n = count_ - 1; n >= 0; --n) {
      Quaternion& to = n % 2 == 0 ? even : odd;
      to = {to.w + term_[static_cast<std::size_t>(n)].w,
            to.v + term_[static_cast<std::size_t>(n)].v};
    }
    end_ = {even.w + odd.w, even.v + odd.v};
    return {even.w - odd.w, odd.v - even.v};
  }
  const Quaternion& end() const { return end_; }  // q(1)

  QuaternionOf<Pack> value(const Pack& y) const {
    QuaternionOf<Pack> q{Pack(0), {}};
    for (int n = count_ - 1; n >= 0; --n) {
      const Quaternion& term = term_[static_cast<std::size_t>(n)];
      q = {q.w * y + Pack(term.w), y * q.v + Vec3<Pack>(term.v)};
    }
    return q;
  }

  /// The lanes of `from` where y is in [-1, 1].
  static void pick(const Pack& y, const QuaternionOf<Pack>& from,
                   QuaternionOf<Pack>& to) {
    for (int lane = 0; lane < Pack::lanes; ++lane) {
      if (!(std::abs(y[lane]) <= 1)) continue;
      to.w.set(lane, from.w[lane]);
      to.v.x.set(lane, from.v.x[lane]);
      to.v.y.set(lane, from.v.y[lane]);
      to.v.z.set(lane, from.v.z[lane]);
    }
  }

  Vec3<Real> a_, b_;
  int parts_ = 1, count_ = 0;
  std::array<Quaternion, most_terms> term_;
  Quaternion end_;
};

}  // namespace tress::models
