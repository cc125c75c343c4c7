#pragma once

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "contract/layers.h"
#include "math/mat3.h"
#include "models/contact/body_shapes.h"

namespace tress::models {

/// The normal force of a compliant contact, per length of strand. With the signed
/// distance phi of the centre line, g = grad phi, n = g/|g|, the depth d = offset - phi >
/// 0 and the velocity u relative to the surface, u_n = n.u:
///
///     N = k d |g| h(1 - c u_n),   E = k d^2/2
///
/// c damps in proportion to the depth, so the force does not jump when contact begins or
/// ends [Hunt & Crossley 1975, J. Appl. Mech. 42, 440]; h(s) = s for s >= 1/2 and (s +
/// 1/2)^2/2 from there down to 0 at s = -1/2, so the contact never pulls, and h(1) = 1,
/// so only the spring acts on a strand at rest.
struct NormalContact {
  double stiffness = 0;  // k, N/m^2
  double damping = 0;    // c, s/m
  double offset = 0;     // radius of the strand, m

  double depth(const Distance& to) const { return offset - to.value; }

  /// Elastic load on a point in contact, d > 0; N/m.
  Vec elastic_load(const Distance& to) const {
    return (stiffness * depth(to)) * to.gradient;
  }
  double energy(const Distance& to) const {
    return stiffness / 2 * depth(to) * depth(to);
  }

  struct State {
    double depth, steepness;
    Vec n;
    double speed_away;  // u_n
    double cushion, cushion_slope;
    double load;  // N

    State(const NormalContact& law, const Distance& to, const Vec& u)
        : depth(law.depth(to)),
          steepness(std::sqrt(dot(to.gradient, to.gradient))),
          n(steepness > 0 ? (1 / steepness) * to.gradient : Vec{}),
          speed_away(dot(n, u)) {
      const double s = 1 - law.damping * speed_away;
      const double start = std::clamp(s + 0.5, 0.0, 1.0);  // h up to s = 1/2
      cushion = start * start / 2 + std::max(s - 0.5, 0.0);
      cushion_slope = start;
      load = law.stiffness * depth * steepness * cushion;
    }
    Mat3 across() const { return identity() - outer(n, n); }
    /// dn/dx, with the second derivatives of phi.
    Mat3 n_by_x(const Mat3& curvature) const {
      return (1 / steepness) * (across() * curvature);
    }
    Vec slide(const Vec& u) const { return u - speed_away * n; }  // u_t
    /// du_t/dx at fixed u.
    Mat3 slide_by_x(const Vec& u, const Mat3& n_by_x) const {
      return (-1.0) * (outer(n, u * n_by_x) + speed_away * n_by_x);
    }
  };
  /// dN/du_n
  double by_speed(const State& at) const {
    const double spring = stiffness * at.depth * at.steepness;
    return -damping * spring * at.cushion_slope;
  }
  /// dN/dx at fixed u.
  Vec by_x(const State& at, const Distance& to, const Mat3& curvature, const Mat3& n_by_x,
           const Vec& u) const {
    return (-stiffness * at.steepness * at.cushion) * to.gradient +
           (stiffness * at.depth * at.cushion) * (at.n * curvature) +
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
struct ContactSlopes {
  Mat3 by_x, by_u;
};

/// Compliant contact with regularised friction, per length of strand:
///
///     f = N (n - mu e(|u_t|) u_t),   u_t = u - u_n n
///
/// Coulomb friction is full at |u_t| >= v and falls smoothly below, e(y) = 1/y and (2 -
/// y/v)/v [Li et al. 2020, Incremental Potential Contact, eq. 15]: sticking contacts
/// creep at less than v. Damping and friction dissipate. The load is continuous; its
/// derivatives jump where contact begins.
struct BodyContact {
  double stiffness = 0;  // k, N/m^2
  double damping = 0;    // c, s/m
  double friction = 0;   // mu
  double slip = 1e-3;    // v, m/s, > 0
  double offset = 0;     // radius of the strand, m

  NormalContact normal() const { return {stiffness, damping, offset}; }

  Vec load(const Distance& to, const Vec& u) const {
    const State at(*this, to, u);
    return at.load * at.direction();
  }

  ContactSlopes slopes(const Distance& to, const Mat3& curvature, const Vec& u) const {
    const State at(*this, to, u);
    if (at.steepness == 0) return {};
    const Vec w = at.direction();
    const Mat3 n_by_x = at.n_by_x(curvature);
    const Mat3 drag = (friction * at.load) *
                      (at.grip * identity() + at.grip_slope * outer(at.slide, at.slide));
    return {outer(w, normal().by_x(at, to, curvature, n_by_x, u)) + at.load * n_by_x -
                drag * at.slide_by_x(u, n_by_x),
            outer(w, normal().by_speed(at) * at.n) - drag * at.across()};
  }

 private:
  struct State : NormalContact::State {
    Vec slide;          // u_t
    double grip;        // e
    double grip_slope;  // e'/|u_t|
    double friction;

    State(const BodyContact& law, const Distance& to, const Vec& u)
        : NormalContact::State(law.normal(), to, u),
          slide(NormalContact::State::slide(u)),
          friction(law.friction) {
      const double y = norm(slide);
      if (y >= law.slip) {
        grip = 1 / y;
        grip_slope = -1 / (y * y * y);
      } else {
        grip = (2 - y / law.slip) / law.slip;
        grip_slope = y > 0 ? -1 / (law.slip * law.slip * y) : 0;
      }
    }
    Vec direction() const { return n - (friction * grip) * slide; }
  };
};

}  // namespace tress::models
