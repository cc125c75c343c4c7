#include "models/maximal/spring_strain.h"

namespace tress::models {

Hinge::Parts::Parts(const Vec* e)
    : length{std::sqrt(dot(e[0], e[0])), std::sqrt(dot(e[1], e[1]))},
      along(dot(e[0], e[1])),
      c(length[0] * length[1] + along),
      x(cross(e[0], e[1])) {
  xx = dot(x, x);
  value = std::sqrt(4 * xx / (c * c) + delta * delta);
  slope_x[0] = 2.0 * cross(e[1], x);
  slope_x[1] = 2.0 * cross(x, e[0]);
  slope_c[0] = (length[1] / length[0]) * e[0] + e[1];
  slope_c[1] = (length[0] / length[1]) * e[1] + e[0];
}

void Hinge::hessian(const Vec* e, EdgeMatrix<2>& h) const {
  const Parts p(e);
  const double c2 = p.c * p.c, v = p.value;
  // Of Q = value^2 by xx and c, then of value = sqrt(Q).
  const double q_x = 4 / c2, q_c = -8 * p.xx / (c2 * p.c);
  const double q_xc = -8 / (c2 * p.c), q_cc = 24 * p.xx / (c2 * c2);
  const double by_x = q_x / (2 * v), by_c = q_c / (2 * v), v3 = 4 * v * v * v;
  h.add_product(-q_x * q_x / v3, p.slope_x, p.slope_x);
  h.add_product(2 * (q_xc / (2 * v) - q_x * q_c / v3), p.slope_x, p.slope_c);
  h.add_product(q_cc / (2 * v) - q_c * q_c / v3, p.slope_c, p.slope_c);
  for (int i = 0; i < 2; ++i) {
    const int j = 1 - i;
    const double ratio = p.length[j] / p.length[i];
    const Vec t = (1 / p.length[i]) * e[i];
    h.add_identity(i, i, 2 * by_x * p.length[j] * p.length[j] + by_c * ratio);
    h.add_outer(i, i, -2 * by_x, e[j], e[j]);
    h.add_outer(i, i, -by_c * ratio, t, t);
    h.add_identity(i, j, by_c - 2 * by_x * p.along);
    h.add_outer(i, j, 4 * by_x + by_c / (p.length[0] * p.length[1]), e[i], e[j]);
    h.add_outer(i, j, -2 * by_x, e[j], e[i]);
  }
}

void Hinge::metric(const Vec* e, EdgeMatrix<2>& m) const {
  const Parts p(e);
  const double scale = 4 / (p.c * p.c);
  for (int i = 0; i < 2; ++i) {
    const int j = 1 - i;
    m.add_identity(i, i, scale * p.length[j] * p.length[j]);
    m.add_outer(i, i, -scale, e[j], e[j]);
    m.add_identity(i, j, -scale * p.along);
    m.add_outer(i, j, scale, e[i], e[j]);
  }
  m.add_product(-scale / p.c, p.slope_x, p.slope_c);
  m.add_product(scale * p.xx / (p.c * p.c), p.slope_c, p.slope_c);
}

namespace {

/// h = volume/sqrt(square + floor): both and their slopes. n changes by sum_k u_k x
/// lever_k with the edges.
struct AltitudeParts {
  explicit AltitudeParts(const Vec* e)
      : n(cross(e[0] + e[1], e[1] + e[2])),
        volume(dot(e[0], cross(e[1], e[2]))),
        by_volume{cross(e[1], e[2]), cross(e[2], e[0]), cross(e[0], e[1])},
        lever{e[1] + e[2], e[2] - e[0], -1.0 * (e[0] + e[1])} {
    for (int k = 0; k < 3; ++k) by_square[k] = 2.0 * cross(lever[k], n);
  }
  Vec n;
  double volume;
  Vec by_volume[3], lever[3], by_square[3];
};

}  // namespace

double Altitude::gradient(const Vec* e, Vec* g) const {
  const AltitudeParts p(e);
  const double w = dot(p.n, p.n) + floor, root = std::sqrt(w);
  for (int k = 0; k < 3; ++k) {
    g[k] = (1 / root) * p.by_volume[k] - (p.volume / (2 * w * root)) * p.by_square[k];
  }
  return p.volume / root;
}

void Altitude::hessian(const Vec* e, EdgeMatrix<3>& h) const {
  const AltitudeParts p(e);
  const double w = dot(p.n, p.n) + floor, by_volume = 1 / std::sqrt(w);
  const double by_square = -p.volume / 2 * by_volume / w;
  h.add_product(-by_volume / w, p.by_volume, p.by_square);
  h.add_product(0.75 * p.volume * by_volume / (w * w), p.by_square, p.by_square);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      h.add_identity(i, j, 2 * by_square * dot(p.lever[i], p.lever[j]));
      h.add_outer(i, j, -2 * by_square, p.lever[j], p.lever[i]);
    }
  }
  h.add_cross(0, 1, -1, by_volume * e[2] + 2 * by_square * p.n);
  h.add_cross(0, 2, 1, by_volume * e[1] - 2 * by_square * p.n);
  h.add_cross(1, 2, -1, by_volume * e[0] + 2 * by_square * p.n);
}

double WallAltitude::gradient(const Vec* e, Vec* g) const {
  const Vec all[3] = {wall, e[0], e[1]};
  Vec of_all[3];
  const double h = Altitude{floor}.gradient(all, of_all);
  g[0] = of_all[1];
  g[1] = of_all[2];
  return h;
}

void WallAltitude::hessian(const Vec* e, EdgeMatrix<2>& h) const {
  const Vec all[3] = {wall, e[0], e[1]};
  EdgeMatrix<3> of_all;
  Altitude{floor}.hessian(all, of_all);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) h.m[i][j] += of_all.m[3 + i][3 + j];
  }
}

double WallBend::gradient(const Vec* e, Vec* g) const {
  const double length = std::sqrt(dot(e[0], e[0])), w = length + dot(t, e[0]);
  const double kappa = 2 * dot(m, e[0]) / w;
  g[0] = (2 / w) * m - (kappa / w) * ((1 / length) * e[0] + t);
  return kappa;
}

void WallBend::hessian(const Vec* e, EdgeMatrix<1>& h) const {
  const double length = std::sqrt(dot(e[0], e[0])), w = length + dot(t, e[0]);
  const double kappa = 2 * dot(m, e[0]) / w;
  const Vec direction = (1 / length) * e[0];
  const Vec slope = direction + t;  // of w
  h.add_product(-4 / (w * w), &m, &slope);
  h.add_product(2 * kappa / (w * w), &slope, &slope);
  h.add_identity(0, 0, -kappa / (w * length));
  h.add_product(kappa / (w * length), &direction, &direction);
}

}  // namespace tress::models
