#include "integrators/one_step/radau.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

constexpr std::size_t count = RadauTable::stages;

constexpr RadauTable table = radau_table();

/// Corrections shrink at the rate of T, so that more of them are allowed than Newton's
/// method with its own matrices needs.
constexpr int patience = 2;
/// Rate above which the matrix is out of date: the rate of T is a quarter.
constexpr double slow_rate = 0.5;
/// Rate that is expected at least: single corrections may be smaller.
constexpr double least_rate = 0.25;
/// Largest length of an extrapolation over that of the solution.
constexpr double farthest_guess = 3;
/// Lengths of parts over the one before: where none has been solved, and at most.
constexpr double shorter_part = 0.25, most_growth = 2;
constexpr RadauParts by_iteration{
    .first = 0.25, .shortest = 1e-3, .least_growth = 1.02, .growth_power = 1};
constexpr RadauParts by_whole_jacobian{.first = 0.02,
                                       .shortest = 1e-5,
                                       .least_growth = 1.005,
                                       .growth_power = 1.5,
                                       .most = 200};
/// Solutions with I - g J of an estimate: the second removes what the first leaves in the
/// velocities of stiff directions that turn.
constexpr int filters = 2;

/// Weight at x of the value at node j of the polynomial through the values at all nodes.
double lagrange(std::size_t j, double x) {
  double weight = 1;
  for (std::size_t k = 0; k < count; ++k) {
    if (k != j) weight *= (x - table.c[k]) / (table.c[j] - table.c[k]);
  }
  return weight;
}

}  // namespace

RadauStages::RadauStages(Dynamics& dynamics, const Options& options, double remaining)
    : dynamics_(dynamics),
      rules_(NewtonRules::of(options.newton_tolerance, remaining)),
      iterations_(patience * options.newton_iterations),
      refresh_(options.refresh),
      x_(count, Unknowns(dynamics)),
      guess_(x_),
      y_(x_),
      q_(count, std::vector<double>(size(dynamics.n()))),
      v_(q_),
      z_(q_),
      solved_{.x = x_},
      part_{.x = x_},
      before_{.x = x_},
      whole_(dynamics, rules_, options.newton_iterations),
      stresses_(count, StressOrigin(dynamics)) {}

void RadauStages::start_from(const Start& start) noexcept {
  start_ = start;
  for (StressOrigin& stresses : stresses_) stresses.leave(start.t, start.q);
}

/// By the polynomial through the stages of a solution, else by the start.
void RadauStages::guess(const Solution& from, double h) noexcept {
  const double last = (start_.t + h - from.t) / from.h - 1;  // beyond the solution
  const bool known = from.h > 0 && start_.t <= from.t + from.h * (1 + 1e-6) &&
                     start_.t >= from.t && last <= farthest_guess;
  for (std::size_t i = 0; i < count; ++i) {
    if (!known) {
      std::ranges::copy(start_.a, guess_[i].a.begin());
      std::ranges::copy(start_.lambda, guess_[i].lambda.begin());
      continue;
    }
    std::ranges::fill(guess_[i].a, 0.0);
    std::ranges::fill(guess_[i].lambda, 0.0);
    for (std::size_t j = 0; j < count; ++j) {
      const double weight = lagrange(j, (start_.t - from.t + table.c[i] * h) / from.h);
      guess_[i].become(guess_[i], weight, from.x[j]);
    }
  }
}

void RadauStages::tie(double h) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::copy(start_.v, v_[i].begin());
    for (std::size_t j = 0; j < count; ++j) add(v_[i], h * table.a[i][j], x_[j].a);
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::copy(start_.q, q_[i].begin());
    for (std::size_t j = 0; j < count; ++j) add(q_[i], h * table.a[i][j], v_[j]);
  }
}

Status RadauStages::linearize(double h, std::size_t i, Matrices matrices,
                              bool first) noexcept {
  if (matrices != Matrices::own_stresses) {
    first ? stresses_[i].hold() : stresses_[i].follow(time(h, i));
  }
  const double g = table.gamma() * h;
  return dynamics_.linearize(time(h, i), q_[i], v_[i], x_[i].a, x_[i].lambda,
                             {1, g, g * g});
}

Status RadauStages::correct_stage(double h, std::size_t i) noexcept {
  const double g = table.gamma() * h;
  Status s = dynamics_.residual(time(h, i), q_[i], v_[i], x_[i].a, x_[i].lambda, y_[i].a,
                                y_[i].lambda);
  if (s == Status::ok) s = dynamics_.solve(y_[i].a, y_[i].lambda);
  if (s != Status::ok) return s;
  stresses_[i].correct_from(q_[i]);
  x_[i].become(x_[i], -1, y_[i]);
  add(z_[i], -g, y_[i].a);
  add(v_[i], -g, y_[i].a);
  add(q_[i], -g * g, y_[i].a);
  return s;
}

Status RadauStages::sweep(double h, Matrices matrices, bool fresh, bool first,
                          double& correction) noexcept {
  const double g = table.gamma() * h;
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::copy(start_.q, q_[i].begin());
    shifted(z_[i], start_.v, -1, v_[i]);
    for (std::size_t j = 0; j < count; ++j) {
      add(q_[i], h * table.a[i][j], v_[j]);
      add(z_[i], h * table.a[i][j], x_[j].a);
    }
  }
  constexpr std::size_t middle = 1;
  if (fresh && matrices == Matrices::one) {
    const Status s = linearize(h, middle, matrices, first);
    if (s != Status::ok) return s;
  }
  ++dynamics_.stats.newton_iterations;
  correction = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      add(z_[i], -h * table.t[i][j], y_[j].a);
      add(q_[i], h * table.t[i][j], z_[j]);
    }
    add(v_[i], 1, z_[i]);
    add(q_[i], g, z_[i]);
    if (matrices != Matrices::one) {
      const Status s = linearize(h, i, matrices, first);
      if (s != Status::ok) return s;
    }
    if (const Status s = correct_stage(h, i); s != Status::ok) return s;
    correction = std::max({correction, g * g * scaled_norm(y_[i].a, dynamics_.q_typ()),
                           g * scaled_norm(y_[i].a, dynamics_.v_typ())});
  }
  return std::isfinite(correction) ? Status::ok : Status::retry;
}

Status RadauStages::iterate(double h, Matrices matrices) noexcept {
  x_ = guess_;
  tie(h);
  double previous = std::numeric_limits<double>::infinity(), smallest = previous;
  int grown = 0;
  bool fresh = true;
  for (int i = 0; i < iterations_; ++i) {
    double correction = 0;
    const Status s = sweep(h, matrices, fresh, i == 0, correction);
    if (s != Status::ok) return s;
    const double rate = correction / previous;
    const double left = i > 0 && rate < 1 ? NewtonRules::error_left(
                                                correction, std::max(rate, least_rate))
                                          : correction;
    const bool rounding = i > 1 && correction > smallest && correction <= rules_.rounding;
    if (correction <= rules_.tolerance || left <= rules_.left || rounding) {
      tie(h);
      return Status::ok;
    }
    if (rate > 1 && i > 0 && ++grown == most_grown) return Status::retry;
    fresh = i > 0 && rate > slow_rate;
    previous = correction;
    smallest = std::min(smallest, correction);
  }
  return Status::retry;
}

/// From guess_.
Status RadauStages::newton(double h) noexcept {
  Status s = Status::retry;
  if (refresh_ != Refresh::every_iteration) s = iterate(h, Matrices::one);
  if (s == Status::retry) s = iterate(h, Matrices::own);
  if (s == Status::retry && stresses_.front().exists()) {
    s = iterate(h, Matrices::own_stresses);
  }
  return s;
}

/// From the longest part solved, or the first one, to the whole step: `solve` leaves the
/// stages of a step of its length in x_.
template <class Solve>
Status RadauStages::follow(const RadauParts& parts, double h, Solve solve) noexcept {
  double growth = most_growth;
  double part = part_.h > 0 ? std::min(1.0, growth * part_.h / h) : parts.first;
  for (int i = 0; i < parts.most; ++i) {
    const Status s = solve(part * h);
    if (s == Status::fatal) return s;
    if (s == Status::ok) {
      std::swap(before_, part_);
      keep(part * h, part_);
      if (part == 1) return s;
      growth = std::min(most_growth, std::pow(growth, parts.growth_power));
    } else if (part_.h == 0) {
      part *= shorter_part;
      if (part < parts.shortest) return s;
      continue;
    } else {
      growth = std::sqrt(growth);
      if (growth < parts.least_growth) return s;
    }
    part = std::min(1.0, growth * part_.h / h);
  }
  return Status::retry;
}

Status RadauStages::by_parts(double h) noexcept {
  part_.h = 0;
  return follow(by_iteration, h, [this](double to) noexcept {
    guess(part_, to);
    return newton(to);
  });
}

/// The displacements of a stage, of h^2 a, continue along a line, and so do the
/// multipliers. The polynomial of a part oscillates beyond it.
void RadauStages::extrapolate(double h) noexcept {
  if (before_.h == 0) return guess(part_, h);
  const double further = (h - part_.h) / (part_.h - before_.h);
  const double last = (1 + further) * (part_.h / h) * (part_.h / h),
               first = -further * (before_.h / h) * (before_.h / h);
  for (std::size_t i = 0; i < count; ++i) {
    const Unknowns &x = part_.x[i], &y = before_.x[i];
    std::ranges::transform(x.a, y.a, guess_[i].a.begin(), [&](double to, double from) {
      return last * to + first * from;
    });
    std::ranges::transform(
        x.lambda, y.lambda, guess_[i].lambda.begin(),
        [&](double to, double from) { return (1 + further) * to - further * from; });
  }
}

Status RadauStages::by_path(double h) noexcept {
  whole_.start_from(start_.t, start_.q, start_.v);
  before_.h = 0;
  const Status s = follow(by_whole_jacobian, h, [this](double to) noexcept {
    extrapolate(to);
    x_ = guess_;
    return whole_.solve(to, x_);
  });
  if (s == Status::ok) tie(h);
  return s;
}

void RadauStages::keep(double h, Solution& solution) const noexcept {
  solution.t = start_.t;
  solution.h = h;
  solution.x = x_;
}

Status RadauStages::step(double t, double h, In q, In v, In a, In lambda,
                         Effort effort) noexcept {
  start_from({t, q, v, a, lambda});
  guess(solved_, h);
  Status s = newton(h);
  if (s == Status::retry && effort == Effort::whole) s = by_parts(h);
  if (s == Status::retry && effort == Effort::whole) s = by_path(h);
  if (s == Status::ok) keep(h, solved_);
  return s;
}

Status RadauStages::difference(Out dq, Out dv) noexcept {
  const double g = table.gamma() * solved_.h;
  std::ranges::transform(start_.v, dq.begin(), [g](double v) { return g * v; });
  std::ranges::transform(start_.a, dv.begin(), [g](double a) { return g * a; });
  for (std::size_t j = 0; j < count; ++j) {
    add(dq, -g * lagrange(j, 0), v_[j]);
    add(dv, -g * lagrange(j, 0), x_[j].a);
  }
  Dynamics::Base base = Dynamics::Base::fresh;
  for (int i = 0; i < filters; ++i) {
    add(dq, g, dv);
    Unknowns& change = y_.front();
    Status s =
        dynamics_.directional(start_.t, start_.q, start_.v, start_.a, start_.lambda, dq,
                              dv, change.a, change.lambda, base);
    if (s == Status::ok) s = dynamics_.solve(change.a, change.lambda);
    if (s != Status::ok) return s;
    add(dq, -g * g, change.a);
    add(dv, -g, change.a);
    base = Dynamics::Base::kept;
  }
  return Status::ok;
}

}  // namespace tress::integrators
