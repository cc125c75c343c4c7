#include "integrators/sundials/dae_newton.h"

#include <algorithm>
#include <cmath>

namespace tress::integrators {
namespace {

/// Regularisation added to the diagonal of the multipliers when constraints are
/// redundant. The Schur complement G G^T is of order one in the scaled matrix. The
/// corrections of q and v keep eight digits, those of the multipliers have minimum norm.
constexpr double regularisation = 1e-8;

}  // namespace

EliminatedNewton::EliminatedNewton(DaeForm& form) : form_(form) {
  for (auto* x : {&q_, &v_, &a_, &dq_, &zero_, &r_}) x->resize(form.n);
}

Status EliminatedNewton::factor(double t, In y, In y_dot, double cj) noexcept {
  t_ = t;
  cj_ = cj;
  std::ranges::copy(y.first(form_.n), q_.begin());
  std::ranges::copy(y.last(form_.n), v_.begin());
  std::ranges::copy(y_dot.last(form_.n), a_.begin());
  base_ = Dynamics::Base::fresh;
  return form_.dynamics.linearize(t, q_, v_, a_, {}, {1, 1 / cj, 1 / (cj * cj)});
}

Status EliminatedNewton::solve(InOut b) noexcept {
  const InOut x_q = b.first(form_.n), x_v = b.last(form_.n);
  for (std::size_t i = 0; i < form_.n; ++i) dq_[i] = x_q[i] / cj_;
  Status s = form_.dynamics.directional(t_, q_, v_, a_, {}, dq_, zero_, r_, {}, base_);
  if (s != Status::ok) return s;
  base_ = Dynamics::Base::kept;
  for (std::size_t i = 0; i < form_.n; ++i) r_[i] = x_v[i] - r_[i];
  if (s = form_.dynamics.solve(r_, {}); s != Status::ok) return s;
  for (std::size_t i = 0; i < form_.n; ++i) {
    x_v[i] = r_[i] / cj_;
    x_q[i] = dq_[i] + x_v[i] / cj_;
  }
  return Status::ok;
}

AssembledNewton::AssembledNewton(DaeForm& form, const Options& options)
    : form_(form),
      alpha_(options.formulation == Formulation::baumgarte ? options.alpha : 0),
      beta_(options.formulation == Formulation::baumgarte ? options.beta : 0),
      matrix_(static_cast<int>(2 * form.n) +
                  DaeForm::multipliers(form.dynamics.system(), form.formulation),
              static_cast<int>(2 * form.n) +
                  DaeForm::multipliers(form.dynamics.system(), form.formulation)) {
  const int n = form.dynamics.n(), m = form.dynamics.m();
  const int lambda = 2 * n, mu = 2 * n + m;
  const Pattern& s = form.sparse->pattern();
  const Pattern& gt = form.dynamics.constraints()->pattern();
  q_unit_ = matrix_.add_block(identity_pattern(n), 0, 0);
  qv_unit_ = matrix_.add_block(identity_pattern(n), 0, n);
  vq_ = matrix_.add_block(s, n, 0);
  vv_ = matrix_.add_block(s, n, n);
  v_lambda_ = matrix_.add_block(gt, n, lambda);
  lambda_q_ = matrix_.add_block(gt, lambda, 0, true);
  if (form.formulation != Formulation::index3) {
    lambda_v_ = matrix_.add_block(gt, lambda, n, true);
  }
  if (form.formulation == Formulation::index2_ggl) {
    qq_ = matrix_.add_block(s, 0, 0);
    q_mu_ = matrix_.add_block(gt, 0, mu);
    mu_q_ = matrix_.add_block(gt, mu, 0, true);
  }
  const int multipliers = DaeForm::multipliers(form.dynamics.system(), form.formulation);
  multiplier_diagonal_ = matrix_.add_block(identity_pattern(multipliers), lambda, lambda);
  shift_.assign(static_cast<std::size_t>(multipliers), regularisation);
  matrix_.finish();
  solver_ = make_linear_solver(options.linear, matrix_.pattern());
  s_.resize(static_cast<std::size_t>(s.nonzeros()));
  gt_.resize(static_cast<std::size_t>(gt.nonzeros()));
  rate_gt_.resize(gt_.size());
  ones_.assign(form.n, 1.0);
}

Status AssembledNewton::factor(double t, In y, In y_dot, double cj) noexcept {
  ++factors_;
  cj_ = cj;
  matrix_.clear();
  if (const Status s = add_motion(t, y, y_dot); s != Status::ok) return s;
  if (const Status s = add_constraints(t, y, y_dot); s != Status::ok) return s;
  if (rank_deficiency_ > 0 && has_redundant_constraints()) {
    matrix_.add(multiplier_diagonal_, 1, shift_);
  }
  Status s = solver_->factor(matrix_.values());
  const bool suspicious = s == Status::retry || solver_->condition() > suspicious_;
  if (suspicious && rank_deficiency_ == 0 && has_redundant_constraints()) {
    matrix_.add(multiplier_diagonal_, 1, shift_);
    s = solver_->factor(matrix_.values());
  }
  if (s != Status::ok) return s;
  const double condition = solver_->condition();
  condition_ = std::max(condition_, condition);
  // Independent constraints at a high condition: check again when it is much higher.
  if (suspicious) suspicious_ = std::max(suspicious_, 100 * condition);
  return s;
}

/// Expects gt_ at the state of factor(). Allocates; called when a matrix was singular.
bool AssembledNewton::has_redundant_constraints() {
  const std::vector<double> unit(form_.m, 1.0);
  const Pattern& pattern = form_.dynamics.constraints()->pattern();
  null_space_ = std::make_unique<NullSpace>(pattern, gt_, ones_, unit);
  rank_deficiency_ = std::max(rank_deficiency_, null_space_->dimension());
  return null_space_->dimension() > 0;
}

/// Removes the null-space component due to redundant constraints from the rows or entries
/// of the multipliers: rounding there would be amplified by 1/`regularisation`.
void AssembledNewton::project_multipliers(InOut b) const {
  if (rank_deficiency_ == 0) return;
  for (std::size_t at = 2 * form_.n; at < b.size(); at += form_.m) {
    null_space_->project_out(b.subspan(at, form_.m));
  }
}

/// The first two rows.
Status AssembledNewton::add_motion(double t, In y, In y_dot) noexcept {
  const auto [q, v, lambda, mu] = form_.parts(y);
  const In a = y_dot.subspan(form_.n, form_.n);
  ConstraintForm& constraints = *form_.dynamics.constraints();
  Status s = form_.sparse->values(t, q, v, a, {cj_, 1, 0}, s_);
  if (s != Status::ok) return s;
  double largest = 0;
  for (const double entry : s_) largest = std::max(largest, std::abs(entry));
  if (!(largest > 0)) return Status::retry;
  mass_unit_ = largest / cj_;
  const double row = 1 / (cj_ * mass_unit_);
  matrix_.add(vv_, row, s_);
  if (s = form_.sparse->values(t, q, v, a, {0, 0, 1}, s_); s != Status::ok) return s;
  if (s = constraints.add_curvature(t, q, lambda, -1, s_); s != Status::ok) return s;
  matrix_.add(vq_, row / cj_, s_);
  matrix_.add(q_unit_, 1, ones_);
  matrix_.add(qv_unit_, -1, ones_);
  if (s = constraints.gradient(t, q, gt_); s != Status::ok) return s;
  matrix_.add(v_lambda_, -1, gt_);
  if (mu.empty()) return Status::ok;
  std::ranges::fill(s_, 0.0);
  if (s = constraints.add_curvature(t, q, mu, -1, s_); s != Status::ok) return s;
  matrix_.add(qq_, 1 / cj_, s_);
  matrix_.add(q_mu_, -1, gt_);
  return Status::ok;
}

/// The rows of the multipliers; expects gt_ at (t, q).
Status AssembledNewton::add_constraints(double t, In y, In y_dot) noexcept {
  const auto [q, v, lambda, mu] = form_.parts(y);
  ConstraintForm& constraints = *form_.dynamics.constraints();
  if (form_.formulation == Formulation::index3) {
    matrix_.add(lambda_q_, 1, gt_);
    return Status::ok;
  }
  Status s = constraints.rate_gradient(t, q, v, rate_gt_);
  if (s != Status::ok) return s;
  if (form_.formulation == Formulation::index2_ggl) {
    matrix_.add(lambda_q_, 1 / cj_, rate_gt_);
    matrix_.add(lambda_v_, 1, gt_);
    matrix_.add(mu_q_, 1, gt_);
    return Status::ok;
  }
  const double square = cj_ * cj_;
  matrix_.add(lambda_v_, 1 + beta_ / cj_, gt_);
  matrix_.add(lambda_v_, 2 / cj_, rate_gt_);
  matrix_.add(lambda_q_, alpha_ / square, gt_);
  matrix_.add(lambda_q_, beta_ / square, rate_gt_);
  s = constraints.rate_gradient(t, q, y_dot.subspan(form_.n, form_.n), rate_gt_);
  matrix_.add(lambda_q_, 1 / square, rate_gt_);
  return s;
}

Status AssembledNewton::solve(InOut b) noexcept {
  ++solves_;
  project_multipliers(b);
  const std::size_t n = form_.n, m = form_.m;
  const bool ggl = form_.formulation == Formulation::index2_ggl;
  const double force = cj_ * mass_unit_;
  const double row = form_.formulation == Formulation::index3 ? cj_ : ggl ? 1 : 1 / cj_;
  const auto scale = [](InOut part, double factor) {
    for (double& entry : part) entry *= factor;
  };
  scale(b.subspan(n, n), 1 / force);
  scale(b.subspan(2 * n, m), row);
  if (ggl) scale(b.last(m), cj_);
  const Status s = solver_->solve(b);
  project_multipliers(b);
  scale(b.first(n), 1 / cj_);
  scale(b.subspan(2 * n, m), force);
  return s;
}

Stats AssembledNewton::work() const {
  Stats all = form_.dynamics.stats;
  all.linearizations += factors_;
  all.solves += solves_;
  all.solver = solver_->name();
  all.rank_deficiency = std::max(all.rank_deficiency, rank_deficiency_);
  all.condition = std::max(all.condition, condition_);
  return all;
}

}  // namespace tress::integrators
