#pragma once

#include <type_traits>

#include "contract/basics.h"
#include "models/maximal/kernel/der_elimination.h"

namespace tress::models {

/// Frame of an edge along t as edge_frame() of models/maximal/rod_edge.h. `tangent` and
/// `direction` are e0 and e1 of its reference, `beside` = 1/(1 + tangent . t).
template <class T>
FrameOf<T> der_frame(const Vec3<T>& tangent, const Vec3<T>& direction, const Vec3<T>& t,
                     const T& beside, const T& theta) {
  const SineCosine<T> turn = sine_cosine(theta);
  const Vec3<T> u = turn.cosine * direction + turn.sine * cross(tangent, direction);
  const Vec3<T> m1 = u - (dot(u, t) * beside) * (tangent + t);
  return {t, m1, cross(t, m1)};
}

/// Motion of an edge: spin in components of its frame, and rate of its length.
template <class T>
struct DerMotion {
  Vec3<T> spin;   // angular velocity
  T lengthening;  // rate of the length
};

/// Edges and joints of a discrete rod at a state: moments and tensions and, with_tangent,
/// derivatives. Edge by edge from the root on, edge() comes first, then joint(), of the
/// joint before the edge.
template <class T, bool exact>
class DerForces {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Geometry and stresses at a state.
  using Placed = std::conditional_t<exact, DerExactPlaced<T>, DerPlaced<T>>;
  /// Motion of a frame.
  using Motion = DerMotion<T>;

  /// Begins an edge. Returns its motion.
  static Motion edge(const Vec& tangent, const Vec& direction, const T& theta,
                     const Vec& edge, const Vec& rate, const T& theta_rate,
                     const T& stiffness, const T& rest, Placed& e) {
    const T square = dot(edge, edge);
    e.inverse_length = inverse_sqrt(square);
    e.length = square * e.inverse_length;
    const Vec t = e.inverse_length * edge;
    const T beside = T(1) / (T(1) + dot(tangent, t));
    e.frame = der_frame(tangent, direction, t, beside, theta);
    e.p = {T(1), beside * dot(tangent, e.frame.e1), beside * dot(tangent, e.frame.e2)};
    // theta' = spin . p.
    const T spin1 = -(e.inverse_length * dot(rate, e.frame.e2)),
            spin2 = e.inverse_length * dot(rate, e.frame.e1);
    e.tension = stiffness * (e.length - rest);
    return {{theta_rate - spin1 * e.p.y - spin2 * e.p.z, spin1, spin2}, dot(t, rate)};
  }

  /// The joint between a frame, which spins in its own components, and an edge.
  static DerJoint<T> strain(const FrameOf<T>& before, Placed& e) {
    e.turn = {
        {e.frame.back(before.e0), e.frame.back(before.e1), e.frame.back(before.e2)}};
    return DerJoint<T>(e.turn);
  }

  /// Contribution of friction to the moment on an edge where it and the edge before
  /// lengthen. They then turn less at the same rates. Elimination omits it, as it is
  /// small compared with the stiffness against lengthening.
  struct ByLengthening {
    Vec own, before;  // on the edge, and on the edge before
  };

  /// Moment of that joint at this strain, less that at rest. `edge_before`: null at the
  /// clamp. `rubbed`: false if friction is 0. `left_out`: null, or what Elimination
  /// leaves out.
  template <bool with_tangent>
  static void joint(const DerJoint<T>& joint, const Vec& strain, const Vec& stiffness,
                    const T& friction, bool rubbed, Weights w, const Motion& own,
                    const Motion& before, const Placed* edge_before, Placed& e,
                    ByLengthening* left_out = nullptr) {
    const Vec relative = own.spin - e.turn.back(before.spin);
    const Vec stress{stiffness.x * strain.x + friction * dot(joint.twist, relative),
                     stiffness.y * strain.y + friction * dot(joint.curvature1, relative),
                     stiffness.z * strain.z + friction * dot(joint.curvature2, relative)};
    e.moment = stress.x * joint.twist + stress.y * joint.curvature1 +
               stress.z * joint.curvature2;
    if constexpr (with_tangent) {
      const T damped = T(w.vel) * friction;
      e.stiff = joint.stiff(T(w.pos) * stiffness + Vec{damped, damped, damped});
      if constexpr (exact) {
        second_of_joint(joint, T(w.pos) * stress, e);
        if (rubbed) {
          add_friction(joint, T(w.pos) * friction, own, before, edge_before, e, left_out);
        }
      }
    }
  }

 private:
  static void second_of_joint(const DerJoint<T>& joint, const Vec& stress, Placed& e) {
    const auto form = joint.second(e.turn, stress);
    e.ww = full(e.stiff + form.alike);
    e.oo = e.ww;
    e.ow = form.across - full(e.stiff);
    e.wo = e.ow.transposed();
  }

  /// The rate of a strain changes with the place: its gradient times the second
  /// derivative along the motion.
  static void add_friction(const DerJoint<T>& joint, const T& friction, const Motion& own,
                           const Motion& before, const Placed* edge_before, Placed& e,
                           ByLengthening* left_out) {
    const Vec spin_before = e.turn.back(before.spin);
    const T o(0), one(1);
    const auto add = [&](const Vec& slope, const Vec& unit) {
      const auto form = joint.second(e.turn, unit);
      const DerEdgeForm<T> of_edge(e.p, e.inverse_length, slope);
      const Vec by_w = form.across.back(spin_before) + form.alike * own.spin +
                       of_edge.omega * own.spin + own.lengthening * of_edge.sigma;
      Vec by_o = form.alike * spin_before + form.across * own.spin;
      if (edge_before != nullptr) {
        const DerEdgeForm<T> of_before(edge_before->p, edge_before->inverse_length,
                                       Vec{} - e.turn * slope);
        by_o = by_o + e.turn.back(of_before.omega * before.spin +
                                  before.lengthening * of_before.sigma);
        if (left_out != nullptr) {
          left_out->before =
              left_out->before + (friction * dot(of_before.sigma, before.spin)) * slope;
        }
      }
      if (left_out != nullptr) {
        left_out->own = left_out->own + (friction * dot(of_edge.sigma, own.spin)) * slope;
      }
      const Matrix w = dyad(friction * slope, by_w),
                   turned = dyad(friction * slope, by_o);
      e.ww = e.ww + w;
      e.wo = e.wo + turned;
      e.ow = e.ow - w;
      e.oo = e.oo - turned;
    };
    add(joint.twist, {one, o, o});
    add(joint.curvature1, {o, one, o});
    add(joint.curvature2, {o, o, one});
  }
};

}  // namespace tress::models
