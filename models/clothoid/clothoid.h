#pragma once

#include <array>

#include "contract/layers.h"
#include "math/frame.h"
#include "models/clothoid/collocation.h"
#include "models/clothoid/turning.h"
#include "models/reduced/tree/shapes.h"

namespace tress::models {

/// Frames and positions along an element whose Darboux vector kappa is linear in arc
/// length (strain.h), and integrals over its points. T = double for one strand, whose
/// points lie in the lanes of a Pack, or a pack with one strand per lane. O(points^2) for
/// each integral.
template <class T>
class ClothoidCurveOf {
 public:
  /// Scalar: a number, or a pack of SIMD lanes.
  using Real = T;
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Frame of these scalars.
  using Frame = FrameOf<T>;
  /// Strain of an element.
  using Strain = LinearStrainOf<T>;
  /// Quadrature rule of the element.
  using Rule = Collocation<T>;
  /// Values at the points of a block.
  using Points = typename PointsOf<T>::Type;

  /// A block of points, or the tip: negative.
  template <class P>
  struct At {
    int block = -1;  // index of the block
  };

  /// Values along the element, with places as arguments.
  struct Along : AlongOf<T> {
    using AlongOf<T>::AlongOf;
    Along() = default;
    Along(const AlongOf<T>& values) : AlongOf<T>(values) {}  // NOLINT
    /// Returns the value at a place.
    template <class P>
    Vec3<P> at(const At<P>& p) const {
      if constexpr (std::same_as<P, T>) {
        if (p.block < 0) return this->tip;
      }
      if constexpr (std::same_as<P, Points>) {
        return (*this)[p.block];
      } else {
        return this->tip;
      }
    }
  };

  ClothoidCurveOf() = default;
  /// Integrates along an element of this Darboux vector and length, with the points of
  /// `rule`, which must outlive the curve.
  ClothoidCurveOf(const Strain& kappa, const T& length, const Rule& rule)
      : rule_(&rule), length_(length), t_(blocks()), n_(blocks()), b_(blocks()) {
    tip_ = TurningOf<T>(kappa, length)
               .place(rule, [this](int b, const FrameOf<Points>& frame) {
                 t_.set(b, frame.e0);
                 n_.set(b, frame.e1);
                 b_.set(b, frame.e2);
               });
    position_ = integral(t_);
  }

  /// Returns the rule of the points.
  const Rule& rule() const { return *rule_; }
  /// Returns P along the element.
  const Along& position() const { return position_; }
  /// Returns the tangents at a block of points.
  Vec3<Points> tangent(int block) const { return t_[block]; }
  /// Returns the frame at the tip in the components of the start.
  const Frame& rotation(const At<T>&) const { return tip_; }

  /// Returns W y along the element.
  Along turn(const Strain& y) const { return integral(turned(y)); }
  /// Returns P'[x] along the element, W x given.
  Along moved(const Along& wx) const { return integral(product(wx, t_)); }

 protected:
  int blocks() const { return rule_->blocks(); }

  /// The values at the points that `of` gives; nothing at the tip.
  template <class Of>
  Along values(Of of) const {
    Along all(blocks());
    for (int b = 0; b < all.blocks; ++b) all.set(b, of(b));
    return all;
  }
  Along integral(const Along& f) const { return rule_->integral(f, length_); }
  template <class Of>
  requires std::invocable<Of, int> Along integral(Of of)
  const { return integral(values(of)); }
  Vec to_tip(const Along& f) const { return rule_->to_tip(f, length_); }

  Along product(const Along& x, const Along& y) const {
    return values([&](int b) { return cross(x[b], y[b]); });
  }
  /// Computes R y along the element.
  Along turned(const Strain& y) const {
    return values([&](int b) {
      const Vec3<Points> at =
          Vec3<Points>(y.mean) + rule_->place(b) * Vec3<Points>(y.half);
      return at.x * t_[b] + at.y * n_[b] + at.z * b_[b];
    });
  }

  const Rule* rule_ = nullptr;
  T length_{};
  AlongOf<T> t_, n_, b_;  // the frames' axes
  Frame tip_;
  Along position_;
};

/// Kinematics of an element whose Darboux vector kappa is linear in arc length (strain.h)
/// [Casati, Bertails-Descoubes 2013]. R(s) is the frame at s in the components of the
/// frame at the start. A variation x of kappa turns the frame at s by W x, in the same
/// components, and
///
///     W x = int R x,   dR[x] = (W x) x R,   t = R e0,   P = int t,   P'[x] = int (W x) x
///     t
///
/// Integrals, also those of higher derivatives, are by collocation on the element's
/// points. D(x, y) = int (W x) x R y is the derivative of W y along x. The derivative of
/// P'[x1] along x2 is int D(x2, x1) x t + (W x1) x ((W x2) x t). Frames are by series
/// (turning.h). The interface is that of HelixOf, except that points are those of the
/// rule, by blocks. T = double for one strand, whose points lie in the lanes of a Pack,
/// or a pack with one strand per lane. O(points^2) for each integral.
template <class T, int modes>
class ClothoidOf : public ClothoidCurveOf<T> {
  using Curve = ClothoidCurveOf<T>;

 public:
  using typename Curve::Along;
  using typename Curve::Frame;
  using typename Curve::Points;
  using typename Curve::Rule;
  using typename Curve::Strain;
  using typename Curve::Vec;
  /// A block of points, or the tip.
  template <class P>
  using At = typename Curve::template At<P>;
  /// Functions of arc length for each strain: constant and linear.
  static constexpr int functions = 2;

  /// Value at the tip only.
  struct AtTip {
    Vec value;  // value at the tip
    /// Returns the value.
    const Vec& at(const At<T>&) const { return value; }
  };

  static constexpr int dofs = functions * modes;  // number of unknowns
  /// Values for each unknown.
  using Directions = std::array<Along, dofs>;

  ClothoidOf() = default;
  /// Integrates along an element of this Darboux vector and length, with the points of
  /// `rule`.
  ClothoidOf(const Strain& kappa, const T& length, const Rule& rule)
      : Curve(kappa, length, rule) {
    for (int k = 0; k < dofs; ++k) {
      turn_[k] = Curve::turn(unit(k));
      slope_[k] = Curve::moved(turn_[k]);
    }
  }

  /// Returns the place of a block of points.
  At<Points> point(int block) const { return {block}; }
  /// Returns the place of the tip.
  At<T> tip() const { return {}; }

  /// Returns W y along the element.
  Along W(const Strain& y) const { return combined(turn_, y); }
  /// Returns the derivative of W y along x, at the tip.
  AtTip dW(const Strain& x, const Strain& y) const {
    return {to_tip(product(W(x), turned(y)))};
  }
  /// Returns the second derivative of W y along x1 and x2, at the tip.
  AtTip d2W(const Strain& x1, const Strain& x2, const Strain& y) const {
    return {to_tip(turning_slope(x1, x2, y))};
  }

  /// W e_k and P'[e_k] of unknown k.
  const Along& turn_of(int k) const { return turn_[at(k)]; }
  /// Returns P'[e_k] of unknown k.
  const Along& slope_of(int k) const { return slope_[at(k)]; }

  /// Returns P'[x] along the element.
  Along first(const Strain& x) const { return combined(slope_, x); }
  /// Returns the derivative of P'[x1] along x2.
  Along second(const Strain& x1, const Strain& x2) const {
    const Along w1 = W(x1), w2 = W(x2), d = D(w2, x1);
    return integral([&](int b) {
      const Vec3<Points> t = t_[b];
      return cross(d[b], t) + cross(w1[b], cross(w2[b], t));
    });
  }
  /// P'' for kappa' = rate and kappa'' = second.
  Along acceleration(const Strain& rate, const Strain& second) const {
    return sum(first(second), this->second(rate, rate));
  }
  /// Computes the derivative of acceleration() along x. The one of second(rate, rate)
  /// needs that of D(rate, rate).
  Along acceleration_slope(const Strain& rate, const Strain& second,
                           const Strain& x) const {
    const Along w = W(rate), wx = W(x), d = D(w, rate), dx = D(wx, rate);
    const Along dd = integral(turning_slope(rate, x, rate));
    const Along third = integral([&](int b) {
      const Vec3<Points> t = t_[b], tw = cross(w[b], t), tx = cross(wx[b], t);
      return cross(dd[b], t) + cross(d[b], tx) + cross(dx[b], tw) +
             cross(w[b], cross(dx[b], t) + cross(w[b], tx));
    });
    return sum(this->second(second, x), third);
  }

  /// Derivatives of the tip's angular velocity and of its rate, for each unknown.
  struct TipTurns {
    std::array<Vec, dofs> turned, by_rate;  // dW(e_k, rate), dW(rate, e_k)
    std::array<Vec, dofs> spinning;         // dW(e_k, second) + d2W(e_k, rate, rate)
  };
  /// second(rate, e_k), acceleration_slope(rate, second, e_k) and second(e_k, e_l) of all
  /// unknowns: bilinear forms of the same integrals. `tips`: those of the tip, or null.
  void derivatives(const Strain& rate, const Strain& second, Directions& velocity,
                   Directions& acceleration, std::array<Directions, dofs>& curvature,
                   TipTurns* tips = nullptr) const {
    std::array<Directions, dofs> d;  // D(W e_k, e_l), the derivative of W e_l along e_k
    for (std::size_t k = 0; k < dofs; ++k) {
      for (std::size_t l = k; l < dofs; ++l) {
        const Strain e = unit(static_cast<int>(l));
        d[k][l] = D(turn_[k], e);
        if (l == k) continue;
        // As (W x x W y)' = W x x R y - W y x R x.
        d[l][k] = d[k][l];
        d[l][k].tip = d[l][k].tip - cross(turn_[k].tip, turn_[l].tip);
        for (int b = 0; b < blocks(); ++b) {
          d[l][k].set(b, d[l][k][b] - cross(turn_[k][b], turn_[l][b]));
        }
      }
      for (std::size_t l = 0; l <= k; ++l) {
        curvature[k][l] = curvature[l][k] = integral([&](int b) {
          const Vec3<Points> t = t_[b];
          return cross(d[k][l][b], t) + cross(turn_[l][b], cross(turn_[k][b], t));
        });
      }
    }
    const Along w = W(rate);
    Directions turned_rate;  // D(W e_k, rate)
    for (std::size_t k = 0; k < dofs; ++k) turned_rate[k] = combined(d[k], rate);
    const Along d_rate = combined(turned_rate, rate), r_rate = turned(rate);
    for (std::size_t k = 0; k < dofs; ++k) {
      velocity[k] = combined(curvature[k], rate);
      const Along &wx = turn_[k], &dx = turned_rate[k];
      const Along dd = integral([&](int b) {
        return cross(dx[b], r_rate[b]) + cross(w[b], cross(wx[b], r_rate[b]));
      });
      const Along third = integral([&](int b) {
        const Vec3<Points> t = t_[b], tw = cross(w[b], t), tx = cross(wx[b], t);
        return cross(dd[b], t) + cross(d_rate[b], tx) + cross(dx[b], tw) +
               cross(w[b], cross(dx[b], t) + cross(w[b], tx));
      });
      acceleration[k] = sum(combined(curvature[k], second), third);
      if (tips == nullptr) continue;
      tips->turned[k] = dx.tip;
      tips->spinning[k] = dd.tip;
      tips->by_rate[k] = Vec{};
      for (std::size_t l = 0; l < dofs; ++l) {
        const int unknown = static_cast<int>(l);
        tips->spinning[k] = tips->spinning[k] + entry(second, unknown) * d[k][l].tip;
        tips->by_rate[k] = tips->by_rate[k] + entry(rate, unknown) * d[l][k].tip;
      }
    }
  }

  /// R y at a block of points.
  Vec3<Points> rotated(const At<Points>& p, const Vec3<double>& y) const {
    return Points(y.x) * t_[p.block] + Points(y.y) * n_[p.block] +
           Points(y.z) * b_[p.block];
  }
  /// (dW[x])^T y at the tip.
  Strain dW_transposed(const At<T>&, const Strain& x, const Vec& y) const {
    return turn_back(W(x), y);
  }
  /// Returns (dW[e_k])^T y at the tip.
  Strain turn_back(int k, const Vec& y) const { return turn_back(turn_[at(k)], y); }

 private:
  Strain turn_back(const Along& w, const Vec& y) const {
    Along back(blocks());
    for (int b = 0; b < blocks(); ++b) {
      const Vec3<Points> u = cross(Vec3<Points>(y), w[b]);
      back.set(b, {dot(t_[b], u), dot(n_[b], u), dot(b_[b], u)});
    }
    return {to_tip(back), rule_->moment(back, length_)};
  }

  using Curve::blocks, Curve::integral, Curve::product, Curve::to_tip, Curve::turned,
      Curve::values;
  using Curve::rule_, Curve::length_, Curve::t_, Curve::n_, Curve::b_;

  static constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }
  static constexpr int component(int k) { return Space<modes>::component(k % modes); }
  static Strain unit(int k) {
    const Vec axis(Space<modes>::axis(component(k)));
    return k < modes ? Strain{axis, {}} : Strain{{}, axis};
  }
  static const T& entry(const Strain& x, int k) {
    const Vec& of = k < modes ? x.mean : x.half;
    const int c = component(k);
    return c == 0 ? of.x : c == 1 ? of.y : of.z;
  }

  static Along combined(const Directions& all, const Strain& x) {
    Along sum(all[0].blocks);
    for (int i = 0; i < 3 * sum.blocks; ++i) sum.entries[i] = Points(0);
    for (int k = 0; k < dofs; ++k) {
      const T& factor = entry(x, k);
      if (factor == T(0)) continue;
      sum.tip = sum.tip + factor * all[k].tip;
      const Points wide(factor);
      for (int i = 0; i < 3 * sum.blocks; ++i) sum.entries[i] += wide * all[k].entries[i];
    }
    return sum;
  }
  static Along sum(const Along& x, const Along& y) {
    Along all(x.blocks);
    all.tip = x.tip + y.tip;
    for (int i = 0; i < 3 * x.blocks; ++i) all.entries[i] = x.entries[i] + y.entries[i];
    return all;
  }

  /// The derivative of W y along x, W x given.
  Along D(const Along& wx, const Strain& y) const {
    return integral(product(wx, turned(y)));
  }
  /// Computes the integrand of the derivative of W y along x1 and x2.
  Along turning_slope(const Strain& x1, const Strain& x2, const Strain& y) const {
    const Along w1 = W(x1), w2 = W(x2), d = D(w2, x1), ry = turned(y);
    return values(
        [&](int b) { return cross(d[b], ry[b]) + cross(w1[b], cross(w2[b], ry[b])); });
  }

  Directions turn_, slope_;  // W e_k and P'[e_k]
};

}  // namespace tress::models
