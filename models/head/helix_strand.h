#pragma once

#include <array>

#include "contract/system.h"
#include "math/gauss_legendre.h"
#include "models/head/helix_element.h"
#include "models/head/point_loads.h"

namespace tress::models {

/// What the elements of a strand have in common, in consistent units.
template <class T>
struct HelixMaterial {
  T length;           // of an element
  T density;          // mass per length
  T drag;             // force per length and velocity: nu + c density (LinearDrag)
  Vec3<T> stiffness;  // moment per unknown: length (GJ, EI1, EI2)
  T friction;         // moment per rate of an unknown: length gamma
  T rotor;            // inertia of an element about its tangent: length rho (I1 + I2)
};

/// Motion of a clamped root in its own components; gravity g is a part of a.
template <class T>
struct HelixRoot {
  Vec3<T> v, omega;  // velocity, angular velocity
  Vec3<T> a, alpha;  // acceleration minus g, angular acceleration
};

/// Newton's step of a clamped super-helix of equal elements, with the stiff tangent:
///
///     delta = -S(w)^-1 r(q, v, a),   S = w.acc M + w.vel C + w.pos K
///
/// in three sweeps over the elements that keep all of an element in registers: motion
/// from the root to the tip, then residual wrenches and articulated inertias back to the
/// root [Featherstone 1983], then delta to the tip. The equations of ReducedSystem with
/// gravity and linear drag, and with the loads of other effects on points if a step is
/// given them, for as many strands as T has lanes. Lanes do not mix: a lane that is not
/// finite leaves the others as they are, and results are the same bits for any number of
/// lanes and whether or not others have loads.
///
/// Rounding: of I - H H_kk^-1 H^T the upper triangle is formed, as it stands; results
/// differ from ReducedSystem's by what a relative change of 1e-12 of the state makes
/// (tests/models/head/test_helix_head.cpp). Cost: O(elements points).
template <class T>
class HelixStrand {
 public:
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;

  /// Of an element, between sweeps.
  struct Scratch {
    Vec v, omega, a, alpha;        // of its start
    Vec position;                  // of its tip
    Matrix slope, turn, rotation;  // dP/dkappa, W, E at the tip
    Symmetric3<T> pivot;           // H_kk^-1
    Matrix of_force, of_moment;    // H_k(translation), H_k(rotation)
    Vec unknown;                   // right side of its unknowns
    Vec q;                         // where the step is linearised
  };

  /// `points`: Gauss-Legendre points of an element. `twist` false: the strand bends only,
  /// the first component of q is held.
  HelixStrand(int elements, int points, bool twist)
      : elements_(elements), points_(points), twist_(twist) {
    int i = 0;
    for (const QuadraturePoint& p : gauss_legendre(points, 1)) {
      at_[static_cast<std::size_t>(i)] = p.at;
      weight_[static_cast<std::size_t>(i)] = p.weight;
      ++i;
    }
  }
  static constexpr int most_points = 16;
  int elements() const { return elements_; }
  int points() const { return points_; }
  double at(int k) const { return at_[static_cast<std::size_t>(k)]; }  // of the length 1
  double weight(int k) const { return weight_[static_cast<std::size_t>(k)]; }

  /// One linear solve per step h (SemiImplicitStep) in two parts, between which loads of
  /// effects are found: motion at q + h v and v in `scratch`; then q and v (elements) are
  /// updated. The first returns what the second needs.
  struct Sum;
  [[gnu::flatten]] Sum move(const HelixMaterial<T>& m, const HelixRoot<T>& root, double h,
                            const Vec* q, const Vec* v, Scratch* scratch) const {
    const T step(h);
    for (int i = 0; i < elements_; ++i) scratch[i].q = q[i] + step * v[i];
    return forward(m, root, v, scratch);
  }
  /// `loads`: of an element null or its loads; null if there are none.
  [[gnu::flatten]] void semi_implicit_step(const HelixMaterial<T>& m, const Sum& end,
                                           const LoadSums<T>* const* loads,
                                           const Vec* rest, double h, Vec* q, Vec* v,
                                           Scratch* scratch) const {
    const T step(h);
    backward(m, rest, v, {1, h, h * h}, end, loads, scratch);
    solve(scratch, [&](int i, const Vec& a) {
      v[i] = v[i] + step * a;
      q[i] = q[i] + step * v[i];
    });
  }

  /// The wrench and the articulated inertia at a frame: force = ll a + la alpha, moment =
  /// la^T a + aa alpha.
  struct Sum {
    Vec force, moment;
    Symmetric3<T> ll, aa;
    Matrix la;
  };

 private:
  /// Returns the wrench on the last tip: that of its rotor.
  Sum forward(const HelixMaterial<T>& m, const HelixRoot<T>& root, const Vec* v,
              Scratch* scratch) const {
    Vec vel = root.v, omega = root.omega, a = root.a, alpha = root.alpha;
    for (int i = 0; i < elements_; ++i) {
      Scratch& e = scratch[i];
      e.v = vel;
      e.omega = omega;
      e.a = a;
      e.alpha = alpha;
      const HelixElement<T> element(e.q, v[i]);
      const LaneFunctions<T> functions(e.q, m.length);
      const HelixFunctions<T> f = functions.at(m.length);
      const auto turn = element.turn(m.length, f, functions.x2());
      e.position = element.position(m.length, f);
      e.slope = element.slope(f);
      e.turn = turn.turn;
      e.rotation = turn.rotation;
      const Vec arm = cross(omega, e.position), moved = e.slope * v[i];
      a = e.rotation.back(a + cross(alpha, e.position) + element.bias(f) +
                          cross(omega, arm + T(2) * moved));
      alpha = e.rotation.back(alpha + turn.bias + cross(omega, turn.velocity));
      vel = e.rotation.back(vel + arm + moved);
      omega = e.rotation.back(omega + turn.velocity);
    }
    Sum end{};
    end.moment = rotor_moment(T(0.5) * m.rotor, omega, alpha);
    return end;
  }

  /// I d/dt((omega . t) t), t the tangent.
  static Vec rotor_moment(const T& inertia, const Vec& w, const Vec& alpha) {
    return inertia * Vec{alpha.x, w.x * w.z, -(w.x * w.y)};
  }

  void backward(const HelixMaterial<T>& m, const Vec* rest, const Vec* v, Weights w,
                Sum hanging, const LoadSums<T>* const* loads, Scratch* scratch) const {
    const T inertia = T(w.acc) * m.density + T(w.vel) * m.drag;
    const Vec restoring =
        T(w.pos) * m.stiffness + (T(w.vel) * m.friction) * Vec{T(1), T(1), T(1)};
    T rotor = T(0.5) * m.rotor;
    for (int i = elements_ - 1; i >= 0; --i) {
      Scratch& e = scratch[i];
      hanging.aa.xx += T(w.acc) * rotor;
      hanging = over(m, restoring, inertia, rest[i], v[i], hanging,
                     loads != nullptr ? loads[i] : nullptr, e);
      rotor = m.rotor;  // halves of two elements
      hanging.moment = hanging.moment + rotor_moment(rotor, e.omega, e.alpha);
    }
  }

  /// From the tip of an element to its start.
  Sum over(const HelixMaterial<T>& m, const Vec& restoring, const T& inertia,
           const Vec& rest, const Vec& v, const Sum& hanging,
           const LoadSums<T>* of_effects, Scratch& e) const {
    const HelixElement<T> element(e.q, v);
    const LaneFunctions<T> functions(e.q, m.length);
    const AlongHelix<T> load =
        element.inertial(m.density, m.drag, e.v, e.omega, e.a, e.alpha);
    HelixSums<T> sums;
    for (int k = 0; k < points_; ++k) {
      const T arc = T(at_[static_cast<std::size_t>(k)]) * m.length,
              weight = T(weight_[static_cast<std::size_t>(k)]) * m.length;
      const HelixFunctions<T> f = functions.at(arc);
      sums.add(weight, arc, f);
      sums.add_force(weight * load.at(arc, f), arc, f);
    }
    const HelixMoments<T> points(element, e.q, sums);
    // What hangs on the tip, in the components of the start.
    const Symmetric3<T> ll = congruent(e.rotation, hanging.ll),
                        aa = congruent(e.rotation, hanging.aa);
    const Matrix la = e.rotation * hanging.la * e.rotation.transposed(),
                 al = la.transposed();
    const Vec tip_force = e.rotation * hanging.force,
              tip_moment = e.rotation * hanging.moment;
    // Wrench that the tip answers with when the start turns, or the unknowns change: the
    // tip then moves by -[P]x and by dP/dkappa, W.
    const Vec& tip = e.position;
    const Matrix f_turn = la - times_cross(full(ll), tip),
                 f_own = ll * e.slope + la * e.turn;
    const Matrix m_turn = full(aa) - times_cross(al, tip),
                 m_own = al * e.slope + aa * e.turn;
    const Vec p = inertia * points.first;
    const T mass = inertia * sums.one;
    Sum all{sums.force + tip_force,
            points.moment + tip_moment + cross(tip, tip_force),
            ll,
            {},
            {}};
    all.ll.xx += mass;
    all.ll.yy += mass;
    all.ll.zz += mass;
    all.la = f_turn - cross_matrix(p);
    const Symmetric3<T> pp = inertia * points.second;
    all.aa = upper(m_turn + cross_times(tip, f_turn)) - pp;
    const T trace = pp.xx + pp.yy + pp.zz;
    all.aa.xx += trace;
    all.aa.yy += trace;
    all.aa.zz += trace;
    // Columns of H_lk and H_ak by rows.
    e.of_force = f_own.transposed() + inertia * points.momentum;
    e.of_moment = (m_own + cross_times(tip, f_own)).transposed() + inertia * points.spin;
    Symmetric3<T> own = upper(e.slope.transposed(), f_own.transposed()) +
                        upper(e.turn.transposed(), m_own.transposed()) +
                        inertia * points.inner;
    own.xx += restoring.x;
    own.yy += restoring.y;
    own.zz += restoring.z;

    const Vec strain = e.q - rest;
    e.unknown = Vec{} - points.unknown - e.slope.back(tip_force) -
                e.turn.back(tip_moment) -
                Vec{m.stiffness.x * strain.x + m.friction * v.x,
                    m.stiffness.y * strain.y + m.friction * v.y,
                    m.stiffness.z * strain.z + m.friction * v.z};
    // One code with and without loads: the same bits for strands that have none.
    if (of_effects != nullptr) [[unlikely]] {
      add(*of_effects, all, own, e);
    }
    e.pivot = inverse(own);
    const Matrix z_l = e.pivot * e.of_force, z_a = e.pivot * e.of_moment;
    all.force = all.force + z_l.back(e.unknown);
    all.moment = all.moment + z_a.back(e.unknown);
    const Matrix by_force = e.of_force.transposed(), by_moment = e.of_moment.transposed();
    all.ll = all.ll - upper(by_force, z_l.transposed());
    all.la = all.la - by_force * z_a;
    all.aa = all.aa - upper(by_moment, z_a.transposed());
    return all;
  }

  /// The wrench is that of inertia less loads.
  static void add(const LoadSums<T>& of_effects, Sum& all, Symmetric3<T>& own,
                  Scratch& e) {
    of_effects.add_to(all.force, Vec{} - of_effects.force);
    of_effects.add_to(all.moment, Vec{} - of_effects.moment);
    of_effects.add_to(e.unknown, of_effects.unknown);
    of_effects.add_to(all.ll, of_effects.ll);
    of_effects.add_to(all.la, of_effects.la);
    of_effects.add_to(all.aa, of_effects.aa);
    of_effects.add_to(e.of_force, of_effects.of_force);
    of_effects.add_to(e.of_moment, of_effects.of_moment);
    of_effects.add_to(own, of_effects.inner);
  }

  /// Without twist, of the lower right block.
  Symmetric3<T> inverse(const Symmetric3<T>& h) const {
    const T first = h.yy * h.zz - h.yz * h.yz;
    const T o(0);
    if (!twist_) {
      const T by = T(1) / first;
      return {o, h.zz * by, h.yy * by, o, o, -h.yz * by};
    }
    const T second = h.xz * h.yz - h.xy * h.zz, third = h.xy * h.yz - h.xz * h.yy;
    const T by = T(1) / (h.xx * first + h.xy * second + h.xz * third);
    return {first * by,
            (h.xx * h.zz - h.xz * h.xz) * by,
            (h.xx * h.yy - h.xy * h.xy) * by,
            second * by,
            third * by,
            (h.xy * h.xz - h.xx * h.yz) * by};
  }

  /// From the root, which does not move, to the tip.
  template <class Use>
  void solve(const Scratch* scratch, Use use) const {
    Vec l, a;
    for (int i = 0; i < elements_; ++i) {
      const Scratch& e = scratch[i];
      const Vec own = e.pivot * (e.unknown - e.of_force * l - e.of_moment * a);
      use(i, own);
      l = e.rotation.back(l + cross(a, e.position) + e.slope * own);
      a = e.rotation.back(a + e.turn * own);
    }
  }

  int elements_, points_;
  bool twist_;
  std::array<double, most_points> at_{}, weight_{};
};

}  // namespace tress::models
