#include "models/quaternion_rods/cosserat_edge.h"

namespace tress::models {
namespace {

/// N = vec(conj(q) e q) = |q|^2 R^T e is a quadratic form of q; dN/dq, linear in both.
void turned_gradient(const Vec& e, const Quaternion& q, double (&g)[3][4]) {
  turn_slope(-1.0 * (Quaternion{0, e} * q), g);
}

Vec unit(int k) { return {k == 0 ? 1.0 : 0, k == 1 ? 1.0 : 0, k == 2 ? 1.0 : 0}; }

}  // namespace

/// (N/D)' = (N' - 2 (N/D) q)/D with D = |q|^2.
void CosseratEdge::gradient(const double* x, double (&g)[strains][coordinates]) const {
  const Vec e = load3(x);
  const Quaternion q = load_quaternion(x + 3);
  const double square = dot(q, q), scale = 1 / (length * square);
  const Frame frame = axes(q);
  const Vec rows[3] = {frame.e0, frame.e1, frame.e2};
  double turned[3], slope[3][4];
  store3((1 / square) * frame.back(e), turned);
  turned_gradient(e, q, slope);
  for (int k = 0; k < 3; ++k) {
    store3(scale * rows[k], g[k]);
    for (int l = 0; l < 4; ++l) {
      g[k][3 + l] = scale * (slope[k][l] - 2 * turned[k] * x[3 + l]);
    }
    g[3][k] = 0;
  }
  for (int l = 0; l < 4; ++l) g[3][3 + l] = 2 * x[3 + l];
}

/// With f = s . N/D and B the matrix of the form s . N, by q
/// 2 (B - f)/D - 2 (q f'^T + f' q^T)/D, and by e and q f' of a unit vector.
void CosseratEdge::add_second(const double* x, const double* stress,
                              double (&h)[coordinates][coordinates]) const {
  const Vec e = load3(x), s = load3(stress);
  const Quaternion q = load_quaternion(x + 3);
  const double square = dot(q, q), scale = 1 / (length * square);
  const Frame frame = axes(q);
  const auto along_stress = [&](const double(&g)[3][4], int l) {
    return s.x * g[0][l] + s.y * g[1][l] + s.z * g[2][l];
  };
  const auto first = [&](const Vec& edge, double(&f)[4]) {
    double g[3][4];
    turned_gradient(edge, q, g);
    const double turned = dot(s, frame.back(edge)) / square;
    for (int l = 0; l < 4; ++l) f[l] = along_stress(g, l) - 2 * turned * x[3 + l];
  };
  double by_q[4];
  first(e, by_q);
  const double turned = dot(s, frame.back(e)) / square;
  for (int k = 0; k < 4; ++k) {
    double form[3][4];
    turned_gradient(e, unit_quaternion(k), form);
    for (int l = 0; l < 4; ++l) {
      h[3 + k][3 + l] +=
          scale * (along_stress(form, l) - (k == l ? 2 * turned : 0) -
                   2 / square * (x[3 + k] * by_q[l] + by_q[k] * x[3 + l])) +
          (k == l ? 2 * stress[3] : 0);
    }
  }
  for (int k = 0; k < 3; ++k) {
    first(unit(k), by_q);
    for (int l = 0; l < 4; ++l) {
      h[k][3 + l] += scale * by_q[l];
      h[3 + l][k] += scale * by_q[l];
    }
  }
}

}  // namespace tress::models
