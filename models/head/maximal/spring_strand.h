#pragma once

#include <type_traits>

#include "contract/basics.h"
#include "math/frame.h"
#include "math/instructions.h"
#include "math/lane_math.h"
#include "math/lanes.h"
#include "models/head/lane_energies.h"
#include "models/head/lane_root.h"
#include "models/head/maximal/edge_loads.h"
#include "models/maximal/kernel/spring_forces.h"

namespace tress::models {

/// Data common to all edges of a strand, in consistent units.
template <class T>
struct SpringMaterial {
  T length;    // of an edge
  T mass;      // of an edge
  T drag;      // force on an edge per velocity
  T stretch;   // force per lengthening of an edge
  T bending;   // moment per strain of a joint; the wall's has twice that
  T friction;  // moment per rate of strain, likewise
  T rate;      // typical: speeds are of the order of `rate` lengths

  /// Returns the inertia of the node at the end of edge i of n.
  T inertia_of_node(Weights w, int i, int n) const {
    const T part(i + 1 < n ? 1 : 0.5);
    return part * (T(w.acc) * mass + T(w.vel) * drag);
  }
};

/// Strain at rest of the joint before an edge; of the wall, about its axes e1 and e2.
template <class T>
struct SpringEdge {
  T rest, about_e2;  // rest values

  static constexpr std::size_t kept = 0;  // what steps change, of a lane
  /// Writes what steps change, of a lane.
  void keep(int /*lane*/, double* /*to*/) const {}
  /// Restores what keep() wrote.
  void recall(int /*lane*/, const double* /*from*/) {}
};

/// Point masses and springs of models/maximal/mass_spring.cpp (clamped, edges of equal
/// length, bending = angular, torsion = none) for the strands in the lanes of T. Newton's
/// step
///
///     correction = S(w)^-1 r(q, v, a)
///
/// takes O(edges), with jacobian = filtered or, if it is `exact`, the exact one.
/// Coordinates: the vector along every edge, in axes that do not turn. Rates are the
/// same, but those of the first edge are those of its end.
///
/// A change of an edge is a lengthening and a turn, y = (along t, m1, m2). Springs act on
/// edges, masses on nodes x.
template <class T, bool exact>
class SpringStrand {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;

  static constexpr int per_element = 3;  // unknowns of an edge

  /// Elimination by the kind of Jacobian.
  using Elimination =
      std::conditional_t<exact, SpringExactElimination<T>, SpringStiffElimination<T>>;
  /// An edge with the residual of its node.
  struct Placed : Elimination::Placed {
    Vec force;  // residual of the node at its end, springs left out
  };
  /// Factors of an element.
  using Factor = typename Elimination::Factor;
  /// Load of bodies by the kind of Jacobian.
  using Load = typename EdgeLoads<T, exact>::Load;
  /// Forces of edges and joints.
  using Forces = SpringForces<T, exact>;

  /// Makes strands of this number of edges under gravity.
  SpringStrand(int edges, const Vec& gravity) : n_(edges), gravity_(gravity) {}

  /// correction = S^-1 r at (q, v, a), with the loads of effects on the ends of edges, or
  /// null. Returns 0, NaN in lanes where it is not finite.
  TRESS_FLATTEN T newton(const SpringMaterial<T>& m, const SpringEdge<T>* edges,
                         const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                         const T* a, const Load* loads, T* correction, Placed* placed,
                         Factor* factors) const requires(!exact) {
    place<true>(m, edges, clamp, w, q, v, a, loads, placed);
    typename Elimination::Beyond beyond;
    typename Elimination::Right right;
    for (int i = n_ - 1; i >= 0; --i) {
      beyond.add_inertia(m.inertia_of_node(w, i, n_));
      if (loads != nullptr) [[unlikely]] {
        beyond.of_x = where_less(T(0), loads[i].some, beyond.of_x + loads[i].load.block,
                                 beyond.of_x);
      }
      Elimination::eliminate(placed[i], i == 0, beyond, factors[i], AnyPivots{});
      Elimination::reduce(placed[i], i == 0, factors[i], placed[i].force, placed[i].own,
                          right);
    }
    return substitute(m, w, placed, factors, correction);
  }
  /// Computes a correction with the exact Jacobian, in which edges resist turns by these
  /// `tensions`. The correction replaces them by the tensions that it found (StressForm).
  /// Returns the size of the correction: the largest of displacements of nodes over edges
  /// and of their speeds over rate times edges. `placed` and `factors` (edges) then serve
  /// again().
  TRESS_FLATTEN T newton(const SpringMaterial<T>& m, const SpringEdge<T>* edges,
                         const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                         const T* a, const Load* loads, T* correction, Placed* placed,
                         Factor* factors, T* tensions) const requires(exact) {
    place<true>(m, edges, clamp, w, q, v, a, loads, placed);
    const T pos(w.pos), vel(w.vel), along = pos * m.stretch;
    typename Elimination::Beyond beyond;
    typename Elimination::Right right;
    for (int i = n_ - 1; i >= 0; --i) {
      beyond.add_inertia(m.inertia_of_node(w, i, n_));
      if (loads != nullptr) [[unlikely]] {
        const ExactLoad<T>& load = loads[i].load;
        beyond.of_x =
            where_less(T(0), loads[i].some,
                       beyond.of_x + pos * load.by_x + vel * load.by_u, beyond.of_x);
      }
      Elimination::eliminate(placed[i], i == 0, pos, along, tensions[i], beyond,
                             factors[i], AnyPivots{});
      Elimination::reduce(placed[i], i == 0, factors[i], placed[i].force, placed[i].own,
                          right);
    }
    const T size = substitute(m, w, placed, factors, correction);
    for (int i = 0; i < n_; ++i) {
      const Placed& e = placed[i];
      tensions[i] = e.own.x - along * dot(e.frame.e0, load3(correction + 3 * i));
    }
    return size;
  }
  /// Computes a correction with the matrix of the last newton() at another state. `now`
  /// (edges): scratch.
  TRESS_FLATTEN T again(const SpringMaterial<T>& m, const SpringEdge<T>* edges,
                        const LaneClamp<T>& clamp, Weights w, const T* q, const T* v,
                        const T* a, const Load* loads, T* correction,
                        const Placed* placed, Factor* factors, Placed* now) const
      requires(exact) {
    place<false>(m, edges, clamp, w, q, v, a, loads, now);
    typename Elimination::Right right;
    for (int i = n_ - 1; i >= 0; --i) {
      Elimination::reduce(placed[i], i == 0, factors[i], now[i].force,
                          placed[i].frame.back(now[i].frame * now[i].own), right);
    }
    return substitute(m, w, placed, factors, correction);
  }
  /// Computes the energies at (q, v); `at`: position of the root seen from the head's
  /// position.
  TRESS_FLATTEN LaneEnergies<T> energies(const SpringMaterial<T>& m,
                                         const SpringEdge<T>* edges,
                                         const LaneClamp<T>& clamp, Vec at, const T* q,
                                         const T* v) const {
    const auto moves = [&](const T& mass, const Vec& u) {
      return T(0.5) * mass * dot(u, u);
    };
    const T end = T(0.5) * m.mass;
    LaneEnergies<T> sum{moves(end, clamp.v), T(0), end * at, dot(clamp.v, clamp.v), at};
    Vec node_v{}, before = clamp.frame.e0;
    for (int i = 0; i < n_; ++i) {
      const Vec edge = load3(q + 3 * i);
      node_v = node_v + load3(v + 3 * i);
      at = at + edge;
      const Vec t = inverse_sqrt(dot(edge, edge)) * edge;
      const T mass = i + 1 < n_ ? m.mass : end;
      sum.kinetic += moves(mass, node_v);
      sum.first = sum.first + mass * at;
      sum.passes(node_v);
      const T longer = dot(edge, t) - m.length;
      sum.elastic += T(0.5) * m.stretch * longer * longer;
      const Vec kb = SpringBinormal<T>(before, t).value;
      if (i == 0) {
        const T one = dot(clamp.frame.e1, kb) - edges[0].rest,
                two = dot(clamp.frame.e2, kb) - edges[0].about_e2;
        sum.elastic += m.bending * (one * one + two * two);
      } else {
        const T strain =
            square_root(dot(kb, kb) + SpringHinge<T>::delta_squared()) - edges[i].rest;
        sum.elastic += T(0.5) * m.bending * strain * strain;
      }
      before = t;
    }
    sum.tip = at;
    return sum;
  }

 private:
  template <bool with_tangent>
  void place(const SpringMaterial<T>& m, const SpringEdge<T>* edges,
             const LaneClamp<T>& clamp, Weights w, const T* q, const T* v, const T* a,
             const Load* loads, Placed* placed) const {
    Vec node_v{}, node_a{};
    for (int i = 0; i < n_; ++i) {
      Placed& e = placed[i];
      const Vec edge = load3(q + 3 * i), given = load3(v + 3 * i);
      node_v = node_v + given;
      node_a = node_a + load3(a + 3 * i);
      Forces::stretch(m.stretch, m.length, w, edge, i == 0 ? given - clamp.v : given, e);
      const T part(i + 1 < n_ ? 1 : 0.5);
      e.force = part * (m.mass * (node_a - gravity_) + m.drag * node_v);
      if (loads != nullptr) [[unlikely]] {
        e.force = where_less(T(0), loads[i].some, e.force - loads[i].load.force, e.force);
      }
      if (i == 0) {
        Forces::template wall<with_tangent>({T(2) * m.bending, T(2) * m.friction},
                                            edges[0].rest, edges[0].about_e2, clamp.frame,
                                            clamp.omega, w, edge, e);
      } else {
        Forces::template hinge<with_tangent>({m.bending, m.friction}, edges[i].rest, w,
                                             placed[i - 1], e);
      }
    }
  }

  T substitute(const SpringMaterial<T>& m, Weights w, const Placed* placed,
               const Factor* factors, T* correction) const {
    Vec x{}, change{};
    T most(0), finite(0);  // the last: 0 or NaN
    for (int i = 0; i < n_; ++i) {
      const Placed& e = placed[i];
      change = Elimination::change(e, factors[i], i == 0, x, change);
      const Vec edge = e.frame * change;
      store3(edge, correction + 3 * i);
      x = x + edge;
      const T all = x.x + x.y + x.z;
      finite += all - all;
      if constexpr (exact) {
        most =
            larger(larger(most, magnitude(x.z)), larger(magnitude(x.y), magnitude(x.x)));
      }
    }
    if constexpr (!exact) return finite;
    return larger(T(w.vel) / m.rate, T(w.pos)) * most / m.length + finite;
  }

  int n_;
  Vec gravity_;
};

}  // namespace tress::models
