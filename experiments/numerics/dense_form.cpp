#include "experiments/numerics/dense_form.h"

#include <stdexcept>
#include <vector>

namespace tress::experiments {
namespace {

void require(Status s) {
  if (s != Status::ok) throw std::runtime_error("no residual at a state of rest");
}

Eigen::VectorXd residual(System& system, double t, In q, In a) {
  const std::vector<double> zero(q.size());
  Eigen::VectorXd r(static_cast<Eigen::Index>(q.size()));
  require(system.residual(t, q, zero, a, {r.data(), q.size()}));
  return r;
}

Eigen::MatrixXd dense(const Pattern& p, In values) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(p.rows, p.cols);
  for (int j = 0; j < p.cols; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int k = p.start[column]; k < p.start[column + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      all(p.row[at], j) = values[at];
    }
  }
  return all;
}

Eigen::MatrixXd dense_values(System& system, double t, In q, Weights w) {
  SparseForm& form = *system.sparse_form();
  const std::vector<double> zero(q.size());
  std::vector<double> values(static_cast<std::size_t>(form.pattern().nonzeros()));
  require(form.values(t, q, zero, zero, w, values));
  return dense(form.pattern(), values);
}

}  // namespace

Eigen::MatrixXd dense_mass(System& system, double t, In q) {
  if (system.sparse_form() != nullptr) return dense_values(system, t, q, {1, 0, 0});
  std::vector<double> a(q.size());
  const Eigen::VectorXd forces = residual(system, t, q, a);
  Eigen::MatrixXd mass(forces.size(), forces.size());
  for (Eigen::Index j = 0; j < mass.cols(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    a[at] = 1;
    mass.col(j) = residual(system, t, q, a) - forces;
    a[at] = 0;
  }
  return mass;
}

Eigen::MatrixXd dense_stiffness(System& system, double t, In q) {
  if (system.sparse_form() != nullptr) return dense_values(system, t, q, {0, 0, 1});
  const std::size_t n = q.size();
  std::vector<double> q_typ(n), v_typ(n), moved(q.begin(), q.end());
  const std::vector<double> zero(n);
  system.scale(q_typ, v_typ);
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd stiffness(size, size);
  constexpr double step = 6e-6;  // differences of order 2: eps^(1/3)
  for (std::size_t j = 0; j < n; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const double e = step * q_typ[j];
    moved[j] = q[j] + e;
    stiffness.col(column) = residual(system, t, moved, zero);
    moved[j] = q[j] - e;
    stiffness.col(column) -= residual(system, t, moved, zero);
    stiffness.col(column) /= 2 * e;
    moved[j] = q[j];
  }
  return stiffness;
}

Eigen::MatrixXd dense_gradient(System& system, double t, In q) {
  const Layout layout = system.layout();
  if (layout.constraints == 0) return Eigen::MatrixXd::Zero(layout.coordinates, 0);
  ConstraintForm& form = *system.constraint_form();
  std::vector<double> values(static_cast<std::size_t>(form.pattern().nonzeros()));
  require(form.gradient(t, q, values));
  return dense(form.pattern(), values);
}

Eigen::MatrixXd dense_curvature(System& system, double t, In q, In lambda) {
  const Pattern& pattern = system.sparse_form()->pattern();
  std::vector<double> values(static_cast<std::size_t>(pattern.nonzeros()));
  require(system.constraint_form()->add_curvature(t, q, lambda, 1, values));
  return dense(pattern, values);
}

}  // namespace tress::experiments
