#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "models/contact/body_contact.h"

namespace tress::models {

/// State of a contact between steps; vectors in the components of the body.
struct HeldContact {
  double normal = 0;  // lambda_n, N
  Vec tangential;     // lambda_t, N
  /// Gap that counts as none, m. For a strand that overlaps the body at first: that
  /// overlap. For a closed contact: the gap that the tolerance left in the last step,
  /// which divided by a much shorter step would be a speed.
  double rest_gap = 0;
  double gap = 0;     // of the last solution, m
  double leaves = 0;  // part of its error that an improvement leaves, 0: unknown
  Vec slide;          // U of the last solution, m/s

  /// Returns true if the contact holds a force.
  bool some() const { return normal > 0 || dot(tangential, tangential) > 0; }
};

/// Contact force on a point of a strand by the laws of Signorini and Coulomb:
///
///     f = N n + T,   |T| <= mu N,   U_t = 0 if |T| < mu N, else U_t = -|U_t| T/|T|
///
/// as an augmented Lagrangian [Alart & Curnier 1991] with multipliers lambda and a
/// penalty rho (kg/s), P the projection onto the disc of radius mu N:
///
///     T = P(lambda_t - rho U_t),   lambda_t and U_t in the tangent plane
///     N = l k d |g| h(1 - c u_n)          compliant: NormalContact on the length l
///     N = max(0, lambda_n - rho w)        rigid
///
/// U = (X - x0)/tau is the slide of the position X in the frame of the body, by the
/// formula of the method (ContactForm). U is 0 where the position stays. The velocity u
/// relative to the surface at the end of a step is not, if the body turns. The violation
/// w is the gap less rest_gap over tau, the time in which velocities move the point. For
/// a point that rebounds after impact at u_0 < 0, w is the excess u_n + e u_0. The law is
/// satisfied where the multipliers are the forces. Without a penalty a rigid contact's
/// force is its multiplier.
struct ExactContact {
  NormalContact compliance;  // law of a compliant surface
  bool rigid = false;        // whether the surface is rigid
  double friction = 0;       // mu
  double restitution = 0;    // e, of a rigid surface

  /// Penalty of a point while the equations of one state are solved.
  struct Penalty {
    double length = 0;              // l, m
    double rho = 0;                 // kg/s
    double tau = 0;                 // s
    std::optional<double> rebound;  // -e u_0, m/s
    Vec from;                       // x0, m
  };

  /// Distance from the surface (m) from which on the force is 0.
  double reach(const HeldContact& held, const Penalty& penalty) const {
    constexpr double everywhere = std::numeric_limits<double>::infinity();
    if (!rigid) return compliance.offset;
    if (constant(penalty)) return held.some() ? everywhere : compliance.offset;
    if (penalty.rebound) return everywhere;
    const double pulls = held.normal * penalty.tau / penalty.rho;
    return compliance.offset + held.rest_gap + pulls;
  }

  /// Contact of one point at a state.
  class State {
   public:
    /// Evaluates the law for a place and a velocity.
    State(const ExactContact& law, const HeldContact& held, const Penalty& penalty,
          const Distance& to, const Vec& x, const Vec& u)
        : law_(law),
          held_(held),
          penalty_(penalty),
          to_(to),
          u_(u),
          normal_(law.compliance, to, u),
          gap_rate_(law.gap_rate(held, penalty, normal_)),
          load_(law.rigid ? std::max(0.0, held.normal - penalty.rho * gap_rate_)
                          : penalty.length * normal_.load),
          along_(penalty.tau > 0 ? (1 / penalty.tau) * (x - penalty.from) : u),
          slide_(in_plane(along_)),
          pull_(in_plane(held.tangential) - penalty.rho * slide_),
          slips_(!law.constant(penalty) && norm(pull_) > law.friction * load_) {
      tangential_ = slips_ ? (law.friction * load_ / norm(pull_)) * pull_ : pull_;
    }
    double gap() const { return -normal_.depth; }  // m
    /// Returns the normal of the surface.
    const Vec& outwards() const { return normal_.n; }
    const Vec& along() const { return along_; }  // U, m/s
    /// Returns the quantity that the laws of a rigid contact restrict: w n + U_t, m/s.
    Vec excess() const {
      return law_.excess(held_, penalty_, normal_) * normal_.n + slide_;
    }
    double normal() const { return load_; }                // N
    const Vec& tangential() const { return tangential_; }  // T
    /// Returns true if friction is at its bound.
    bool slips() const { return slips_; }
    /// Returns the force, N.
    Vec load() const { return load_ * normal_.n + tangential_; }

    /// The largest speed by which the motion and the force violate the law, m/s. It
    /// bounds the speed T.U/(mu N) at which friction drives the slide. What sticks has
    /// |T| <= mu N, hence T.U <= mu N |U|. What slips has T = mu N d, |d| = 1, and
    /// |U + |U| d|^2 = 2 |U| (|U| + U.d) >= 2 (U.d)^2 where U.d > 0.
    double violation() const {
      double worst = 0;
      if (law_.rigid) worst = load_ > 0 ? std::abs(gap_rate_) : std::max(0.0, -gap_rate_);
      if (load_ == 0 || law_.friction == 0) return worst;
      const double speed = norm(slide_);
      if (!slips_) return std::max(worst, speed);
      return std::max(worst,
                      norm(slide_ + (speed / (law_.friction * load_)) * tangential_));
    }

    /// Returns the derivatives of the force.
    ContactSlopes slopes(const Mat3& curvature) const {
      if (normal_.steepness == 0 || load_ == 0) return {};
      const Mat3 across = normal_.across(), n_by_x = normal_.n_by_x(curvature);
      const double rho = penalty_.rho, per_time = rho > 0 ? 1 / penalty_.tau : 0;
      Vec load_by_x;
      double by_speed = 0;
      if (!law_.rigid) {
        load_by_x =
            penalty_.length * law_.compliance.by_x(normal_, to_, curvature, n_by_x, u_);
        by_speed = penalty_.length * law_.compliance.by_speed(normal_);
      } else if (penalty_.rebound) {
        load_by_x = -rho * (u_ * n_by_x);
        by_speed = -rho;
      } else {
        load_by_x = (-rho * per_time) * to_.gradient;
      }
      const Vec& held = held_.tangential;
      const Mat3 pull_by_x =
          (-1.0) * (outer(normal_.n, held * n_by_x) + dot(normal_.n, held) * n_by_x) -
          rho * (per_time * across - outer(normal_.n, along_ * n_by_x) -
                 dot(normal_.n, along_) * n_by_x);
      // T = R d, d = s/|s|: dT = d dR + (R/|s|) (1 - d d^T) ds.
      Vec w = normal_.n;
      Mat3 turn = identity();
      if (slips_) {
        const double size = norm(pull_);
        const Vec d = (1 / size) * pull_;
        w = w + law_.friction * d;
        turn = (law_.friction * load_ / size) * (identity() - outer(d, d));
      }
      return {outer(w, load_by_x) + load_ * n_by_x + turn * pull_by_x,
              outer(w, by_speed * normal_.n)};
    }

   private:
    Vec in_plane(const Vec& a) const { return a - dot(normal_.n, a) * normal_.n; }

    const ExactContact& law_;
    const HeldContact& held_;
    const Penalty& penalty_;
    Distance to_;
    Vec u_;
    NormalContact::State normal_;
    double gap_rate_;  // w
    double load_;      // N
    Vec along_;        // U
    Vec slide_;        // U_t
    Vec pull_;         // lambda_t - rho U_t
    bool slips_;
    Vec tangential_;
  };

 private:
  double gap_rate(const HeldContact& held, const Penalty& penalty,
                  const NormalContact::State& at) const {
    return rigid && !constant(penalty) ? excess(held, penalty, at) : 0;
  }
  bool constant(const Penalty& penalty) const { return rigid && penalty.rho == 0; }
  static double excess(const HeldContact& held, const Penalty& penalty,
                       const NormalContact::State& at) {
    if (penalty.rebound) return at.speed_away - *penalty.rebound;
    return (-at.depth - held.rest_gap) / penalty.tau;
  }
};

}  // namespace tress::models
