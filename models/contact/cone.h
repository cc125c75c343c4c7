#pragma once

#include "math/mat3.h"

namespace tress::models {

/// Solves the laws of Signorini and Coulomb at one contact. Components are along the
/// normal and two tangents. The force is r (N). The velocity of one body relative to the
/// other is u = W r + b (m/s). W is symmetric and positive definite (m/s per N):
///
///     r = 0 and u_n >= 0,                              open
///     u = 0 and |r_t| <= mu r_n,                       sticks
///     u_n = 0, |r_t| = mu r_n, u_t = -s r_t, s > 0     slides
///
/// Returns r. Sliding is solved by Newton's method for the direction of u_t, a root of a
/// trigonometric polynomial of degree 2. Where it does not converge, the circle is
/// searched. `guess` is a force near r. Without a solution (W of a strong coupling and a
/// large mu) r has the friction of the nearest direction.
Vec contact_force(const Mat3& w, const Vec& b, double mu, const Vec& guess = {});

/// Returns the violation of the laws by u and r, m/s; 0 where they are satisfied. It is
/// the length of the Fischer-Burmeister function of the second-order cone [Fukushima, Luo
/// & Tseng 2002],
///
///     x = m (mu r_n, r_t),   y = ((u_n + mu |u_t|)/mu, u_t),   m = tr W/3
///
/// Adding mu |u_t| to the normal velocity makes Coulomb's law a complementarity of cones
/// [de Saxcé & Feng 1998].
double contact_violation(const Mat3& w, const Vec& u, const Vec& r, double mu);

}  // namespace tress::models
