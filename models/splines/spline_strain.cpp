#include "models/splines/spline_strain.h"

namespace tress::models {
namespace {

/// The frame at a knot and how it turns with y = (r', theta).
struct Knot {
  Knot(const Frame& reference, const double* y)
      : turn(reference.e0, load3(y)), frame(edge_frame(reference, load3(y), y[3])) {}

  /// g = of y, the work of a moment.
  void pull_back(const Vec& moment, double* g) const {
    store3(turn.force(moment), g);
    g[3] = dot(moment, turn.t);
  }

  EdgeTurn turn;
  Frame frame;
};

struct Knots {
  Knots(const Frame* reference, const double* x)
      : side{Knot(reference[0], x), Knot(reference[1], x + 4)} {}
  /// Spin by coordinate k of (r'-, theta-, r'+, theta+).
  Vec column(int k) const { return side[k / 4].turn.column(k % 4); }

  Knot side[2];
};

template <int n>
void add_block(const Pack (&block)[4], int at, double (&h)[n][n]) {
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l < 4; ++l) h[at + k][at + l] += block[k][l];
  }
}

/// kappa = a x b/|a|^2 at a point.
struct Curvature {
  explicit Curvature(const double* x)
      : a(load3(x)),
        b(load3(x + 3)),
        square(dot(a, a)),
        kappa((1 / square) * cross(a, b)) {}

  /// Derivatives of n . kappa by a and b.
  void slope(const Vec& n, double* g) const {
    store3((1 / square) * (cross(b, n) - (2 * dot(kappa, n)) * a), g);
    store3((1 / square) * cross(n, a), g + 3);
  }
  /// h += second derivatives of n . kappa, in the last six coordinates.
  void add_second(const Vec& n, double (&h)[14][14]) const {
    double by_a[3], by_b[3], at[3];  // of n . (a x b)
    store3(cross(b, n), by_a);
    store3(cross(n, a), by_b);
    store3(a, at);
    const double k = dot(kappa, n);
    const double e[3][3] = {{0, n.z, -n.y}, {-n.z, 0, n.x}, {n.y, -n.x, 0}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        h[8 + i][8 + j] += (8 * k * at[i] * at[j] / square - (i == j ? 2 * k : 0) -
                            2 * (by_a[i] * at[j] + at[i] * by_a[j]) / square) /
                           square;
        const double ab = (e[i][j] - 2 * at[i] * by_b[j] / square) / square;
        h[8 + i][11 + j] += ab;
        h[11 + j][8 + i] += ab;
      }
    }
  }

  Vec a, b;
  double square;
  Vec kappa;
};

Vec axis(const Frame& frame, int j) { return j == 0 ? frame.e1 : frame.e2; }

}  // namespace

void SplineTwist::gradient(const double* x, double (&g)[1][8]) const {
  const Knots knots(reference, x);
  const JointStrain joint(knots.side[0].frame, knots.side[1].frame);
  knots.side[0].pull_back(-1 * joint.twist, g[0]);
  knots.side[1].pull_back(joint.twist, g[0] + 4);
}

void SplineTwist::add_second(const double* x, const double* stress,
                             double (&h)[8][8]) const {
  const Knots knots(reference, x);
  const Frame &before = knots.side[0].frame, &behind = knots.side[1].frame;
  const JointStrain joint(before, behind);
  const TwoVectorForm form = joint.second(before, behind, {stress[0], 0, 0});
  for (int l = 0; l < 8; ++l) {
    double w[3];
    store3(knots.column(l), w);
    double of[6] = {};
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 3; ++j) of[i] += form.at(i, 3 * (l / 4) + j) * w[j];
    }
    for (int k = 0; k < 8; ++k) h[k][l] += dot(knots.column(k), load3(of + 3 * (k / 4)));
  }
  for (int side = 0; side < 2; ++side) {
    Pack block[4] = {};
    knots.side[side].turn.add_second(side == 0 ? -stress[0] : stress[0], joint.twist,
                                     block);
    add_block(block, 4 * side, h);
  }
}

void SplineBend::gradient(const double* x, double (&g)[2][14]) const {
  const Knots knots(reference, x);
  const Curvature point(x + 8);
  for (int j = 0; j < 2; ++j) {
    Vec mixed;
    for (int side = 0; side < 2; ++side) {
      const Vec e = (side == 0 ? 1 - part : part) * axis(knots.side[side].frame, j);
      knots.side[side].pull_back(cross(e, point.kappa), g[j] + 4 * side);
      mixed = mixed + e;
    }
    point.slope(mixed, g[j] + 8);
  }
}

/// A frame's axis e turned by w(dy) + Q(dy, dy)/2 is e + w x e + (Q x e + w x (w x
/// e))/2.
void SplineBend::add_second(const double* x, const double* stress,
                            double (&h)[14][14]) const {
  const Knots knots(reference, x);
  const Curvature point(x + 8);
  const Vec& kappa = point.kappa;
  Vec mixed;
  for (int side = 0; side < 2; ++side) {
    const Knot& knot = knots.side[side];
    const double weight = side == 0 ? 1 - part : part;
    const Vec e =
        (weight * stress[0]) * knot.frame.e1 + (weight * stress[1]) * knot.frame.e2;
    mixed = mixed + e;
    Pack block[4] = {};
    knot.turn.add_second(1, cross(e, kappa), block);
    Vec w[4];
    for (int k = 0; k < 4; ++k) w[k] = knot.turn.column(k);
    for (int k = 0; k < 4; ++k) {
      for (int l = 0; l < 4; ++l) {
        const double own =
            0.5 * (dot(w[k], e) * dot(w[l], kappa) + dot(w[l], e) * dot(w[k], kappa)) -
            dot(e, kappa) * dot(w[k], w[l]);
        block[k].set(l, block[k][l] + own);
      }
      double slope[6];
      point.slope(cross(w[k], e), slope);
      for (int i = 0; i < 6; ++i) {
        h[4 * side + k][8 + i] += slope[i];
        h[8 + i][4 * side + k] += slope[i];
      }
    }
    add_block(block, 4 * side, h);
  }
  point.add_second(mixed, h);
}

}  // namespace tress::models
