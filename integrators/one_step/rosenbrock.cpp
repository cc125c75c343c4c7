#include "integrators/one_step/rosenbrock.h"

#include <algorithm>
#include <cmath>

#include "integrators/one_step.h"
#include "linear/finite.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Differences for dr/dt span this part of the step: their truncation error, 1e-6/3 h^2
/// times the third derivative, is below that of the method for steps that resolve it.
constexpr double time_part = 1e-3;

}  // namespace

RosenbrockStages::RosenbrockStages(Dynamics& dynamics, const Options& /*options*/,
                                   const RosenbrockTable& table, double difference_part)
    : table_(table),
      dynamics_(dynamics),
      difference_part_(difference_part),
      x_(table.stages, std::vector<double>(size(dynamics.n()))),
      z_(x_),
      alpha_(x_) {
  for (auto* values :
       {&q_, &v_, &a_, &d_, &y_, &rhs_, &rate_, &v_shift_, &a_shift_, &r_, &r_other_}) {
    values->assign(size(dynamics.n()), 0.0);
  }
}

void RosenbrockStages::add_increments(
    const std::array<double, RosenbrockTable::most_stages>& row, std::size_t count,
    double factor, const std::vector<std::vector<double>>& increments,
    InOut sum) const noexcept {
  for (std::size_t j = 0; j < count; ++j) {
    if (row[j] != 0) add(sum, factor * row[j], increments[j]);
  }
}

Status RosenbrockStages::differentiate_in_time(const Start& start, double h) noexcept {
  const double e = time_part * h;
  const auto at = [&](double t, Out r) {
    return dynamics_.residual(t, start.q, start.v, start.a, {}, r, {});
  };
  if (const Status s = at(start.t + e, r_); s != Status::ok) return s;
  if (const Status s = at(start.t + 2 * e, r_other_); s != Status::ok) return s;
  for (std::size_t k = 0; k < rate_.size(); ++k) {
    rate_[k] = (4 * (r_[k] - rhs_[k]) - (r_other_[k] - rhs_[k])) / (2 * e);
  }
  return Status::ok;
}

Status RosenbrockStages::add_products(const Start& start) noexcept {
  const In v_typ = dynamics_.v_typ();
  const double length = scaled_norm(d_, v_typ);
  const double most = difference_part_ * std::max(1.0, scaled_norm(start.v, v_typ));
  const double e = length > most ? most / length : 1;
  const auto at = [&](double factor, Out r) {
    shifted(v_shift_, start.v, factor, d_);
    std::ranges::transform(y_, a_shift_.begin(),
                           [factor](double y) { return factor * y; });
    return dynamics_.residual(start.t, start.q, v_shift_, a_shift_, {}, r, {});
  };
  if (const Status s = at(e, r_); s != Status::ok) return s;
  if (const Status s = at(-e, r_other_); s != Status::ok) return s;
  for (std::size_t k = 0; k < rhs_.size(); ++k) {
    rhs_[k] += (r_[k] - r_other_[k]) / (2 * e);
  }
  return Status::ok;
}

Status RosenbrockStages::solve_stage(const Start& start, double h,
                                     std::size_t i) noexcept {
  const double g = table_.gamma * h;
  std::ranges::copy(start.q, q_.begin());
  std::ranges::copy(start.v, v_.begin());
  std::ranges::copy(start.a, a_.begin());
  add_increments(table_.a[i], i, 1, x_, q_);
  add_increments(table_.a[i], i, 1, z_, v_);
  add_increments(table_.a[i], i, 1, alpha_, a_);
  d_ = v_;
  y_ = a_;
  add_increments(table_.c[i], i, 1 / h, x_, d_);
  add_increments(table_.c[i], i, 1 / h, z_, y_);
  add(y_, 1 / g, d_);
  const double t = i == 0 ? start.t : start.t + h * table_.time[i];
  Status s = dynamics_.residual(t, q_, v_, a_, {}, rhs_, {});
  if (s == Status::ok && i == 0) s = differentiate_in_time(start, h);
  if (s != Status::ok) return s;
  for (std::size_t k = 0; k < rhs_.size(); ++k) {
    rhs_[k] = -rhs_[k] - h * table_.rate[i] * rate_[k];
  }
  s = add_products(start);
  if (s == Status::ok) s = dynamics_.solve(rhs_, {});
  if (s != Status::ok) return s;
  for (std::size_t k = 0; k < rhs_.size(); ++k) {
    x_[i][k] = g * g * rhs_[k];
    z_[i][k] = g * rhs_[k] - d_[k];
    alpha_[i][k] = rhs_[k] - y_[k];
  }
  return s;
}

Status RosenbrockStages::step(double t, double h, In q, In v, In a, In /*lambda*/,
                              Effort /*effort*/) noexcept {
  const Start start{just_after(t), q, v, a};
  const double g = table_.gamma * h;
  Status s = dynamics_.linearize(start.t, q, v, a, {}, {1, g, g * g});
  for (std::size_t i = 0; i < table_.stages && s == Status::ok; ++i) {
    s = solve_stage(start, h, i);
  }
  if (s != Status::ok) return s;
  add(q_, 1, x_[table_.stages - 1]);
  add(v_, 1, z_[table_.stages - 1]);
  add(a_, 1, alpha_[table_.stages - 1]);
  if (!all_finite(q_) || !all_finite(v_) || !all_finite(a_)) return Status::retry;
  end_ = t + h;
  g_ = g;
  return Status::ok;
}

Status RosenbrockStages::difference(Out dq, Out dv) noexcept {
  Status s = dynamics_.residual(end_, q_, v_, a_, {}, rhs_, {});
  if (s == Status::ok) s = dynamics_.solve(rhs_, {});
  if (s != Status::ok) return s;
  const std::size_t last = table_.stages - 1;
  for (std::size_t k = 0; k < rhs_.size(); ++k) {
    dq[k] = std::abs(x_[last][k]) + g_ * g_ * std::abs(rhs_[k]);
    dv[k] = std::abs(z_[last][k]) + g_ * std::abs(rhs_[k]);
  }
  return s;
}

std::unique_ptr<Integrator> make_rosenbrock(const RosenbrockTable& table, System& system,
                                            const Options& options,
                                            double difference_part) {
  if (options.tolerance > 0) {
    return std::make_unique<ControlledOneStep<RosenbrockStages>>(
        system, options, 1 + table.embedded_order, table.share * options.tolerance,
        options, table, difference_part);
  }
  return std::make_unique<FixedOneStep<RosenbrockStages>>(system, options, table,
                                                          difference_part);
}

}  // namespace tress::integrators
