#include "experiments/numerics/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/dense_form.h"
#include "simulation/files/row.h"
#include "simulation/run/simulation.h"

namespace tress::experiments {
namespace {

constexpr int loads = 8;            // number of gravity steps
constexpr double load_ratio = 3;    // gravity ratio of successive steps
constexpr double accuracy = 1e-10;  // of the typical sizes
constexpr int iterations = 100;

/// The largest correction of one Newton step, over the typical sizes.
double newton_step(System& system, std::vector<double>& q) {
  const std::size_t n = q.size();
  std::vector<double> r(n), q_typ(n), v_typ(n);
  const std::vector<double> zero(n);
  system.scale(q_typ, v_typ);
  Status s = system.residual(0, q, zero, zero, r);
  if (s == Status::ok) s = system.linearize(0, q, zero, zero, {0, 0, 1});
  if (s == Status::ok) s = system.solve(r, r);
  if (s != Status::ok) throw std::runtime_error("no static correction");
  double most = 0;
  for (std::size_t i = 0; i < n; ++i) {
    q[i] -= r[i];
    most = std::max(most, std::abs(r[i]) / q_typ[i]);
  }
  return most;
}

}  // namespace

AtRest at_rest(const ModelEntry& model, const Parameters& parameters) {
  const double gravity = parameters.number("gravity_m_s2");
  AtRest rest;
  for (int load = loads; load-- > 0;) {
    Parameters p = parameters;
    Row digits;
    digits.set("g", gravity * std::pow(load_ratio, -load));
    p.set("gravity_m_s2", digits.text("g"));
    rest.system = model.make(p);
    if (rest.q.empty()) rest.q = initial_state(*rest.system).q;
    double correction = std::numeric_limits<double>::infinity();
    for (int i = 0; i < iterations && correction > accuracy; ++i) {
      correction = newton_step(*rest.system, rest.q);
    }
    if (!(correction <= accuracy)) throw std::runtime_error("no equilibrium");
  }
  return rest;
}

LinearModes linear_modes(System& system, In q) {
  const Eigen::MatrixXd mass = dense_mass(system, 0, q);
  const Eigen::MatrixXd stiffness = dense_stiffness(system, 0, q);
  const Eigen::MatrixXd dynamics = solution(mass, stiffness);
  LinearModes modes;
  modes.slowest_rad_s = std::numeric_limits<double>::infinity();
  // A double real eigenvalue is computed as a pair sqrt(eps) apart.
  constexpr double real = 1e-7;
  for (const std::complex<double> square : eigenvalues(dynamics)) {
    const std::complex<double> s = std::sqrt(-square);
    modes.slowest_rad_s = std::min(modes.slowest_rad_s, std::abs(s));
    if (std::abs(square.imag()) > real * std::abs(square)) ++modes.complex_modes;
    if (std::abs(s.real()) > real * std::abs(s)) {
      modes.growth_per_s = std::max(modes.growth_per_s, std::abs(s.real()));
    }
  }
  return modes;
}

}  // namespace tress::experiments
