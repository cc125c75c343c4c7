#pragma once

#include "tests/support/tangent.h"

namespace tress::testing_support {

using namespace models;

/// M a - f where a is what a system's ComplianceForm says, over the largest part of M a:
/// nothing but rounding.
inline double compliance_error(System& system, ComplianceForm& form, const States& s) {
  std::vector<double> w(s.n), a(s.n), part(s.n), largest_part(s.n);
  form.inverse_mass(w);
  EXPECT_EQ(form.rest(t0, s.q, s.v, a), Status::ok);
  ComplianceForm::Value value;
  for (std::size_t k = 0; k < form.blocks().size(); ++k) {
    const ComplianceForm::Block& block = form.blocks()[k];
    std::vector<double> x;
    for (const int i : block.coordinates) x.push_back(s.q[static_cast<std::size_t>(i)]);
    form.evaluate(t0, k, x, value);
    for (std::size_t row = 0; row < static_cast<std::size_t>(block.rows); ++row) {
      double rate = value.drift[row];
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto at = static_cast<std::size_t>(block.coordinates[i]);
        rate += value.gradient[row][i] * s.v[at];
      }
      const double stress = value.c[row] / block.alpha[row] + block.friction[row] * rate;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto at = static_cast<std::size_t>(block.coordinates[i]);
        const double force = value.gradient[row][i] * stress;
        a[at] -= w[at] * force;
        largest_part[at] = std::max(largest_part[at], std::abs(force));
      }
    }
  }
  return largest(residual(system, s.q, s.v, a)) / largest(largest_part);
}

}  // namespace tress::testing_support
