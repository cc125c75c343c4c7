#pragma once

#include <cstdio>

#include "contract/forms/constraint_form.h"
#include "contract/forms/material_points.h"
#include "contract/forms/sparse_form.h"
#include "linear/kkt.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

using namespace simulation;

/// A number as a parameter takes it, all digits kept.
inline std::string text(double x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.17g", x);
  return digits;
}

/// A strand at rest under gravity.
struct Hung {
  std::unique_ptr<System> system;
  std::vector<double> q;
};

/// x = Newton's correction of q (to be subtracted) for r = G^T lambda, g = 0 at v = a =
/// 0; with constraints lambda takes its new value: S x + G^T lambda = r, G x = g.
inline void static_correction(System& system, In q, std::vector<double>& lambda, Out x) {
  const std::vector<double> zero = zeros(system);
  EXPECT_EQ(system.residual(0, q, zero, zero, x), Status::ok);
  ConstraintForm* constraints = system.constraint_form();
  if (constraints == nullptr) {
    EXPECT_EQ(system.linearize(0, q, zero, zero, {0, 0, 1}), Status::ok);
    EXPECT_EQ(system.solve(x, x), Status::ok);
    return;
  }
  SparseForm& form = *system.sparse_form();
  std::vector<double> s(static_cast<std::size_t>(form.pattern().nonzeros()));
  std::vector<double> g(static_cast<std::size_t>(constraints->pattern().nonzeros()));
  lambda.resize(static_cast<std::size_t>(system.layout().constraints));
  EXPECT_EQ(form.values(0, q, zero, zero, {0, 0, 1}, s), Status::ok);
  EXPECT_EQ(constraints->add_curvature(0, q, lambda, -1, s), Status::ok);
  EXPECT_EQ(constraints->gradient(0, q, g), Status::ok);
  EXPECT_EQ(constraints->value(0, q, lambda), Status::ok);
  Kkt kkt(LinearKind::automatic, form.pattern(), constraints->pattern());
  EXPECT_EQ(kkt.factor(s, g, g), Status::ok);
  EXPECT_EQ(kkt.solve(x, lambda), Status::ok);
  for (double& of_row : lambda) of_row = -of_row;
}

/// Newton on residual(v = a = 0), gravity raised by a factor of `growth` at a time up to
/// `g`, until corrections are `accuracy` of the typical sizes.
inline Hung hang(std::string_view model, const ModelSettings& settings, double g,
                 double accuracy = 1e-11, double growth = 3) {
  Hung hung;
  std::vector<double> lambda;
  const int loads = static_cast<int>(std::ceil(8 * std::log(3.0) / std::log(growth)));
  for (int load = loads; load-- > 0;) {
    const double now = g * std::pow(growth, -load);
    hung.system = make_model(model, with(settings, {{"gravity_m_s2", text(now)}}));
    System& system = *hung.system;
    const std::vector<double> zero = zeros(system);
    if (hung.q.empty()) {
      std::vector<double> v = zero;
      hung.q = zero;
      system.initial_state(hung.q, v);
    }
    std::vector<double> q_typ = zero, v_typ = zero, r = zero;
    system.scale(q_typ, v_typ);
    double correction = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 100 && correction > accuracy; ++i) {
      static_correction(system, hung.q, lambda, r);
      correction = 0;
      for (std::size_t k = 0; k < r.size(); ++k) {
        hung.q[k] -= r[k];
        correction = std::max(correction, std::abs(r[k]) / q_typ[k]);
      }
    }
    EXPECT_LE(correction, accuracy) << "no equilibrium at " << now << " m/s^2";
  }
  return hung;
}

/// Of the root and of the tips of all segments, 3 each.
inline std::vector<double> points(const Hung& hung) {
  MaterialPoints& at = *hung.system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(at.count()));
  at.positions(0, hung.q, x);
  return x;
}

}  // namespace tress::testing_support
