#pragma once

#include <array>

#include "contract/layers.h"
#include "math/frame.h"
#include "models/clothoid/collocation.h"
#include "models/clothoid/turning.h"
#include "models/reduced/tree/shapes.h"

namespace tress::models {

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
/// rule, by blocks. T = double, or Pack for four elements. O(points^2) for each integral.
template <class T, int modes>
class ClothoidOf {
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
  /// Functions of arc length for each strain: constant and linear.
  static constexpr int functions = 2;

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
      if constexpr (std::same_as<P, Pack>) {
        return (*this)[p.block];
      } else {
        return this->tip;
      }
    }
  };
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
      : rule_(&rule), length_(length), t_(blocks()), n_(blocks()), b_(blocks()) {
    tip_ = TurningOf<T>(kappa, length)
               .place(rule, [this](int b, const FrameOf<Pack>& frame) {
                 t_.set(b, frame.e0);
                 n_.set(b, frame.e1);
                 b_.set(b, frame.e2);
               });
    position_ = integral(t_);
    for (int k = 0; k < dofs; ++k) {
      turn_[k] = integral(turned(unit(k)));
      slope_[k] = integral(product(turn_[k], t_));
    }
  }

  /// Returns the place of a block of points.
  At<Pack> point(int block) const { return {block}; }
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

  /// Returns P along the element.
  const Along& position() const { return position_; }
  /// Returns P'[x] along the element.
  Along first(const Strain& x) const { return combined(slope_, x); }
  /// Returns the derivative of P'[x1] along x2.
  Along second(const Strain& x1, const Strain& x2) const {
    const Along w1 = W(x1), w2 = W(x2), d = D(w2, x1);
    return integral([&](int b) {
      const Vec3<Pack> t = t_[b];
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
      const Vec3<Pack> t = t_[b], tw = cross(w[b], t), tx = cross(wx[b], t);
      return cross(dd[b], t) + cross(d[b], tx) + cross(dx[b], tw) +
             cross(w[b], cross(dx[b], t) + cross(w[b], tx));
    });
    return sum(this->second(second, x), third);
  }

  /// second(rate, e_k), acceleration_slope(rate, second, e_k) and second(e_k, e_l) of all
  /// unknowns: bilinear forms of the same integrals.
  void derivatives(const Strain& rate, const Strain& second, Directions& velocity,
                   Directions& acceleration,
                   std::array<Directions, dofs>& curvature) const {
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
          const Vec3<Pack> t = t_[b];
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
        const Vec3<Pack> t = t_[b], tw = cross(w[b], t), tx = cross(wx[b], t);
        return cross(dd[b], t) + cross(d_rate[b], tx) + cross(dx[b], tw) +
               cross(w[b], cross(dx[b], t) + cross(w[b], tx));
      });
      acceleration[k] = sum(combined(curvature[k], second), third);
    }
  }

  /// R y at a block of points.
  Vec3<Pack> rotated(const At<Pack>& p, const Vec3<double>& y) const {
    return Pack(y.x) * t_[p.block] + Pack(y.y) * n_[p.block] + Pack(y.z) * b_[p.block];
  }
  /// Returns the frame at the tip in the components of the start.
  const Frame& rotation(const At<T>&) const { return tip_; }
  /// (dW[x])^T y at the tip.
  Strain dW_transposed(const At<T>&, const Strain& x, const Vec& y) const {
    const Along w = W(x);
    Along back(blocks());
    for (int b = 0; b < blocks(); ++b) {
      const Vec3<Pack> u = cross(Vec3<Pack>(y), w[b]);
      back.set(b, {dot(t_[b], u), dot(n_[b], u), dot(b_[b], u)});
    }
    return {to_tip(back), rule_->moment(back, length_)};
  }

 private:
  int blocks() const { return rule_->blocks(); }
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
    for (int i = 0; i < 3 * sum.blocks; ++i) sum.entries[i] = Pack(0);
    for (int k = 0; k < dofs; ++k) {
      const T& factor = entry(x, k);
      if (factor == T(0)) continue;
      sum.tip = sum.tip + factor * all[k].tip;
      const Pack wide(factor);
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
      const Vec3<Pack> at = Vec3<Pack>(y.mean) + rule_->place(b) * Vec3<Pack>(y.half);
      return at.x * t_[b] + at.y * n_[b] + at.z * b_[b];
    });
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

  const Rule* rule_ = nullptr;
  T length_{};
  AlongOf<T> t_, n_, b_;  // the frames' axes
  Frame tip_;
  Along position_;
  Directions turn_, slope_;  // W e_k and P'[e_k]
};

}  // namespace tress::models
