#include "models/supports/supported_system.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "contract/input_error.h"
#include "linear/dense_algebra.h"
#include "linear/vector_ops.h"
#include "models/supports/kinetic_rate.h"

namespace tress::models {

SupportedSystem::SupportedSystem(std::unique_ptr<System> strand,
                                 std::vector<Support> supports, StrandDrives drives)
    : strand_(std::move(strand)),
      rows_(*strand_, std::move(supports)),
      loaded_(strand_->sparse_form() == nullptr ? loaded_tangent(*strand_) : nullptr),
      drives_{{}, std::move(drives.natural)},
      forces_(*strand_, rows_.supports(), std::move(drives.moments), drives_.natural),
      strains_(natural_strains(*strand_)) {
  refuse_if(strand_->contact_form() != nullptr,
            "supports or moments of a strand with exact contact: the response of "
            "contacts to their forces leaves these out",
            rows_.supports().empty() ? "moment 0" : "support 0",
            "use friction_law = \"regularised\" for bodies");
  refuse_if(drives_.natural.any() && strains_ == nullptr,
            "the model lacks a natural strain for each direction in which it bends",
            "natural shape", "use a model such as \"super_helix\" or \"der\"");
  if (forces_.any() && loaded_ == nullptr) {
    of_strand();
    assembled_.emplace(static_cast<SparseForm&>(*this));
  }
  const auto n = static_cast<std::size_t>(strand_->layout().coordinates);
  std::vector<double> q_typ(n);
  for (auto* x : {&acceleration_, &zero_, &v_typ_}) x->assign(n, 0.0);
  strand_->scale(q_typ, v_typ_);
  short_time_ = strand_->traits().regular_mass ? 0 : 1;
  for (std::size_t i = 0; i < n && short_time_ > 0; ++i) {
    short_time_ = std::min(short_time_, 1e-4 * q_typ[i] / v_typ_[i]);
  }
  gradient_.resize(static_cast<std::size_t>(rows_.pattern().nonzeros()));
  bias_.resize(static_cast<std::size_t>(rows_.rows()));
}

SparseForm& SupportedSystem::of_strand() {
  if (SparseForm* const form = strand_->sparse_form()) return *form;
  if (!dense_) dense_.emplace(*strand_);
  return *dense_;
}

void SupportedSystem::begin_at(In q, In v) {
  begin_q_.assign(q.begin(), q.end());
  begin_v_.assign(v.begin(), v.end());
  if (History* const past = strand_->history()) begin_memory_ = past->memory();
}

bool SupportedSystem::begins_elsewhere() const {
  std::vector<double> q(begin_q_.size()), v(q.size());
  if (!q.empty()) strand_->initial_state(q, v);
  return q != begin_q_;
}

void SupportedSystem::initial_state(Out q, Out v) const {
  if (begin_q_.empty()) return strand_->initial_state(q, v);
  std::ranges::copy(begin_q_, q.begin());
  std::ranges::copy(begin_v_, v.begin());
}

void SupportedSystem::reset() {
  strand_->history()->reset();
  if (!begin_memory_.empty()) strand_->history()->recall(begin_memory_);
}

double SupportedSystem::next_breakpoint(double t) const {
  double next = strand_->next_breakpoint(t);
  for (const Support& support : rows_.supports()) {
    next = std::min(next, support.path.next_breakpoint(t));
  }
  next = std::min(next, forces_.next_breakpoint(t));
  return drives_.natural.any() ? std::min(next, drives_.natural.next_breakpoint(t))
                               : next;
}

ComplianceForm* SupportedSystem::compliance_form() {
  if (rows_.rows() > 0 || !SupportedCompliance::available(*strand_, forces_))
    return nullptr;
  if (!compliant_) compliant_.emplace(*strand_, forces_, drives_.natural);
  return &*compliant_;
}

Status SupportedSystem::residual(double t, In q, In v, In a, Out r) noexcept {
  prepare(t);
  const Status s = strand_->residual(t, q, v, a, r);
  if (s == Status::ok) forces_.add_to_residual(t, q, v, r);
  return s;
}

Status SupportedSystem::factor(double t, In q, In v, In a, In lambda, Weights w,
                               In springs, std::span<const SectionLoad> loads) noexcept {
  prepare(t);
  const bool mass_alone = w.vel == 0 && w.pos == 0;
  in_assembled_ = assembled_ && !mass_alone;
  if (in_assembled_) return assembled_->linearize(t, q, v, a, w);
  if (loaded_ == nullptr) return strand_->linearize(t, q, v, a, w);
  loads_.assign(loads.begin(), loads.end());
  if (!mass_alone) {
    for (std::size_t i = 0; i < supports() && !lambda.empty(); ++i) {
      loads_.push_back(rows_.load(t, q, lambda, i));
    }
    forces_.append_loads(t, q, v, loads_);
  }
  return loaded_->linearize_loaded(t, q, v, a, w, loads_, springs);
}

Status SupportedSystem::linearize_with_springs(
    double t, In q, In v, In a, In lambda, Weights w, In springs,
    std::span<const SectionLoad> loads) noexcept {
  return factor(t, q, v, a, lambda, w, springs,
                last_.take(t, q, v, a, lambda, w, springs, loads).loads);
}

Status SupportedSystem::solve(In b, Out x) noexcept {
  const Status restored = last_.restore([this](const LastMatrix::Arguments& of) {
    return factor(of.t, of.q, of.v, of.a, of.lambda, of.w, of.springs, of.loads);
  });
  return restored == Status::ok ? solve_factored(b, x) : restored;
}

Status SupportedSystem::values(double t, In q, In v, In a, Weights w, Out s) noexcept {
  if (dense_) last_.replace();
  prepare(t);
  const Status status = of_strand().values(t, q, v, a, w, s);
  if (status == Status::ok) forces_.add_tangent(t, q, v, w, s);
  return status;
}

Energy SupportedSystem::energy(double t, In q, In v) {
  prepare(t);
  Energy sum = strand_->energetics()->energy(t, q, v);
  sum.potential += forces_.energy(t, q);
  return sum;
}

/// Row k of G times x.
double SupportedSystem::product(Eigen::Index row, const double* x) const {
  const Pattern& pattern = rows_.pattern();
  const auto k = static_cast<std::size_t>(row);
  double sum = 0;
  for (int p = pattern.start[k]; p < pattern.start[k + 1]; ++p) {
    const auto entry = static_cast<std::size_t>(p);
    sum += gradient_[entry] * x[pattern.row[entry]];
  }
  return sum;
}

/// Prepares multipliers() at a state. A singular mass matrix is replaced by that of a
/// short step, as in Dynamics::accelerate.
Status SupportedSystem::hold(double t, In q, In v) {
  const auto n = static_cast<Eigen::Index>(q.size());
  const Eigen::Index m = rows_.rows();
  const Weights w{1, short_time_, short_time_ * short_time_};
  last_.replace();
  for (const Status s :
       {rows_.gradient(t, q, gradient_), rows_.bias(t, q, v, bias_),
        residual(t, q, v, zero_, acceleration_), factor(t, q, v, zero_, {}, w, {}, {})}) {
    if (s != Status::ok) return s;
  }
  for (double& entry : acceleration_) entry = -entry;
  if (const Status s = solve_factored(acceleration_, acceleration_); s != Status::ok)
    return s;
  const Pattern& pattern = rows_.pattern();
  responses_.setZero(n, m);
  compliance_.resize(m, m);
  needed_.resize(m);
  for (Eigen::Index k = 0; k < m; ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (int p = pattern.start[row]; p < pattern.start[row + 1]; ++p) {
      const auto entry = static_cast<std::size_t>(p);
      responses_(pattern.row[entry], k) = gradient_[entry];
    }
    const Out column(responses_.col(k).data(), q.size());
    if (const Status s = solve_factored(column, column); s != Status::ok) return s;
    needed_[k] = -bias_[row] - product(k, acceleration_.data());
  }
  for (Eigen::Index k = 0; k < m; ++k) {
    for (Eigen::Index j = 0; j < m; ++j) {
      compliance_(k, j) = product(k, responses_.col(j).data());
    }
  }
  return Status::ok;
}

/// lambda of the first rows alone, others 0; of least norm where rows are redundant.
void SupportedSystem::multipliers(int rows, std::vector<double>& lambda) const {
  lambda.assign(bias_.size(), 0.0);
  if (rows == 0) return;
  const Eigen::VectorXd unit =
      compliance_.diagonal().head(rows).cwiseAbs().cwiseSqrt().unaryExpr(
          [](double x) { return x > 0 ? 1 / x : 1; });
  const Eigen::MatrixXd scaled =
      unit.asDiagonal() * compliance_.topLeftCorner(rows, rows) * unit.asDiagonal();
  const Eigen::VectorXd found = unit.cwiseProduct(
      least_squares_solution(scaled, unit.cwiseProduct(needed_.head(rows))));
  Eigen::Map<Eigen::VectorXd>(lambda.data(), rows) = found;
}

Status SupportedSystem::support_forces(double t, In q, In v, Out forces, Out moments) {
  if (const Status s = hold(t, q, v); s != Status::ok) return s;
  std::vector<double> lambda;
  multipliers(rows_.rows(), lambda);
  loads_of(t, q, v, lambda, forces, moments);
  return Status::ok;
}

void SupportedSystem::loads_of(double t, In q, In v, In lambda, Out forces, Out moments) {
  for (std::size_t i = 0; i < supports(); ++i) {
    const SectionLoad load = rows_.load(t, q, lambda, i);
    store3(load.force, &forces[3 * i]);
    store3(load.moment, &moments[3 * i]);
  }
  forces_.write_support_forces(t, q, v, forces, moments);
}

void SupportedSystem::support_motion(double t, Out x, Out u, Out omega) const {
  for (std::size_t i = 0; i < supports(); ++i) {
    const RootPose pose = rows_.supports()[i].path.at(t);
    store3(pose.x, &x[3 * i]);
    store3(pose.v, &u[3 * i]);
    store3(pose.omega, &omega[3 * i]);
  }
}

double SupportedSystem::natural_power(double t, In q) {
  SupportedSystem* const self = this;
  return power_of_natural({&self, 1}, t, [&] { return potential_as_set(t, q); });
}

NaturalWork SupportedSystem::natural_work(double from, In q_from, double to, In q_to) {
  SupportedSystem* const self = this;
  return work_of_natural({&self, 1}, from, to, [&](bool end) {
    return potential_as_set(end ? to : from, end ? q_to : q_from);
  });
}

double SupportedSystem::potential_as_set(double t, In q) {
  if (strand_->energetics() == nullptr) return 0;
  return strand_->energetics()->energy(t, q, zero_).potential + forces_.energy(t, q);
}

double SupportedSystem::moment_power(double t, In q, In v, const Vec& turning) {
  return forces_.power_of_moments(t, q, v, turning);
}

double SupportedSystem::power(double t, In q, In v) {
  prepare(t);
  double alone = strand_->energetics()->power(t, q, v) + natural_power(t, q);
  if (hold(t, q, v) != Status::ok) return std::nan("");
  std::vector<double> lambda, own, change(q.size());
  multipliers(rows_.rows(), lambda);
  // What added forces change of the accelerations, and of the strand's own constraints.
  if (forces_.any()) {
    forces_.add_to_residual(t, q, v, change);
    for (double& entry : change) entry = -entry;
    if (solve_factored(change, change) != Status::ok) return std::nan("");
    for (Eigen::Index k = 0; k < rows_.own(); ++k)
      needed_[k] += product(k, change.data());
    alone += forces_.energy_rate(t, q, v);
  }
  multipliers(rows_.own(), own);
  for (std::size_t k = 0; k < own.size(); ++k) lambda[k] -= own[k];
  Eigen::Map<Eigen::VectorXd>(change.data(), std::ssize(change)) +=
      responses_ * Eigen::Map<const Eigen::VectorXd>(lambda.data(), std::ssize(lambda));
  return alone + kinetic_rate(*strand_->energetics(), t, q, v, change, v_typ_);
}

}  // namespace tress::models
