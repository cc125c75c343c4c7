#pragma once

#include <array>
#include <concepts>
#include <span>
#include <type_traits>

#include "contract/weights.h"
#include "math/gauss_legendre.h"
#include "math/instructions.h"
#include "models/head/point_loads.h"
#include "models/head/reduced_parts.h"

namespace tress::models {

/// Rule of points that need nothing beyond their places and weights.
struct NoRule {};

/// Newton's step of a clamped strand of equal elements, of three unknowns each or of two
/// times three, with the elastic Jacobian:
///
///     delta = -S(w)^-1 r(q, v, a),   S = w.acc M + w.vel C + w.pos K
///
/// in three sweeps over the elements that keep all of an element in registers. The first
/// carries motion from the root to the tip. The second carries residual wrenches and
/// articulated inertias back to the root [Featherstone 1983]. The third finds delta from
/// the root to the tip. The equations are those of ReducedSystem with gravity, linear
/// drag and, where a step is given them, the loads of other effects on points.
///
/// Each lane of T holds one strand, and lanes do not mix. A lane that is not finite does
/// not change the others. Results are bit-identical for any number of lanes, and whether
/// or not other lanes have loads.
///
/// A Kind of element defines how its unknowns move it (models/head/helix_strand.h,
/// chain_strand.h, clothoid_strand.h). "Hanging" is all that follows an element. A Kind
/// has
///
///     Real                          // T
///     Unknowns                      // of an element: Vec3, or LinearStrainOf
///     Rule                          // what its points need beyond places and weights
///     Kept                          // of an element, between sweeps: v, omega of its
///                                   // axes, position and rotation of its tip
///     Sums, Joint                   // sums over its points; factors of its elimination
///     Loads, Inertia                // sums of loads of effects; what carry() fills
///     move<accelerated>(rule, material, q, rate, acceleration, motion, Kept)
///                                   // replaces the motion of its start by its tip's;
///                                   // `acceleration` is read if accelerated
///     add_up<accelerated>(kernel, material, q, rate, acceleration, Kept, Sums)
///
///     last_wrench(material, motion) // wrench on the last tip
///     bear(q, rate, Sums, loads, Kept, wrench, unknown)
///                                   // moves the hanging wrench from the tip to the
///                                   // element's axes and adds its own; right side of
///                                   // the unknowns in addition to that of the wrench
///     felt(Kept, wrench, unknown)   // whole right side of the unknowns
///     pass_wrench(material, Kept, wrench)     // to the tip before
///
///     last(material, acc)           // inertia on the last tip
///     carry(material, weights, q, rate, Sums, inertia, loads, Kept, Inertia)
///                                   // moves the hanging inertia likewise
///     eliminate(tangent, twist, Inertia, Scratch, Joint)
///                                   // inertia without the unknowns; adds `tangent` to
///                                   // their diagonal in S
///     pass(material, acc, Kept, inertia)      // to the tip before
///
///     lift(Kept, wrench, b)         // moves a wrench from the tip to the axes and
///                                   // subtracts from b what the unknowns feel
///     reduce(b, twist, Joint, Scratch, wrench)
///                                   // eliminates the unknowns from a wrench
///     set_back(Kept, wrench)        // to the tip before
///     follow(Scratch, twist, Joint, l, a)     // the unknowns; moves changes of
///                                   // acceleration from the tip before to its tip
///     enter(Kept, frame), go_on(Kept, frame)
///                                   // frame of the tip before to that of its axes, and
///                                   // on to its tip
///     Shape(rule, q, rate, length)  // at(PointPlace), tip(): seen from its start
///     Points(Kept, q, rate, length) // for models/head/reduced_loads.h
///     at_rest(strand, i, shape)     // unknowns of element i in this shape
///     unit(length)                  // unknowns in units of `length`, over those in m
///     moment(length)                // stiffness of an unknown, over bending stiffness
///     first_stiffness               // of the first element, over that of others
///     rotors_of_root, rotors_of_last          // shares of a rotor that turn with these
///     straight                      // whether elements are
///     cancels                       // whether eliminate() loses digits where an entry
///                                   // of a pivot exceeds the pivot's remainder
///
/// Rounding: of I - H H_kk^-1 H^T the upper triangle is formed without refinement.
/// Results differ from ReducedSystem's as by a relative change of the state of 1e-12, of
/// 3e-11 for chains (tests/models/head/test_reduced_head.cpp). Chains with soft joints
/// would lose all digits in that difference (ChainKind::eliminate). Cost: O(elements), of
/// helices O(elements points).
template <class Kind>
class ReducedKernel {
  using T = typename Kind::Real;
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Material = ReducedMaterial<T>;
  using Motion = ReducedMotion<T>;
  using Wrench = WrenchOf<T>;
  using Hanging = ArticulatedInertia<T>;
  using Inertia = ReducedInertia<T>;
  using Loads = typename Kind::Loads;

 public:
  using Unknowns = typename Kind::Unknowns;     // of an element
  using Rule = typename Kind::Rule;             // of its points
  using Uneliminated = typename Kind::Inertia;  // inertia that Kind::carry() fills

  /// Factors of an element of three unknowns.
  struct Eliminated {
    Symmetric3<T> pivot;         // H_kk^-1
    Matrix of_force, of_moment;  // H_k(translation), H_k(rotation)
    Vec unknown;                 // its unknowns, were the start to stay
  };
  /// Stands for the factors of an element of more unknowns, which its Kind stores.
  struct Nothing {};
  /// State of an element between sweeps.
  struct Scratch : std::conditional_t<std::same_as<Unknowns, Vec>, Eliminated, Nothing> {
    typename Kind::Kept kept;    // state that the Kind stores
    typename Kind::Joint joint;  // factors that the Kind stores
    Unknowns q;                  // its unknowns where the step is linearised
  };

  /// `points`: Gauss-Legendre points of an element. `twist` false: the strand bends only,
  /// the first component of q is held.
  ReducedKernel(int elements, int points, bool twist)
      : elements_(elements), points_(points), twist_(twist) {
    int i = 0;
    for (const QuadraturePoint& p : gauss_legendre(points, 1)) {
      at_[static_cast<std::size_t>(i)] = p.at;
      weight_[static_cast<std::size_t>(i)] = p.weight;
      ++i;
    }
    if constexpr (!std::same_as<Rule, NoRule>) {
      const auto count = static_cast<std::size_t>(points);
      rule_ = Rule(std::span(at_).first(count), std::span(weight_).first(count));
    }
  }
  /// Returns the rule of the points of an element.
  const Rule& rule() const { return rule_; }
  /// Returns the number of elements of a strand.
  int elements() const { return elements_; }
  /// Returns the number of quadrature points of an element.
  int points() const { return points_; }
  /// Returns whether elements twist; else the first component of q is held.
  bool twist() const { return twist_; }
  /// Returns the place of point k on elements of this length.
  PointPlace<T> place(int k, const T& length) const { return {k, T(at(k)) * length}; }
  /// Returns the place of point k on an element of length 1.
  double at(int k) const { return at_[static_cast<std::size_t>(k)]; }
  /// Returns the weight of point k of an element of length 1.
  double weight(int k) const { return weight_[static_cast<std::size_t>(k)]; }
  /// Returns the places of `lanes` points from k on, one per lane of P, or of one point
  /// in all lanes. Points beyond the last have no weight.
  template <class P, int lanes>
  P at(int k) const {
    return of_points<P, lanes>(at_, k);
  }
  /// Returns the weights of the points of at().
  template <class P, int lanes>
  P weight(int k) const {
    return of_points<P, lanes>(weight_, k);
  }

  /// Starts a step h of one linear solve (LinearlyImplicitStep). Writes the motion at
  /// q + h v and v to `scratch` and returns that of the tip. The caller then finds the
  /// loads of effects and calls linearly_implicit_step().
  TRESS_FLATTEN Motion move(const Material& m, const Motion& root, double h,
                            const Unknowns* q, const Unknowns* v,
                            Scratch* scratch) const {
    const T step(h);
    for (int i = 0; i < elements_; ++i) scratch[i].q = q[i] + step * v[i];
    Motion at = root;
    for (int i = 0; i < elements_; ++i) {
      Kind::template move<false>(rule_, m, scratch[i].q, v[i], {}, at, scratch[i].kept);
    }
    return at;
  }
  /// Finishes the step: updates q and v (elements). `end`: result of move(). `loads`: for
  /// each element its loads or null; null without loads.
  TRESS_FLATTEN void linearly_implicit_step(const Material& m, const Motion& end,
                                            const Loads* const* loads,
                                            const Unknowns* rest, double h, Unknowns* q,
                                            Unknowns* v, Scratch* scratch) const {
    const T step(h);
    backward(
        m, [&](int i) { return rest[i]; }, v, {1, h, h * h}, end, loads, scratch);
    solve(scratch, [&](int i, const Unknowns& a) {
      v[i] = v[i] + step * a;
      q[i] = q[i] + step * v[i];
    });
  }

  /// Computes the residual r at any state. `scratch` and `end`: results of Kind::move for
  /// the elements and the tip. `rest(i)`: unknowns of element i at rest.
  template <class Rest>
  TRESS_FLATTEN void residual(const Material& m, const Motion& end,
                              const Loads* const* loads, Rest rest, const Unknowns* v,
                              const Unknowns* a, Unknowns* r,
                              const Scratch* scratch) const {
    Wrench wrench = Kind::last_wrench(m, end);
    for (int i = elements_ - 1; i >= 0; --i) {
      const Scratch& e = scratch[i];
      const typename Kind::Sums sums = sums_of<true>(m, i, v, a, e);
      const Unknowns unknown = bear(i, v, sums, loads, e, wrench);
      r[i] = bending(m, {}, i, e.q, rest(i), v[i]).moment -
             Kind::felt(e.kept, wrench, unknown);
      Kind::pass_wrench(m, e.kept, wrench);
    }
  }

  /// Elastic and viscous moments of an element, and the diagonal that they add to S.
  struct Bending {
    Unknowns moment, tangent;  // moment on the unknowns, and diagonal in S
  };
  /// Returns the elastic and viscous moments of element i.
  static Bending bending(const Material& m, Weights w, int i, const Unknowns& q,
                         const Unknowns& rest, const Unknowns& v) {
    if constexpr (!std::same_as<Unknowns, Vec>) {
      const auto all = Kind::bending(m, w, q, rest, v);
      return {all.moment, all.tangent};
    } else {
      return bending_of_three(m, w, i, q, rest, v);
    }
  }

 private:
  static Bending bending_of_three(const Material& m, Weights w, int i, const Vec& q,
                                  const Vec& rest, const Vec& v) {
    Vec stiffness = m.stiffness;
    T friction = m.friction;
    if constexpr (Kind::first_stiffness != 1) {
      const T times(i == 0 ? Kind::first_stiffness : 1);
      stiffness = times * stiffness;
      friction = times * friction;
    }
    const T pos(w.pos), damping = T(w.vel) * friction;
    const Vec strain = q - rest;
    return {
        {stiffness.x * strain.x + friction * v.x, stiffness.y * strain.y + friction * v.y,
         stiffness.z * strain.z + friction * v.z},
        {pos * stiffness.x + damping, pos * stiffness.y + damping,
         pos * stiffness.z + damping}};
  }
  using OfPoints = std::array<double, most_points_of_element>;
  template <class P, int lanes>
  static P of_points(const OfPoints& all, int k) {
    const double* const from = &all[static_cast<std::size_t>(k)];
    if constexpr (lanes == 1) {
      return P(*from);
    } else {
      return P::load(from);
    }
  }

  template <class Rest>
  void backward(const Material& m, Rest rest, const Unknowns* v, Weights w,
                const Motion& end, const Loads* const* loads, Scratch* scratch) const {
    const Inertia inertia{T(w.acc) * m.density + T(w.vel) * m.drag, T(w.acc)};
    Wrench wrench = Kind::last_wrench(m, end);
    Hanging hanging = Kind::last(m, inertia.acc);
    for (int i = elements_ - 1; i >= 0; --i) {
      Scratch& e = scratch[i];
      const typename Kind::Sums sums = sums_of<false>(m, i, v, nullptr, e);
      const Unknowns unknown = bear(i, v, sums, loads, e, wrench);
      Uneliminated all;
      Kind::carry(m, inertia, e.q, v[i], sums, hanging, loads_of(loads, i), e.kept, all);
      const Bending by = bending(m, w, i, e.q, rest(i), v[i]);
      hanging = Kind::eliminate(by.tangent, twist_, all, e, e.joint);
      Kind::reduce(unknown - by.moment, twist_, e.joint, e, wrench);
      Kind::pass_wrench(m, e.kept, wrench);
      Kind::pass(m, inertia.acc, e.kept, hanging);
    }
  }
  /// `accelerated`: at accelerations a, else at none.
  template <bool accelerated>
  typename Kind::Sums sums_of(const Material& m, int i, const Unknowns* v,
                              const Unknowns* a, const Scratch& e) const {
    typename Kind::Sums sums;
    Kind::template add_up<accelerated>(*this, m, e.q, v[i],
                                       accelerated ? a[i] : Unknowns{}, e.kept, sums);
    return sums;
  }
  static const Loads* loads_of(const Loads* const* loads, int i) {
    return loads != nullptr ? loads[i] : nullptr;
  }
  static Unknowns bear(int i, const Unknowns* v, const typename Kind::Sums& sums,
                       const Loads* const* loads, const Scratch& e, Wrench& wrench) {
    Unknowns unknown;
    Kind::bear(e.q, v[i], sums, loads_of(loads, i), e.kept, wrench, unknown);
    return unknown;
  }

  /// Finds the unknowns from the root, which does not move, to the tip.
  template <class Use>
  void solve(const Scratch* scratch, Use use) const {
    Vec l, a;
    for (int i = 0; i < elements_; ++i) {
      const Scratch& e = scratch[i];
      use(i, Kind::follow(e, twist_, e.joint, l, a));
    }
  }

  int elements_, points_;
  bool twist_;
  OfPoints at_{}, weight_{};
  [[no_unique_address]] Rule rule_;
};

}  // namespace tress::models
