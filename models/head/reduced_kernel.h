#pragma once

#include <array>

#include "contract/basics.h"
#include "math/gauss_legendre.h"
#include "math/instructions.h"
#include "math/lane_choice.h"
#include "models/head/point_loads.h"

namespace tress::models {

/// Properties common to all elements of a strand, in consistent units.
template <class T>
struct ReducedMaterial {
  T length;           // of an element
  T density;          // mass per length
  T drag;             // force per length and velocity: nu + c density (LinearDrag)
  Vec3<T> stiffness;  // moment per unknown of an element
  T friction;         // moment per rate of an unknown
  T rotor;            // inertia of an element about its tangent: length rho (I1 + I2)
};

/// Motion of a frame in its own components, such as that of a clamped root; gravity g is
/// a part of a.
template <class T>
struct ReducedMotion {
  Vec3<T> v, omega;  // velocity, angular velocity
  Vec3<T> a, alpha;  // acceleration minus g, angular acceleration
};

/// The wrench and the articulated inertia at a frame: force = ll a + la alpha, moment =
/// la^T a + aa alpha.
template <class T>
struct ArticulatedSum {
  Vec3<T> force, moment;
  Symmetric3<T> ll, aa;
  Matrix3<T> la;
};

/// The motion of a point of an element seen from the element's start.
template <class T>
struct SeenPoint {
  Vec3<T> position, velocity;
};
/// Position, velocity and turn of an element's tip, seen from the element's start.
template <class T>
struct SeenTip {
  Vec3<T> position, velocity;
  Matrix3<T> rotation;  // from the components of the tip to those of the start
  Vec3<T> turning;      // angular velocity
};

inline constexpr int most_points_of_element = 16;

/// I d/dt((omega . t) t), t the tangent: what turns the rotor of an element.
template <class T>
Vec3<T> rotor_moment(const T& inertia, const Vec3<T>& w, const Vec3<T>& alpha) {
  return inertia * Vec3<T>{alpha.x, w.x * w.z, -(w.x * w.y)};
}

/// Newton's step of a clamped strand of equal elements of three unknowns each, with the
/// elastic Jacobian:
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
/// chain_strand.h). It has
///
///     Real                          // T
///     Kept                          // of an element, between sweeps: v, omega of its
///                                   // axes, position and rotation of its tip
///     move<accelerated>(material, q, rate, acceleration, motion, Kept)
///                                   // motion: of its start, replaced by its tip's;
///                                   // `acceleration` is read if so
///     last(material, motion, acc)   // the sum that hangs on the last tip
///     carry<accelerated>(kernel, material, Inertia, q, rate, acceleration, sum, loads,
///                        Kept, Uneliminated)
///                                   // sum: of its tip, to its axes and with its own
///     pass(material, acc, Kept, sum)          // once eliminated, to the tip before
///     eliminates                    // whether it has, in place of what all others do,
///     eliminate(Bending, twist, sum, Scratch) // the sum without its unknowns
///     follow(Scratch, twist, l, a)  // these; changes of acceleration from its axes to
///                                   // its tip
///     arrive(Kept, l, a)            // changes of acceleration: from the tip before to
///     leave(Kept, own, l, a)        // its axes, and to its tip
///     enter(Kept, frame)            // frames: from the tip before to its axes, and to
///     go_on(Kept, frame)            // its tip
///     Shape(q, rate, length)        // at(arc), tip(): seen from its start
///     Points(Kept, q, rate, length) // for models/head/reduced_loads.h
///     at_rest(strand, i, shape)     // the unknowns of element i in this shape
///     unit(length)                  // what multiplies unknowns where this is 1 m
///     moment(length)                // stiffness against an unknown over bending's
///     first_stiffness               // of the first element, over that of others
///     rotors_of_root, rotors_of_last          // shares of a rotor that turn with these
///     straight                      // whether elements are
///
/// Rounding: of I - H H_kk^-1 H^T the upper triangle is formed, without refinement.
/// Results differ from ReducedSystem's as by a relative change of the state of 1e-12, of
/// 3e-11 for chains (tests/models/head/test_reduced_head.cpp). Chains with soft joints
/// would lose all digits in that difference (ChainKind::eliminate()). Cost:
/// O(elements), of helices O(elements points).
template <class Kind>
class ReducedKernel {
 public:
  using T = typename Kind::Real;
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Material = ReducedMaterial<T>;
  using Motion = ReducedMotion<T>;
  using Sum = ArticulatedSum<T>;

  /// State of an element between sweeps.
  struct Scratch {
    typename Kind::Kept kept;
    Symmetric3<T> pivot;         // H_kk^-1
    Matrix of_force, of_moment;  // H_k(translation), H_k(rotation)
    Vec unknown;                 // right side of its unknowns
    Vec q;                       // where the step is linearised
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
  }
  int elements() const { return elements_; }
  int points() const { return points_; }
  bool twist() const { return twist_; }
  double at(int k) const { return at_[static_cast<std::size_t>(k)]; }  // of the length 1
  double weight(int k) const { return weight_[static_cast<std::size_t>(k)]; }

  /// Starts a step h of one linear solve (LinearlyImplicitStep). Writes the motion at
  /// q + h v and v to `scratch` and returns that of the tip. The caller then finds the
  /// loads of effects and calls linearly_implicit_step().
  TRESS_FLATTEN Motion move(const Material& m, const Motion& root, double h, const Vec* q,
                            const Vec* v, Scratch* scratch) const {
    const T step(h);
    for (int i = 0; i < elements_; ++i) scratch[i].q = q[i] + step * v[i];
    Motion at = root;
    for (int i = 0; i < elements_; ++i) {
      Kind::template move<false>(m, scratch[i].q, v[i], {}, at, scratch[i].kept);
    }
    return at;
  }
  /// Finishes the step: updates q and v (elements). `end`: result of move(). `loads`: for
  /// each element its loads or null; null without loads.
  TRESS_FLATTEN void linearly_implicit_step(const Material& m, const Motion& end,
                                            const LoadSums<T>* const* loads,
                                            const Vec* rest, double h, Vec* q, Vec* v,
                                            Scratch* scratch) const {
    const T step(h);
    backward(
        m, [&](int i) { return rest[i]; }, v, {1, h, h * h}, end, loads, scratch);
    solve(scratch, [&](int i, const Vec& a) {
      v[i] = v[i] + step * a;
      q[i] = q[i] + step * v[i];
    });
  }

  /// Computes the residual r at any state. `scratch` and `end`: results of Kind::move for
  /// the elements and the tip. `rest(i)`: unknowns of element i at rest.
  template <class Rest>
  TRESS_FLATTEN void residual(const Material& m, const Motion& end,
                              const LoadSums<T>* const* loads, Rest rest, const Vec* v,
                              const Vec* a, Vec* r, const Scratch* scratch) const {
    const Inertia none{T(0), T(0)};
    Sum hanging = Kind::last(m, end, none.acc);
    for (int i = elements_ - 1; i >= 0; --i) {
      Uneliminated all;
      carry<true>(m, none, {}, i, rest(i), v, a, hanging, loads, scratch[i], all);
      r[i] = Vec{} - all.unknown;
      // What hangs on the tip acts on the unknowns by its wrench alone.
      hanging = {all.sum.force, all.sum.moment, {}, {}, {}};
      Kind::pass(m, none.acc, scratch[i].kept, hanging);
    }
  }

  /// Elastic and viscous moments of an element, and the diagonal that they add to S.
  struct Bending {
    Vec moment, tangent;
  };
  static Bending bending(const Material& m, Weights w, int i, const Vec& q,
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

  /// Factors of the acceleration in S: of a unit of length, and of a rotor.
  struct Inertia {
    T of_length, acc;
  };
  /// Sums of an element with all that hangs on it, in its axes.
  struct Uneliminated {
    Sum sum;
    Symmetric3<T> own;           // H_kk
    Matrix of_force, of_moment;  // H_k(translation), H_k(rotation), rows k
    Vec unknown;                 // right side of its unknowns
  };

 private:
  template <class Rest>
  void backward(const Material& m, Rest rest, const Vec* v, Weights w, const Motion& end,
                const LoadSums<T>* const* loads, Scratch* scratch) const {
    const Inertia inertia{T(w.acc) * m.density + T(w.vel) * m.drag, T(w.acc)};
    Sum hanging = Kind::last(m, end, inertia.acc);
    for (int i = elements_ - 1; i >= 0; --i) {
      Scratch& e = scratch[i];
      Uneliminated all;
      carry<false>(m, inertia, w, i, rest(i), v, nullptr, hanging, loads, e, all);
      if constexpr (Kind::eliminates) {
        hanging =
            Kind::eliminate(bending(m, w, i, e.q, rest(i), v[i]), twist_, all.sum, e);
      } else {
        hanging = eliminate(all, e);
      }
      Kind::pass(m, inertia.acc, e.kept, hanging);
    }
  }
  /// `accelerated`: at accelerations a, else at none.
  template <bool accelerated>
  void carry(const Material& m, const Inertia& inertia, Weights w, int i, const Vec& rest,
             const Vec* v, const Vec* a, const Sum& hanging,
             const LoadSums<T>* const* loads, const Scratch& e, Uneliminated& all) const {
    Kind::template carry<accelerated>(*this, m, inertia, e.q, v[i],
                                      accelerated ? a[i] : Vec{}, hanging,
                                      loads != nullptr ? loads[i] : nullptr, e.kept, all);
    bend(m, w, i, rest, v[i], e, all);
  }

  static void bend(const Material& m, Weights w, int i, const Vec& rest, const Vec& v,
                   const Scratch& e, Uneliminated& all) {
    const Bending by = bending(m, w, i, e.q, rest, v);
    all.own.xx += by.tangent.x;
    all.own.yy += by.tangent.y;
    all.own.zz += by.tangent.z;
    all.unknown = all.unknown - by.moment;
  }

  Sum eliminate(const Uneliminated& from, Scratch& e) const {
    e.of_force = from.of_force;
    e.of_moment = from.of_moment;
    e.unknown = from.unknown;
    e.pivot = inverse(from.own);
    const Matrix z_l = e.pivot * e.of_force, z_a = e.pivot * e.of_moment;
    Sum all = from.sum;
    all.force = all.force + z_l.back(e.unknown);
    all.moment = all.moment + z_a.back(e.unknown);
    const Matrix by_force = e.of_force.transposed(), by_moment = e.of_moment.transposed();
    all.ll = all.ll - upper(by_force, z_l.transposed());
    all.la = all.la - by_force * z_a;
    all.aa = all.aa - upper(by_moment, z_a.transposed());
    return all;
  }

  /// Without twist, of the lower right block.
  Symmetric3<T> inverse(const Symmetric3<T>& h) const {
    if (twist_) return tress::inverse(h);
    const T o(0), by = T(1) / (h.yy * h.zz - h.yz * h.yz);
    return {o, h.zz * by, h.yy * by, o, o, -h.yz * by};
  }

  /// Finds the unknowns from the root, which does not move, to the tip.
  template <class Use>
  void solve(const Scratch* scratch, Use use) const {
    Vec l, a;
    for (int i = 0; i < elements_; ++i) {
      const Scratch& e = scratch[i];
      Kind::arrive(e.kept, l, a);
      if constexpr (Kind::eliminates) {
        use(i, Kind::follow(e, twist_, l, a));
      } else {
        const Vec own = e.pivot * (e.unknown - e.of_force * l - e.of_moment * a);
        use(i, own);
        Kind::leave(e.kept, own, l, a);
      }
    }
  }

  int elements_, points_;
  bool twist_;
  std::array<double, most_points_of_element> at_{}, weight_{};
};

}  // namespace tress::models
