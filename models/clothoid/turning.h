#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "math/quaternion.h"
#include "models/clothoid/collocation.h"
#include "models/clothoid/long_turning.h"

namespace tress::models {

/// Frames along an element whose Darboux vector is linear, seen from its start. With y in
/// [-1, 1] and pure quaternions a = l mean/4, b = l half/4, multiplied from the right,
///
///     dq/dy = q (a + y b),    q_{n+1} = (q_n a + q_{n-1} b)/(n + 1),   q(y) = sum q_n
///     y^n
///
/// about the middle, so that terms fall like (l |kappa|/4)^n/n!. Beyond about 4 rad the
/// element is split into equal parts; up to 1000 rad, and NaN beyond.
///
/// Where strands are in lanes, each lane has the terms that it needs alone and zeros
/// beyond them. Its bits therefore do not depend on its neighbours. Strands that wind by
/// more than 4 rad are computed one by one (models/clothoid/long_turning.h).
template <class Real>
class TurningOf {
  using Points = typename PointsOf<Real>::Type;
  static constexpr bool alone = PointsOf<Real>::in_lanes;

 public:
  /// Quaternion of these scalars.
  using Quaternion = QuaternionOf<Real>;

  /// Prepares the series of an element.
  TurningOf(const LinearStrainOf<Real>& kappa, const Real& length)
      : a_((length / Real(4)) * kappa.mean), b_((length / Real(4)) * kappa.half) {
    const Real square = dot(a_, a_) + dot(b_, b_);
    if constexpr (alone) {
      const double size = std::sqrt(2 * square);  // at least |a| + |b|
      // Also NaN gets one part.
      if (size > 1)
        parts_ = static_cast<int>(std::ceil(std::min(size, most_parts + 1.0)));
      if (parts_ > most_parts) {
        parts_ = 1;
        a_ = Vec3<Real>(Vec{std::nan(""), 0, 0});
      }
    } else {
      square_ = square;
    }
  }

  /// Calls put(b, frame) for the points of every block, and returns the tip's frame.
  /// Rule: blocks() and place(b), as those of Collocation.
  template <class Rule, class Put>
  FrameOf<Real> place(const Rule& rule, Put put) {
    if constexpr (!alone) {
      if (!all_up_to(square_, most_square)) [[unlikely]]
        return place_long(rule, put);
    }
    if (parts_ == 1) {
      const Quaternion start = series(a_, b_);
      const QuaternionOf<Points> from{Points(start.w), Vec3<Points>(start.v)};
      for (int b = 0; b < rule.blocks(); ++b) put(b, axes(from * value(rule.place(b))));
      return axes(start * end());
    }
    return place_parts(rule, put);
  }

 private:
  static constexpr int most_parts = 256, most_terms = 40;
  // Terms below it are rounding errors of a frame.
  static constexpr double negligible =
      sizeof(typename Points::Scalar) == sizeof(double) ? 1e-17 : 1e-9;
  // Largest |a|^2 + |b|^2 of one part.
  static constexpr double most_square = 0.5;

  template <class Rule, class Put>
  FrameOf<Real> place_parts(const Rule& rule, Put put) {
    if constexpr (alone) {
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
      for (int b = 0; b < rule.blocks(); ++b) {
        put(b, axes(at[static_cast<std::size_t>(b)]));
      }
      return axes(start);
    } else {
      return {};
    }
  }
  /// Computes frames as place() does, and replaces lanes that wind by more than one part,
  /// one by one.
  template <class Rule, class Put>
  FrameOf<Real> place_long(const Rule& rule, Put put) {
    LongTurning long_lanes[Real::lanes];
    std::array<double, PointsOf<Real>::most> y;
    for (int b = 0; b < rule.blocks(); ++b) {
      y[static_cast<std::size_t>(b)] = lane_of(rule.place(b), 0);
    }
    for (int lane = 0; lane < Real::lanes; ++lane) {
      if (square_[lane] <= most_square) continue;
      const Vec a = lane_of(a_, lane), b = lane_of(b_, lane);
      const double in[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
      turn_far(in, rule.blocks(), y.data(), long_lanes[lane]);
    }
    const auto replace = [&](std::size_t at, FrameOf<Real> frame) {
      for (int lane = 0; lane < Real::lanes; ++lane) {
        if (square_[lane] <= most_square) continue;
        const double* const from = &long_lanes[lane].frames[9 * at];
        set_lane(frame.e0, lane, load3(from));
        set_lane(frame.e1, lane, load3(from + 3));
        set_lane(frame.e2, lane, load3(from + 6));
      }
      return frame;
    };
    const Quaternion start = series(a_, b_);
    for (int b = 0; b < rule.blocks(); ++b) {
      put(b, replace(static_cast<std::size_t>(b), axes(start * value(rule.place(b)))));
    }
    return replace(static_cast<std::size_t>(rule.blocks()), axes(start * end()));
  }

  static Quaternion times(const Quaternion& q, const Vec3<Real>& v) {
    return {-1.0 * dot(q.v, v), q.w * v + cross(q.v, v)};
  }

  /// Terms of the series; returns the conjugate of q(-1). Terms of a lane whose last two
  /// were negligible are 0.
  Quaternion series(const Vec3<Real>& a, const Vec3<Real>& b) {
    term_[0] = {Real(1), {}};
    term_[1] = {Real(0), a};
    count_ = 2;
    const Real o(0), least(negligible * negligible);
    Real before = dot(a, a), left(1);  // 1 in lanes with more terms
    for (; count_ < most_terms; ++count_) {
      const auto n = static_cast<std::size_t>(count_);
      const Quaternion by_a = times(term_[n - 1], a), by_b = times(term_[n - 2], b);
      const Real over(1.0 / count_);
      Quaternion term{over * (by_a.w + by_b.w), over * (by_a.v + by_b.v)};
      const Real now = dot(term, term);
      if constexpr (alone) {
        if (now <= least && before <= least) break;
      } else {
        constexpr auto limit =
            static_cast<typename Real::Scalar>(negligible * negligible);
        left = where_up_to(larger(now, before), limit, o, left);
        if (!any_less(o, left)) break;
        term = {where_less(o, left, term.w, o),
                {where_less(o, left, term.v.x, o), where_less(o, left, term.v.y, o),
                 where_less(o, left, term.v.z, o)}};
      }
      term_[n] = term;
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

  QuaternionOf<Points> value(const Points& y) const {
    QuaternionOf<Points> q{Points(0), {}};
    for (int n = count_ - 1; n >= 0; --n) {
      const Quaternion& term = term_[static_cast<std::size_t>(n)];
      q = {q.w * y + Points(term.w), y * q.v + Vec3<Points>(term.v)};
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
  Real square_{};  // |a|^2 + |b|^2 of strands in lanes
  int parts_ = 1, count_ = 0;
  std::array<Quaternion, most_terms> term_;
  Quaternion end_;
};

}  // namespace tress::models
