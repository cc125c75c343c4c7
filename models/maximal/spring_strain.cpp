#include "models/maximal/spring_strain.h"

namespace tress::models {

namespace {

using Direction = SpringDirection<double>;

Direction along(const Vec& edge) {
  Direction to;
  to.point(edge);
  return to;
}

Vec slope(const Direction& edge, const double (&g)[2]) {
  return g[0] * edge.frame.e1 + g[1] * edge.frame.e2;
}

/// Of a strain with slopes g by turns of edge i, which its length does not change.
template <int edges>
void add_by_one(int i, const Direction& edge, const double (&g)[2],
                const TurnForm<double>& turns, EdgeMatrix<edges>& h) {
  const Vec &t = edge.frame.e0, &m1 = edge.frame.e1, &m2 = edge.frame.e2;
  const Vec longer = -edge.inverse_length * slope(edge, g);
  h.add_outer(i, i, 1, t, longer);
  h.add_outer(i, i, 1, m1,
              turns.xx * m1 + turns.xy * m2 + (-edge.inverse_length * g[0]) * t);
  h.add_outer(i, i, 1, m2,
              turns.xy * m1 + turns.yy * m2 + (-edge.inverse_length * g[1]) * t);
}

/// A joint of two edges.
struct HingeAt {
  explicit HingeAt(const Vec* e)
      : edge{along(e[0]), along(e[1])}, joint(edge[0], edge[1]) {}

  /// += by(k, l) over turns k of edge i and l of edge j.
  template <class By>
  void add(int i, int j, By by, EdgeMatrix<2>& h) const {
    const FrameOf<double>&f = edge[i].frame, &g = edge[j].frame;
    h.add_outer(i, j, 1, f.e1, by(0, 0) * g.e1 + by(0, 1) * g.e2);
    h.add_outer(i, j, 1, f.e2, by(1, 0) * g.e1 + by(1, 1) * g.e2);
  }

  Direction edge[2];
  SpringHinge<double> joint;
};

}  // namespace

double Hinge::gradient(const Vec* e, Vec* g) const {
  const HingeAt at(e);
  for (int i = 0; i < 2; ++i) g[i] = slope(at.edge[i], at.joint.g[i]);
  return at.joint.value();
}

void Hinge::hessian(const Vec* e, EdgeMatrix<2>& h) const {
  const HingeAt at(e);
  const auto second = at.joint.second();
  add_by_one(0, at.edge[0], at.joint.g[0], second.by_before, h);
  add_by_one(1, at.edge[1], at.joint.g[1], second.by_after, h);
  at.add(
      0, 1, [&](int k, int l) { return second.mixed[k][l]; }, h);
  at.add(
      1, 0, [&](int k, int l) { return second.mixed[l][k]; }, h);
}

void Hinge::metric(const Vec* e, EdgeMatrix<2>& m) const {
  const HingeAt at(e);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      at.add(
          i, j, [&](int k, int l) { return at.joint.metric(i, k, j, l); }, m);
    }
  }
}

double WallBend::gradient(const Vec* e, Vec* g) const {
  const Direction edge = along(e[0]);
  const auto strain = SpringWall<double>(t, edge).along(m);
  g[0] = slope(edge, strain.g);
  return strain.value;
}

void WallBend::hessian(const Vec* e, EdgeMatrix<1>& h) const {
  const Direction edge = along(e[0]);
  const SpringWall<double> joint(t, edge);
  const auto strain = joint.along(m);
  add_by_one(0, edge, strain.g, joint.second(strain), h);
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

}  // namespace tress::models
