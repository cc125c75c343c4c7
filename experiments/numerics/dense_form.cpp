#include "experiments/numerics/dense_form.h"

#include <stdexcept>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/forms/sparse_form.h"
#include "linear/sparse_pattern.h"

namespace tress::experiments {
namespace {

void require(Status s) {
  if (s != Status::ok) throw std::runtime_error("the residual cannot be evaluated");
}

Eigen::MatrixXd dense(const Pattern& pattern, In values) {
  Eigen::MatrixXd all(pattern.rows, pattern.cols);
  to_dense(pattern, values, {all.data(), static_cast<std::size_t>(all.size())});
  return all;
}

/// Uses the sparse form if the system has one, else differences of the residual.
Eigen::MatrixXd tangent_at_rest(System& system, double t, In q, Weights w) {
  const std::vector<double> zero(q.size());
  if (SparseForm* form = system.sparse_form(); form != nullptr) {
    std::vector<double> values(static_cast<std::size_t>(form->pattern().nonzeros()));
    require(form->values(t, q, zero, zero, w, values));
    return dense(form->pattern(), values);
  }
  return tangent_of_residual(system, {t, {q.begin(), q.end()}, zero, zero}, w);
}

}  // namespace

Eigen::MatrixXd tangent_of_residual(System& system, const Instant& at, Weights w) {
  const std::size_t n = at.q.size();
  const auto size = static_cast<Eigen::Index>(n);
  Instant moved = at;
  Eigen::VectorXd ahead(size), behind(size);
  const auto evaluate = [&](Eigen::VectorXd& r) {
    require(system.residual(at.t, moved.q, moved.v, moved.a, {r.data(), n}));
  };
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](double weight, std::vector<double>& x, In step) {
    if (weight == 0) return;
    for (std::size_t j = 0; j < n; ++j) {
      const double value = x[j];
      x[j] = value + step[j];
      evaluate(ahead);
      x[j] = value - step[j];
      evaluate(behind);
      x[j] = value;
      all.col(static_cast<Eigen::Index>(j)) += weight / (2 * step[j]) * (ahead - behind);
    }
  };
  std::vector<double> q_step(n), v_step(n), a_step(n);
  system.scale(q_step, v_step);
  constexpr double relative = 6e-6;  // differences of order 2: eps^(1/3)
  for (std::size_t j = 0; j < n; ++j) {
    a_step[j] = v_step[j] * v_step[j] / q_step[j];
    q_step[j] *= relative;
    v_step[j] *= relative;
  }
  add(w.acc, moved.a, a_step);
  add(w.vel, moved.v, v_step);
  add(w.pos, moved.q, q_step);
  return all;
}

Eigen::MatrixXd dense_mass(System& system, double t, In q) {
  return tangent_at_rest(system, t, q, {1, 0, 0});
}

Eigen::MatrixXd dense_stiffness(System& system, double t, In q) {
  return tangent_at_rest(system, t, q, {0, 0, 1});
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
