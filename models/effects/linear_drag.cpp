#include "models/effects/linear_drag.h"

#include <cmath>

#include "models/input_error.h"
#include "models/math/vec3.h"

namespace tress {
namespace {

bool finite_and_not_negative(double x) { return std::isfinite(x) && x >= 0; }

}  // namespace

LinearDrag::LinearDrag(double nu, double mass_damping)
    : nu_(nu), mass_damping_(mass_damping) {
  if (!finite_and_not_negative(nu) || !finite_and_not_negative(mass_damping)) {
    throw InputError("drag coefficient is negative or not finite", "effect linear_drag",
                     "give nu >= 0 in kg/(m s) and mass damping >= 0 in 1/s");
  }
}

void LinearDrag::add_load(double, const Points& p, InOut f) const noexcept {
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    double* load = &f[3 * i];
    store3(load3(load) - rate(p, i) * load3(&p.v[3 * i]), load);
  }
}

void LinearDrag::add_derivatives(double, const Points& p, double, double vel,
                                 InOut blocks) const noexcept {
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    const double slope = -vel * rate(p, i);
    double* block = &blocks[9 * i];
    block[0] += slope;
    block[4] += slope;
    block[8] += slope;
  }
}

double LinearDrag::power(double, const Points& p) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < p.length.size(); ++i) {
    const Vec v = load3(&p.v[3 * i]);
    sum -= rate(p, i) * dot(v, v);
  }
  return sum;
}

}  // namespace tress
