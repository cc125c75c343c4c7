#pragma once

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "contract/layers.h"
#include "math/mat3.h"
#include "models/contact/body_shapes.h"

namespace tress::models {

/// Normal force of a compliant contact, per length of strand. With the signed distance
/// phi of the centre line, g = grad phi, n = g/|g|, the depth d = offset - phi > 0 and
/// the velocity u relative to the surface, u_n = n.u:
///
///     N = k d |g| h(1 - c u_n),   E = k d^2/2
///
/// c damps in proportion to the depth, so the force does not jump when contact begins or
/// ends [Hunt & Crossley 1975, J. Appl. Mech. 42, 440]. The factor h(s) is s for s >=
/// 1/2, (s + 1/2)^2/2 for -1/2 <= s <= 1/2 and 0 below, so the contact never pulls. Since
/// h(1) = 1, only the spring acts on a strand at rest.
struct NormalContact {
  double stiffness = 0;  // k, N/m^2
  double damping = 0;    // c, s/m
  double offset = 0;     // radius of the strand, m

  /// Returns the depth of the strand's surface in the body, m.
  double depth(const Distance& to) const { return offset - to.value; }

  /// Elastic load on a point in contact, d > 0; N/m.
  Vec elastic_load(const Distance& to) const {
    return (stiffness * depth(to)) * to.gradient;
  }
  /// Returns the energy per length of a point in contact, J/m.
  double energy(const Distance& to) const {
    return stiffness / 2 * depth(to) * depth(to);
  }

  /// Contact of a point at a state.
  template <class T>
  struct StateOf {
    T depth, steepness;        // d (m), |g|
    Vec3<T> n;                 // normal
    T speed_away;              // u_n
    T cushion, cushion_slope;  // h and its derivative
    T load;                    // N

    /// Evaluates the law for a distance and a velocity.
    StateOf(const NormalContact& law, const DistanceOf<T>& to, const Vec3<T>& u)
        : depth(T(law.offset) - to.value),
          steepness(square_root(dot(to.gradient, to.gradient))),
          n(where_less(T(0), steepness, T(1), T(0)) /
            where_less(T(0), steepness, steepness, T(1)) * to.gradient),
          speed_away(dot(n, u)) {
      const T s = T(1) - T(law.damping) * speed_away;
      const T start = larger(T(0), smaller(s + T(0.5), T(1)));  // h up to s = 1/2
      cushion = T(0.5) * (start * start) + larger(s - T(0.5), T(0));
      cushion_slope = start;
      load = T(law.stiffness) * depth * steepness * cushion;
    }
    /// Returns the projection onto the tangent plane.
    Mat3Of<T> across() const { return identity<T>() - outer(n, n); }
    /// dn/dx, with the second derivatives of phi.
    Mat3Of<T> n_by_x(const Mat3Of<T>& curvature) const {
      return (T(1) / steepness) * (curvature - outer(n, n * curvature));
    }
    Vec3<T> slide(const Vec3<T>& u) const { return u - speed_away * n; }  // u_t
    /// du_t/dx at fixed u.
    Mat3Of<T> slide_by_x(const Vec3<T>& u, const Mat3Of<T>& n_by_x) const {
      return T(-1) * (outer(n, u * n_by_x) + speed_away * n_by_x);
    }
  };
  /// Contact of one point.
  using State = StateOf<double>;

  /// dN/du_n
  template <class T>
  T by_speed(const StateOf<T>& at) const {
    const T spring = T(stiffness) * at.depth * at.steepness;
    return T(-damping) * spring * at.cushion_slope;
  }
  /// dN/dx at fixed u.
  template <class T>
  Vec3<T> by_x(const StateOf<T>& at, const DistanceOf<T>& to, const Mat3Of<T>& curvature,
               const Mat3Of<T>& n_by_x, const Vec3<T>& u) const {
    return (T(-stiffness) * at.steepness * at.cushion) * to.gradient +
           (T(stiffness) * at.depth * at.cushion) * (at.n * curvature) +
           by_speed(at) * (u * n_by_x);
  }
};

/// Throws InputError unless the numbers and Coulomb's coefficient are >= 0 and finite.
inline void check(const NormalContact& law, double friction) {
  for (const double x : {law.stiffness, law.damping, law.offset, friction}) {
    if (std::isfinite(x) && x >= 0) continue;
    throw InputError("a number of the contact is negative or not finite", "effect body",
                     "give stiffness, damping, friction and strand radius >= 0");
  }
}

/// df/dx at fixed u and df/du of a contact force.
template <class T>
struct ContactSlopesOf {
  Mat3Of<T> by_x, by_u;  // derivatives by place and by velocity
};
/// Derivatives of one contact force.
using ContactSlopes = ContactSlopesOf<double>;

/// Compliant contact with regularised friction, per length of strand:
///
///     f = N (n - mu e(|u_t|) u_t),   u_t = u - u_n n
///
/// Coulomb friction is full at |u_t| >= v and falls smoothly below. e(y) is 1/y, and (2 -
/// y/v)/v below v [Li et al. 2020, Incremental Potential Contact, eq. 15]. Sticking
/// contacts creep at less than v. Damping and friction dissipate. The load is continuous;
/// its derivatives jump where contact begins.
struct BodyContact {
  double stiffness = 0;  // k, N/m^2
  double damping = 0;    // c, s/m
  double friction = 0;   // mu
  double slip = 1e-3;    // v, m/s, > 0
  double offset = 0;     // radius of the strand, m

  /// Returns the law of the normal force.
  NormalContact normal() const { return {stiffness, damping, offset}; }

  /// Returns the load on a point, N/m.
  template <class T>
  Vec3<T> load(const DistanceOf<T>& to, const Vec3<T>& u) const {
    const State<T> at(*this, to, u);
    return at.load * at.direction();
  }

  /// Returns the derivatives of the load. With w = n - mu e u_t and y = u dn/dx, and
  /// since u_t.n = 0 and n dn/dx = 0,
  ///
  ///     df/dx = w dN/dx + N ((1 + mu e u_n) dn/dx + mu (e n + e'/|u_t| u_n u_t) y),
  ///     df/du = w dN/du - mu N (e (1 - n n) + e'/|u_t| u_t u_t).
  template <class T>
  ContactSlopesOf<T> slopes(const DistanceOf<T>& to, const Mat3Of<T>& curvature,
                            const Vec3<T>& u) const {
    return State<T>(*this, to, u).slopes(*this, to, curvature, u);
  }
  /// Load and slopes of a point in one pass.
  template <class T>
  Vec3<T> load(const DistanceOf<T>& to, const Mat3Of<T>& curvature, const Vec3<T>& u,
               ContactSlopesOf<T>& slopes) const {
    const State<T> at(*this, to, u);
    slopes = at.slopes(*this, to, curvature, u);
    return at.load * at.direction();
  }

 private:
  template <class T>
  struct State : NormalContact::StateOf<T> {
    using Normal = NormalContact::StateOf<T>;
    Vec3<T> slide;  // u_t
    T grip;         // e
    T grip_slope;   // e'/|u_t|
    T friction;

    State(const BodyContact& law, const DistanceOf<T>& to, const Vec3<T>& u)
        : Normal(law.normal(), to, u), slide(Normal::slide(u)), friction(law.friction) {
      const T y = square_root(dot(slide, slide)), o(0), fast(law.slip);
      const T by = T(1) / where_less(o, y, y, T(1));
      const T fades = T(1 / law.slip);
      grip = where_less(y, fast, fades * (T(2) - y * fades), by);
      grip_slope = where_less(y, fast, where_less(o, y, -(fades * fades * by), o),
                              -(by * by * by));
    }
    Vec3<T> direction() const { return this->n - (friction * grip) * slide; }

    ContactSlopesOf<T> slopes(const BodyContact& law, const DistanceOf<T>& to,
                              const Mat3Of<T>& curvature, const Vec3<T>& u) const {
      const NormalContact normal = law.normal();
      const Vec3<T>& n = this->n;
      // Without a direction there is no load, and n_by_x would divide by 0.
      const T o(0), some = where_less(o, this->steepness, T(1), o);
      Normal at = *this;
      at.steepness = where_less(o, this->steepness, this->steepness, T(1));
      const Mat3Of<T> n_by_x = some * at.n_by_x(curvature);
      const Vec3<T> w = some * direction(), turned = u * n_by_x;
      const T rubs = friction * this->load, held = rubs * grip, turns = rubs * grip_slope;
      const T& away = this->speed_away;
      return {outer(w, normal.by_x(*this, to, curvature, n_by_x, u)) +
                  (this->load + held * away) * n_by_x +
                  outer(held * n + (turns * away) * slide, turned),
              outer(w, normal.by_speed(*this) * n) - held * this->across() -
                  turns * outer(slide, slide)};
    }
  };
};

}  // namespace tress::models
