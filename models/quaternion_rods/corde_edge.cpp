#include "models/quaternion_rods/corde_edge.h"

namespace tress::models {

/// With t = e/|e|, dt/de = (1 - t t^T)/|e|.
void CordeEdge::gradient(const double* x, double (&g)[strains][coordinates]) const {
  const Vec e = load3(x);
  const double now = norm(e);
  double t[3], slope[3][4];
  store3((1 / now) * e, t);
  axis_gradient(load_quaternion(x + 3), slope);
  for (int k = 0; k < 3; ++k) {
    g[0][k] = t[k];
    g[4][k] = 0;
    for (int l = 0; l < 3; ++l) g[1 + k][l] = ((k == l ? 1 : 0) - t[k] * t[l]) / now;
  }
  for (int l = 0; l < 4; ++l) {
    g[0][3 + l] = 0;
    for (int k = 0; k < 3; ++k) g[1 + k][3 + l] = -slope[k][l];
    g[4][3 + l] = 2 * x[3 + l];
  }
}

/// With P = 1 - t t^T, s . t has the second derivative
/// -(P s t^T + t (P s)^T + (s . t) P)/|e|^2; that of s . t(q) is twice the matrix of a
/// quadratic form.
void CordeEdge::add_second(const double* x, const double* stress,
                           double (&h)[coordinates][coordinates]) const {
  const Vec e = load3(x);
  const double now = norm(e);
  const Vec direction = (1 / now) * e, s = load3(stress + 1);
  const double along = dot(s, direction);
  double t[3], off[3];
  store3(direction, t);
  store3(s - along * direction, off);
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      const double across = (k == l ? 1 : 0) - t[k] * t[l];
      h[k][l] += stress[0] / now * across -
                 (off[k] * t[l] + t[k] * off[l] + along * across) / (now * now);
    }
  }
  for (int k = 0; k < 4; ++k) {
    double slope[3][4];
    axis_gradient(unit_quaternion(k), slope);
    for (int l = 0; l < 4; ++l) {
      const double form = s.x * slope[0][l] + s.y * slope[1][l] + s.z * slope[2][l];
      h[3 + k][3 + l] += (k == l ? 2 * stress[4] : 0) - form;
    }
  }
}

}  // namespace tress::models
