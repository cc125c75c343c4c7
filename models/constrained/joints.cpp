#include "models/constrained/joints.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace tress::models {

void Coincidence::gradient(const double*, double* g) const {
  std::fill_n(g, 9, 0.0);
  g[0] = g[4] = g[8] = 1;
}

void Coincidence::hessian(const double*, const double*, double* h) const {
  std::fill_n(h, 9, 0.0);
}

void FixedDistance::gradient(const double* d, double* g) const {
  for (int i = 0; i < 3; ++i) g[i] = d[i] / length;
}

void FixedDistance::hessian(const double*, const double* w, double* h) const {
  std::fill_n(h, 9, 0.0);
  h[0] = h[4] = h[8] = w[0] / length;
}

void OnPlane::gradient(const double*, double* g) const { store3(normal, g); }

void OnPlane::hessian(const double*, const double*, double* h) const {
  std::fill_n(h, 9, 0.0);
}

void Across::gradient(const double* z, double* g) const {
  for (int i = 0; i < 3; ++i) {
    g[i] = (z[6 + i] - z[3 + i]) / length;
    g[6 + i] = (z[i] - z[3 + i]) / length;
    g[3 + i] = -g[i] - g[6 + i];
  }
}

void Across::hessian(const double*, const double* w, double* h) const {
  // Of x . c - x . b - b . c + b . b, node by node.
  constexpr double of[3][3] = {{0, -1, 1}, {-1, 2, -1}, {1, -1, 0}};
  std::fill_n(h, 81, 0.0);
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      for (int i = 0; i < 3; ++i)
        h[9 * (3 * k + i) + 3 * l + i] = w[0] / length * of[k][l];
    }
  }
}

std::unique_ptr<Constraint> fixed_point(Node x, Node where) {
  using Kernel = Difference<Coincidence>;
  return std::make_unique<Module<Kernel>>(std::array{x, where}, Kernel{});
}

std::unique_ptr<Constraint> distance(Node a, Node b, double length) {
  if (!std::isfinite(length) || length <= 0) {
    throw InputError("length is not a positive number", "constraint distance",
                     "give a length > 0 in m");
  }
  using Kernel = Difference<FixedDistance>;
  return std::make_unique<Module<Kernel>>(std::array{a, b}, Kernel{{length}});
}

std::unique_ptr<Constraint> across(Node x, Node vertex, Node c, double length) {
  if (!std::isfinite(length) || length <= 0) {
    throw InputError("length is not a positive number", "constraint across",
                     "give a length > 0 in m");
  }
  return std::make_unique<Module<Across>>(std::array{x, vertex, c}, Across{length});
}

std::unique_ptr<Constraint> point_on_plane(Node x, Node origin, Vec normal) {
  const double size = norm(normal);
  if (!std::isfinite(size) || size == 0) {
    throw InputError("normal has no direction", "constraint point_on_plane",
                     "give three finite numbers, not all zero");
  }
  using Kernel = Difference<OnPlane>;
  return std::make_unique<Module<Kernel>>(std::array{x, origin},
                                          Kernel{{(1 / size) * normal}});
}

}  // namespace tress::models
