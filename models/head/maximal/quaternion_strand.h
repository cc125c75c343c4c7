#pragma once

#include <algorithm>
#include <type_traits>

#include "contract/basics.h"
#include "math/instructions.h"
#include "math/lane_choice.h"
#include "models/head/lane_energies.h"
#include "models/head/maximal/edge_loads.h"
#include "models/maximal/strained.h"
#include "models/quaternion_rods/quaternion_elimination.h"
#include "models/quaternion_rods/quaternion_joint.h"

namespace tress::models {

/// Data common to all edges of a strand, in consistent units.
template <class T, template <class> class EdgeOf>
struct QuaternionMaterial {
  T length;        // of an edge
  T mass;          // of an edge
  T drag;          // force on an edge per velocity
  T stretch;       // force per lengthening of an edge
  T rate;          // typical: speeds are of the order of `rate` lengths
  T inertia;       // of a quaternion
  EdgeOf<T> edge;  // strains of an edge, with coefficients

  /// Returns the mass of the node at the end of edge i of n over that of an edge.
  static T part(int i, int n) { return T(i + 1 < n ? 1 : 0.5); }
};

/// The joint before an edge.
template <class T>
struct QuaternionElement : QuaternionJointOf<T> {
  static constexpr std::size_t kept = 0;  // what steps change, of a lane
  /// Writes what steps change, of a lane.
  void keep(int /*lane*/, double* /*to*/) const {}
  /// Restores what keep() wrote.
  void recall(int /*lane*/, const double* /*from*/) {}
};

/// The frame of a strand at its root and its motion, in axes as those of the edges.
template <class T>
struct QuaternionClamp {
  QuaternionOf<T> frame;  // frame at the root
  Vec3<T> v, omega;       // velocity and angular velocity
};

/// Rods of models/quaternion_rods/quaternion_rod.h (clamped, edges of equal length) for
/// the strands in the lanes of T. Newton's step
///
///     correction = S(w)^-1 r(q, v, a)
///
/// takes O(edges), with the exact Jacobian. Coordinates: the vector along every edge, in
/// axes that do not turn, and its quaternion. Rates are the same, but those of the first
/// edge are those of its end.
template <class T, template <class> class EdgeOf>
class QuaternionStrand {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Data of an element that steps do not change.
  using Material = QuaternionMaterial<T, EdgeOf>;
  /// Data of an element that steps change.
  using Element = QuaternionElement<T>;
  /// Frame and motion of the root.
  using Clamp = QuaternionClamp<T>;
  /// Elimination of an element.
  using Elimination = QuaternionElimination<T>;
  /// Factors of an element.
  using Factor = typename Elimination::Factor;
  /// Load of effects on a point.
  using Load = typename EdgeLoads<T, true>::Load;
  static constexpr int per_element = Elimination::size;  // unknowns of an edge

  /// Elastic stresses of an edge and the joint before it.
  struct Stresses {
    /// Stresses of the strains.
    T edge[EdgeOf<T>::strains], joint[QuaternionJointOf<T>::strains];
  };

  /// Makes strands of this number of edges under gravity.
  QuaternionStrand(int edges, const Vec& gravity) : n_(edges), gravity_(gravity) {}

  /// correction = S^-1 r at (q, v, a), with the loads of effects on the ends of edges, or
  /// null. Terms of second order have these `stresses`, which are from then on those that
  /// the correction has found (StressForm). Returns the size of the correction: the
  /// largest of displacements of nodes over edges, of changes of quaternions, and of both
  /// rates over `rate`. `factors` (edges) then serve again(). `forces` (edges): scratch.
  TRESS_FLATTEN T newton(const Material& m, const Element* elements, const Clamp& clamp,
                         Weights w, const T* q, const T* v, const T* a, const Load* loads,
                         T* correction, Factor* factors, Vec* forces,
                         Stresses* stresses) const {
    return solve<true>(m, elements, clamp, w, q, v, a, loads, correction, factors, forces,
                       stresses);
  }
  /// Computes a correction with the matrix of the last newton() at another state.
  TRESS_FLATTEN T again(const Material& m, const Element* elements, const Clamp& clamp,
                        Weights w, const T* q, const T* v, const T* a, const Load* loads,
                        T* correction, Factor* factors, Vec* forces) const {
    return solve<false>(m, elements, clamp, w, q, v, a, loads, correction, factors,
                        forces, nullptr);
  }
  /// Writes the stresses of the edges and joints at q, in lanes with `which` > 0. The
  /// stress of the wall has no second-order terms.
  void take_stresses(const Material& m, const Element* elements, const T* q,
                     const T& which, Stresses* stresses) const {
    const auto take = [&](const auto& part, const T* x, T* to) {
      constexpr int strains = std::remove_cvref_t<decltype(part)>::strains;
      T value[strains];
      part.strain(x, value);
      for (int k = 0; k < strains; ++k) {
        to[k] = where_less(T(0), which, part.stiffness[k] * value[k], to[k]);
      }
    };
    for (int i = 0; i < n_; ++i) {
      take(m.edge, q + per_element * i, stresses[i].edge);
      if (i == 0) continue;
      T x[8];
      pair(q, i, x);
      take(elements[i], x, stresses[i].joint);
    }
  }

  /// Computes the energies at (q, v); `at`: position of the root seen from the head's
  /// position.
  LaneEnergies<T> energies(const Material& m, const Element* elements, const Clamp& clamp,
                           Vec at, const T* q, const T* v) const {
    const T end = T(0.5) * m.mass;
    LaneEnergies<T> sum{T(0.5) * end * dot(clamp.v, clamp.v), T(0), end * at,
                        dot(clamp.v, clamp.v), at};
    Vec node_v{};
    for (int i = 0; i < n_; ++i) {
      const T* const x = q + per_element * i;
      const T* const rate = v + per_element * i;
      node_v = node_v + load3(rate);
      at = at + load3(x);
      const T mass = m.part(i, n_) * m.mass;
      const QuaternionOf<T> turns = load_quaternion(rate + 3);
      sum.kinetic +=
          T(0.5) * (mass * dot(node_v, node_v) + m.inertia * dot(turns, turns));
      sum.first = sum.first + mass * at;
      sum.passes(node_v);
      T of_joint[8];
      if (i == 0) {
        store_quaternion(wall(clamp, q), of_joint);
        store_quaternion(load_quaternion(q + 3), of_joint + 4);
      } else {
        pair(q, i, of_joint);
      }
      sum.elastic += strain_energy(m.edge, x) +
                     strain_energy<QuaternionJointOf<T>>(elements[i], of_joint);
    }
    sum.tip = at;
    return sum;
  }

 private:
  template <bool with_tangent>
  T solve(const Material& m, const Element* elements, const Clamp& clamp, Weights w,
          const T* q, const T* v, const T* a, const Load* loads, T* correction,
          Factor* factors, Vec* forces, Stresses* stresses) const {
    Vec node_v{}, node_a{};
    for (int i = 0; i < n_; ++i) {
      node_v = node_v + load3(v + per_element * i);
      node_a = node_a + load3(a + per_element * i);
      forces[i] = m.part(i, n_) * (m.mass * (node_a - gravity_) + m.drag * node_v);
      if (loads != nullptr) [[unlikely]] {
        forces[i] =
            where_less(T(0), loads[i].some, forces[i] - loads[i].load.force, forces[i]);
      }
    }
    const T pos(w.pos), vel(w.vel);
    typename Elimination::Beyond beyond;
    typename Elimination::Right right;
    for (int i = n_ - 1; i >= 0; --i) {
      const T* const x = q + per_element * i;
      T rate[per_element], of_joint[8], joint_rate[8];
      std::copy_n(v + per_element * i, per_element, rate);
      if (i == 0) {
        store3(load3(v) - clamp.v, rate);
        const QuaternionOf<T> held = wall(clamp, q);
        store_quaternion(held, of_joint);
        store_quaternion(rate_of(held, clamp.omega), joint_rate);
        std::copy_n(q + 3, 4, of_joint + 4);
        std::copy_n(v + 3, 4, joint_rate + 4);
      } else {
        pair(q, i, of_joint);
        pair(v, i, joint_rate);
      }
      Strained<EdgeOf<T>> edge(m.edge, x, rate);
      Strained<QuaternionJointOf<T>> joint(elements[i], of_joint, joint_rate);
      if constexpr (with_tangent) {
        edge.take_stresses(stresses[i].edge);
        if (i > 0) joint.take_stresses(stresses[i].joint);
        typename Elimination::Own own;
        edge.tangent(pos, vel, own.edge);
        joint.tangent(pos, vel, own.joint);
        for (int k = 3; k < per_element; ++k) own.edge[k][k] += T(w.acc) * m.inertia;
        beyond.add_block(block(m, w, i, loads));
        Elimination::eliminate(own, i == 0, beyond, factors[i]);
      }
      T force[per_element] = {}, of_turn[8] = {};
      edge.add_force(force);
      joint.add_force(of_turn);
      for (int k = 3; k < per_element; ++k) {
        force[k] += m.inertia * a[per_element * i + k];
      }
      store3(load3(right.force) + forces[i], right.force);
      Elimination::reduce(force, of_turn, i == 0, factors[i], right);
    }
    return substitute<with_tangent>(m, elements, w, q, factors, correction, stresses);
  }

  /// Returns the diagonal block of the node at the end of edge i.
  Matrix3<T> block(const Material& m, Weights w, int i, const Load* loads) const {
    const T inertia = m.part(i, n_) * (T(w.acc) * m.mass + T(w.vel) * m.drag), o(0);
    const Matrix3<T> own{{{inertia, o, o}, {o, inertia, o}, {o, o, inertia}}};
    if (loads == nullptr) [[likely]]
      return own;
    const ExactLoad<T>& load = loads[i].load;
    return where_less(o, loads[i].some, own + T(w.pos) * load.by_x + T(w.vel) * load.by_u,
                      own);
  }

  template <bool with_tangent>
  T substitute(const Material& m, const Element* elements, Weights w, const T* q,
               const Factor* factors, T* correction, Stresses* stresses) const {
    T before[per_element] = {}, far(0), turned(0), finite(0);  // the last: 0 or NaN
    Vec node{};
    for (int i = 0; i < n_; ++i) {
      T* const y = correction + per_element * i;
      T own[per_element];
      Elimination::change(factors[i], i == 0, before, own);
      std::copy_n(own, per_element, y);
      node = node + load3(y);
      store3(node, before);
      std::copy_n(y + 3, 4, before + 3);
      far = larger(larger(far, magnitude(node.x)),
                   larger(magnitude(node.y), magnitude(node.z)));
      T all = node.x + node.y + node.z;
      for (int k = 3; k < per_element; ++k) {
        turned = larger(turned, magnitude(y[k]));
        all += y[k];
      }
      finite += all - all;
      if constexpr (with_tangent) {
        const T pos(w.pos);
        follow(m.edge, q + per_element * i, y, pos, stresses[i].edge);
        if (i == 0) continue;
        T x[8], change[8];
        pair(q, i, x);
        pair(correction, i, change);
        follow<QuaternionJointOf<T>>(elements[i], x, change, pos, stresses[i].joint);
      }
    }
    return larger(T(w.vel) / m.rate, T(w.pos)) * larger(far / m.length, turned) + finite;
  }

  /// Elastic stresses after a change of x by -pos `change`, to first order.
  template <class Part>
  static void follow(const Part& part, const T* x, const T* change, const T& pos,
                     T* stresses) {
    T value[Part::strains], gradient[Part::strains][Part::coordinates];
    part.strain(x, value);
    part.gradient(x, gradient);
    for (int k = 0; k < Part::strains; ++k) {
      T by(0);
      for (int l = 0; l < Part::coordinates; ++l) by += gradient[k][l] * change[l];
      stresses[k] = part.stiffness[k] * (value[k] - pos * by);
    }
  }

  /// The quaternion of the edge before edge i > 0 and its own.
  static void pair(const T* all, int i, T* to) {
    std::copy_n(all + per_element * (i - 1) + 3, 4, to);
    std::copy_n(all + per_element * i + 3, 4, to + 4);
  }
  /// The clamp's, on the side of the sphere on which the first edge's is.
  static QuaternionOf<T> wall(const Clamp& clamp, const T* q) {
    const T side = dot(load_quaternion(q + 3), clamp.frame);
    return where_less(side, T(0), T(-1), T(1)) * clamp.frame;
  }

  int n_;
  Vec gravity_;
};

}  // namespace tress::models
