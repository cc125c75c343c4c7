#pragma once

#include <cmath>

#include "math/mat3.h"
#include "models/effects/effect.h"

/// Laws of the force that air exerts on point i of a strand moving at u (m/s) relative to
/// it. `slope` is dforce/du at fixed tangent, `by_tangent` dforce/dt at fixed u. A law
/// declares whether it depends on the tangent, and whether u includes the velocity of the
/// point or only that of the air.
namespace tress::models {

/// -nu l u, nu in kg/(m s).
struct LinearAirLaw {
  /// Whether the law reads tangents, and velocities of points.
  static constexpr bool tangent = false, relative = true;
  double nu = 0;  // drag per length, kg/(m s)

  /// Returns the force on point i for the relative velocity u, N.
  Vec force(const Points& p, std::size_t i, const Vec& u) const {
    return -(nu * p.length[i]) * u;
  }
  /// Returns df/du, N s/m.
  Mat3 slope(const Points& p, std::size_t i, const Vec&) const {
    return -(nu * p.length[i]) * identity();
  }
};

/// Linear law on a strand assumed at rest: the force depends on the wind only.
struct StandingAirLaw : LinearAirLaw {
  static constexpr bool relative = false;  // the velocity of points is not read
};

/// b(u) = c u: quadratic drag, c in kg/m^2.
struct SquareDrag {
  double c = 0;  // coefficient, kg/m^2
  /// Returns the coefficient b(u).
  double value(double u) const { return c * u; }
  /// Returns the derivative db/du.
  double slope(double) const { return c; }
};

/// Drag b(u) = rho C(Re) r u of a cylinder of radius r in cross flow, Re = 2 r rho u/mu.
/// C = 1 + 10 Re^(-2/3) for 1 < Re < 2e5 [White, Viscous Fluid Flow, curve fit for the
/// circular cylinder]. The fit has no linear limit for Re -> 0, where C Re of a cylinder
/// falls slower than any power of Re. We use
///
///     C Re = Re + 10 (Re^2 + Re_0^2)^(1/6),   Re_0 = 0.1,    b = mu C Re/2,
///
/// which is smooth in u, with C Re = 4.6 at Re = 0. It is within 0.2 % of the fit for Re
/// > 1, and for 0.001 < Re < 0.1 between 0.9 and 1.7 times Lamb's C Re = 8 pi/(2.002 - ln
/// Re).
struct CylinderDrag {
  static constexpr double reynolds_0 = 0.1;  // Re_0 of the formula
  double half_viscosity = 0;                 // mu/2, Pa s
  double reynolds_per_speed = 0;             // 2 r rho/mu, s/m

  /// Returns the coefficient b(u).
  double value(double u) const {
    const double re = reynolds_per_speed * u;
    return half_viscosity *
           (re + 10 * std::pow(re * re + reynolds_0 * reynolds_0, 1.0 / 6));
  }
  /// Returns the derivative db/du.
  double slope(double u) const {
    const double re = reynolds_per_speed * u;
    const double power = std::pow(re * re + reynolds_0 * reynolds_0, -5.0 / 6);
    return half_viscosity * reynolds_per_speed * (1 + 10.0 / 3 * re * power);
  }
};

/// Independent normal and tangential drag of a thin cylinder [Ablow & Schechter 1983,
/// Ocean Engineering 10(6) 443-457], per length, with u_t = (u.t) t and u_n = u - u_t:
///
///     f = -b(|u_n|) u_n - 1/2 rho C_t 2 pi r |u_t| u_t.
///
/// Once differentiable in u, with slope 0 (or b(0)) at rest.
template <class NormalDrag>
struct AnisotropicAirLaw {
  /// Whether the law reads tangents, and velocities of points.
  static constexpr bool tangent = true, relative = true;
  NormalDrag normal;      // law across the strand
  double tangential = 0;  // rho C_t pi r, kg/m^2

  /// Returns the force on point i for the relative velocity u, N.
  Vec force(const Points& p, std::size_t i, const Vec& u) const {
    const Vec t = load3(&p.tangent[3 * i]);
    const double along = dot(u, t);
    const Vec across = u - along * t;
    const double speed = norm(across);
    return -p.length[i] *
           (normal.value(speed) * across + (tangential * std::abs(along) * along) * t);
  }
  /// Returns df/du, N s/m.
  Mat3 slope(const Points& p, std::size_t i, const Vec& u) const {
    const Vec t = load3(&p.tangent[3 * i]);
    const double along = dot(u, t);
    const Vec across = u - along * t;
    const double speed = norm(across);
    const Mat3 tt = outer(t, t);
    Mat3 slope =
        normal.value(speed) * (identity() - tt) + (2 * tangential * std::abs(along)) * tt;
    if (speed > 0) {
      slope = slope + (normal.slope(speed) / speed) * outer(across, across);
    }
    return -p.length[i] * slope;
  }
  /// Returns the derivative by the tangent. With du_n = -(u.dt) t - (u.t) dt and d(u_t) =
  /// (u.dt) t + (u.t) dt, u.dt = u_n.dt.
  Mat3 by_tangent(const Points& p, std::size_t i, const Vec& u) const {
    const Vec t = load3(&p.tangent[3 * i]);
    const double along = dot(u, t), friction = tangential * std::abs(along);
    const Vec across = u - along * t;
    const double speed = norm(across), drag = normal.value(speed);
    Mat3 slope = (2 * friction - drag) * outer(t, across) +
                 (along * (friction - drag)) * identity();
    if (speed > 0) {
      slope = slope - (along * normal.slope(speed) / speed) * outer(across, across);
    }
    return -p.length[i] * slope;
  }
};

}  // namespace tress::models
