#pragma once

#include "models/math/vec3.h"

namespace tress {

/// The scalar functions of s and X = |kappa|^2 behind a helix (w = |kappa|):
///
///     S = sin(ws)/w,  A = (1 - cos ws)/w^2,  B = (ws - sin ws)/w^3
///     A1 = A'(w)/w,  A2 = A1'(w)/w,  A3 = A2'(w)/w,  and the same for B
///
/// All are even in w, so the derivatives with respect to kappa are dA = A1 (kappa .
/// dkappa) and so on.
template <class T>
struct HelixFunctions {
  T S, A, B, A1, B1, A2, B2, A3, B3;
};

/// s scalar or pack; x2 = |kappa|^2 is one number (an element has one kappa).
/// Power series in (ws)^2 while ws <= series_end, closed forms beyond; no branch inside a
/// pack other than on |kappa| * longest. Relative error <= 1e-14 of the size of the terms
/// ...
template <class T>
HelixFunctions<T> helix_functions(const T& s, double x2, double longest);

}  // namespace tress
