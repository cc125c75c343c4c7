#pragma once

#include "math/mat3.h"

namespace tress::models {

/// The laws of Signorini and Coulomb at one contact; components along the normal and two
/// tangents. r is the force (N), u = W r + b the velocity of one body relative to the
/// other (m/s), W symmetric and positive definite (m/s per N):
///
///     r = 0 and u_n >= 0,                              open
///     u = 0 and |r_t| <= mu r_n,                       sticks
///     u_n = 0, |r_t| = mu r_n, u_t = -s r_t, s > 0     slides
///
/// Returns r. Sliding is Newton's method for the direction of u_t, which is a root of a
/// trigonometric polynomial of degree 2; where it does not converge the circle is
/// searched. `guess` is a force near r. Without any solution (W of a strong coupling and
/// a large mu) r has the friction of the nearest direction.
Vec contact_force(const Mat3& w, const Vec& b, double mu, const Vec& guess = {});

/// By how much u and r violate the laws, m/s: the length of the function of Fischer and
/// Burmeister of the second-order cone [Fukushima, Luo & Tseng 2002], 0 where they hold,
///
///     x = m (mu r_n, r_t),   y = ((u_n + mu |u_t|)/mu, u_t),   m = tr W/3
///
/// The normal velocity with mu |u_t| added makes Coulomb's law a complementarity of cones
/// [de Saxcé & Feng 1998].
double contact_violation(const Mat3& w, const Vec& u, const Vec& r, double mu);

}  // namespace tress::models
