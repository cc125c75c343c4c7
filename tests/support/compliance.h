#pragma once

#include "contract/forms/compliance_form.h"
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

/// Second derivatives of a ComplianceForm against differences of its gradients, over the
/// largest of their block, every coordinate in its typical size; -1 if there are none.
inline double second_error(System& system, ComplianceForm& form, const States& s) {
  constexpr double apart = 1e-6;  // of the typical size
  std::vector<double> q_typ(s.n), v_typ(s.n);
  system.scale(q_typ, v_typ);
  const double stress[ComplianceForm::most_rows] = {1, -0.7, 0.4, 1.3, -0.2};
  double most = -1;
  for (std::size_t k = 0; k < form.blocks().size(); ++k) {
    const ComplianceForm::Block& block = form.blocks()[k];
    std::vector<double> x, size;
    for (const int i : block.coordinates) {
      x.push_back(s.q[static_cast<std::size_t>(i)]);
      size.push_back(q_typ[static_cast<std::size_t>(i)]);
    }
    ComplianceForm::Second second = {};
    const std::span rows(stress, static_cast<std::size_t>(block.rows));
    if (!form.add_second(t0, k, x, rows, second)) return -1;
    double largest_entry = 0, error = 0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      ComplianceForm::Value ahead, behind;
      std::vector<double> moved = x;
      moved[j] = x[j] + apart * size[j];
      form.evaluate(t0, k, moved, ahead);
      moved[j] = x[j] - apart * size[j];
      form.evaluate(t0, k, moved, behind);
      for (std::size_t i = 0; i < x.size(); ++i) {
        double difference = 0;
        for (std::size_t r = 0; r < rows.size(); ++r) {
          difference += rows[r] * (ahead.gradient[r][i] - behind.gradient[r][i]);
        }
        difference *= size[i] / (2 * apart);
        largest_entry = std::max(largest_entry, std::abs(difference));
        error = std::max(error, std::abs(difference - second[i][j] * size[i] * size[j]));
      }
    }
    if (largest_entry > 0) most = std::max(most, error / largest_entry);
  }
  return most;
}

}  // namespace tress::testing_support
