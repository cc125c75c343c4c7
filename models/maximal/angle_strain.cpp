#include "models/maximal/angle_strain.h"

namespace tress::models {

double BendAngle::gradient(const Vec* e, Vec* g) const {
  const double h = Hinge{}.gradient(e, g);
  const double slope = 1 / (1 + h * h / 4);
  for (int k = 0; k < 2; ++k) g[k] = slope * g[k];
  return 2 * std::atan2(h, 2.0);
}

void BendAngle::hessian(const Vec* e, EdgeMatrix<2>& of_angle) const {
  Vec g[2];
  EdgeMatrix<2> of_hinge;
  const double h = Hinge{}.gradient(e, g);
  Hinge{}.hessian(e, of_hinge);
  const double slope = 1 / (1 + h * h / 4);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) of_angle.m[i][j] += slope * of_hinge.m[i][j];
  }
  of_angle.add_product(-h / 2 * slope * slope, g, g);
}

namespace {

/// x^2/(x^2 + floor) of the cross product x of edges first and first + 1.
struct Weight {
  Weight(const Vec* e, int first_edge, double floor)
      : first(first_edge),
        x(cross(e[first], e[first + 1])),
        square(dot(x, x)),
        value(square / (square + floor)),
        by_square(floor / ((square + floor) * (square + floor))),
        twice_by_square(-2 * by_square / (square + floor)) {
    of_square[first] = 2.0 * cross(e[first + 1], x);
    of_square[first + 1] = 2.0 * cross(x, e[first]);
    for (int k = 0; k < 3; ++k) slope[k] = by_square * of_square[k];
  }

  /// h += factor d^2 value/de^2.
  void add_second(const Vec* e, double factor, EdgeMatrix<3>& h) const {
    h.add_product(factor * twice_by_square, of_square, of_square);
    const double by = factor * by_square;
    const double along = dot(e[first], e[first + 1]);
    for (int i = first; i < first + 2; ++i) {
      const int j = 2 * first + 1 - i;
      h.add_identity(i, i, 2 * by * dot(e[j], e[j]));
      h.add_outer(i, i, -2 * by, e[j], e[j]);
      h.add_identity(i, j, -2 * by * along);
      h.add_outer(i, j, 4 * by, e[i], e[j]);
      h.add_outer(i, j, -2 * by, e[j], e[i]);
    }
  }

  int first;
  Vec x;
  double square, value, by_square, twice_by_square;
  Vec of_square[3] = {{}, {}, {}}, slope[3];
};

/// The angle, its slopes and what its second derivatives are made of. A product that is
/// exactly zero has no slopes.
struct DihedralParts {
  DihedralParts(const Vec* e, const Dihedral& strain)
      : m(e, 0, strain.floor0),
        n(e, 1, strain.floor1),
        b(std::sqrt(dot(e[1], e[1]))),
        along0(dot(e[0], e[1]) / b),
        along2(dot(e[2], e[1]) / b),
        inverse_m(m.square > 0 ? 1 / m.square : 0),
        inverse_n(n.square > 0 ? 1 / n.square : 0) {
    const double sine = b * dot(e[0], n.x), cosine = dot(m.x, n.x);
    const double c = std::cos(strain.rest), s = std::sin(strain.rest);
    angle = std::atan2(c * sine - s * cosine, c * cosine + s * sine);
    slope[0] = b * inverse_m * m.x;
    slope[1] = -along0 * inverse_m * m.x - along2 * inverse_n * n.x;
    slope[2] = b * inverse_n * n.x;
  }

  /// h += factor d^2 angle/de^2. The slopes rotate with m and n, whose part across
  /// themselves is d m/m^2 reflected at m.
  void add_second(const Vec* e, double factor, EdgeMatrix<3>& h) const {
    const auto both = [&](int i, int j, double by, const Vec& x, const Vec& y) {
      h.add_outer(i, j, factor * by, x, y);
      h.add_outer(j, i, factor * by, y, x);
    };
    const Vec m_by_a = cross(m.x, e[0]), n_by_c = cross(n.x, e[2]);
    const double m4 = inverse_m * inverse_m, n4 = inverse_n * inverse_n;
    both(0, 0, b * m4, m.x, cross(m.x, e[1]));
    both(0, 1, inverse_m / b, m.x, e[1]);
    both(0, 1, -b * m4, m.x, m_by_a);
    both(0, 1, -b * m4, m_by_a, m.x);
    both(2, 2, -b * n4, n.x, cross(n.x, e[1]));
    both(2, 1, inverse_n / b, n.x, e[1]);
    both(2, 1, b * n4, n.x, n_by_c);
    both(2, 1, b * n4, n_by_c, n.x);
    const Vec across0 = e[0] - (along0 / b) * e[1], across2 = e[2] - (along2 / b) * e[1];
    both(1, 1, -inverse_m / (2 * b), m.x, across0);
    both(1, 1, -inverse_n / (2 * b), n.x, across2);
    both(1, 1, along0 * m4, m.x, m_by_a);
    both(1, 1, -along2 * n4, n.x, n_by_c);
  }

  Weight m, n;
  double b, along0, along2, inverse_m, inverse_n, angle = 0;
  Vec slope[3];
};

}  // namespace

double Dihedral::gradient(const Vec* e, Vec* g) const {
  const DihedralParts p(e, *this);
  const double weight = p.m.value * p.n.value;
  for (int k = 0; k < 3; ++k) {
    g[k] = weight * p.slope[k] +
           p.angle * (p.n.value * p.m.slope[k] + p.m.value * p.n.slope[k]);
  }
  return p.angle * weight;
}

void Dihedral::hessian(const Vec* e, EdgeMatrix<3>& h) const {
  const DihedralParts p(e, *this);
  p.add_second(e, p.m.value * p.n.value, h);
  h.add_product(2 * p.n.value, p.slope, p.m.slope);
  h.add_product(2 * p.m.value, p.slope, p.n.slope);
  h.add_product(2 * p.angle, p.m.slope, p.n.slope);
  p.m.add_second(e, p.angle * p.n.value, h);
  p.n.add_second(e, p.angle * p.m.value, h);
}

double WallDihedral::gradient(const Vec* e, Vec* g) const {
  const Vec all[3] = {wall, e[0], e[1]};
  Vec of_all[3];
  const double s = dihedral.gradient(all, of_all);
  g[0] = of_all[1];
  g[1] = of_all[2];
  return s;
}

void WallDihedral::hessian(const Vec* e, EdgeMatrix<2>& h) const {
  const Vec all[3] = {wall, e[0], e[1]};
  EdgeMatrix<3> of_all;
  dihedral.hessian(all, of_all);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) h.m[i][j] += of_all.m[3 + i][3 + j];
  }
}

}  // namespace tress::models
