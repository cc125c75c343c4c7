#include "integrators/position_based/position_sweeps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/forms/driven_bodies.h"

namespace tress::integrators {
namespace {

constexpr Parameter own[] = {sweeps_option, sweep_order_option};

constexpr std::string_view no_multipliers =
    "takes energies, not constraints with multipliers";

}  // namespace

std::span<const Parameter> sweep_options() { return own; }

std::vector<std::size_t> sweep_indices(std::string_view sweep_order, std::size_t count) {
  std::vector<std::size_t> all;
  if (sweep_order == "root_to_tip") {
    for (std::size_t k = 0; k < count; ++k) all.push_back(k);
    return all;
  }
  std::size_t odd = count - count % 2;  // one past the last odd index
  for (std::size_t even = 0; even < count; even += 2) {
    all.push_back(even);
    if (odd > 0) all.push_back(odd - 1);
    odd = odd > 2 ? odd - 2 : 0;
  }
  return all;
}

PositionSweeps::PositionSweeps(System& system, const Options& options,
                               std::span<const Parameter> parameters)
    : PositionSweeps(system, own_options(options, parameters)) {}

PositionSweeps::PositionSweeps(System& system, const Parameters& chosen)
    : sweeps_(chosen.whole("sweeps")),
      form_(*system.compliance_form()),
      blocks_(form_.blocks()),
      order_(sweep_indices(chosen.word("sweep_order"), blocks_.size())),
      lambda_of_(blocks_.size()),
      w_(static_cast<std::size_t>(system.layout().coordinates)),
      last_(w_.size()),
      from_(w_.size() + blocks_.size() * ComplianceForm::most_rows),
      to_(from_.size()) {
  form_.inverse_mass(w_);
  std::vector<double> masses = w_;
  for (double& entry : masses) entry = 1 / entry;
  const int depth = chosen.knows("anderson") ? chosen.whole("anderson") : 0;
  mixing_ = AndersonMixing(depth, from_.size(), std::move(masses));
}

void PositionSweeps::run(double t, double h, In origin, InOut x, Stats& stats) {
  for (Rows& lambda : lambda_of_) lambda.fill(0);
  mixing_.restart();
  double move = 0, before = 0;  // of the last two sweeps
  for (int sweep = 0; sweep < sweeps_; ++sweep) {
    const bool late = sweep + 2 >= sweeps_;
    if (late) std::ranges::copy(x, last_.begin());
    if (mixing_.active()) gather(x, from_);
    for (const std::size_t k : order_) correct(t, h, k, origin, x);
    ++stats.sweeps;
    if (late) before = std::exchange(move, weighed(last_, x));
    if (mixing_.active()) mix(x);
  }
  const double rate =
      sweeps_ == 1 ? unknown : (move < slowest * before ? move / before : slowest);
  const double moved = weighed(origin, x);
  unsettled_ = moved > 0 ? rate / (1 - rate) * move / moved : 0;
}

/// z <- x and the multipliers.
void PositionSweeps::gather(In x, Out z) const {
  auto at = std::ranges::copy(x, z.begin()).out;
  for (const Rows& lambda : lambda_of_) at = std::ranges::copy(lambda, at).out;
}

/// After a sweep that started from from_.
void PositionSweeps::mix(InOut x) {
  gather(x, to_);
  mixing_.mix(from_, to_);
  auto at = to_.begin();
  const auto take = [&at](auto& values) {
    const auto end = at + static_cast<std::ptrdiff_t>(values.size());
    std::copy(at, end, values.begin());
    at = end;
  };
  take(x);
  for (Rows& lambda : lambda_of_) take(lambda);
}

double PositionSweeps::weighed(In from, In to) const {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double d = to[i] - from[i];
    sum += d * d / w_[i];
  }
  return std::sqrt(sum);
}

/// Solves the equation of the header with rows divided by 1 + gamma: symmetric positive
/// definite.
void PositionSweeps::correct(double t, double h, std::size_t k, In origin, InOut y) {
  const Block& block = blocks_[k];
  const std::size_t size = block.coordinates.size();
  const auto rows = static_cast<std::size_t>(block.rows);
  double x[columns], moved[columns], w[columns];
  for (std::size_t i = 0; i < size; ++i) {
    const auto from = static_cast<std::size_t>(block.coordinates[i]);
    x[i] = y[from];
    moved[i] = y[from] - origin[from];
    w[i] = w_[from];
  }
  form_.evaluate(t, k, {x, size}, value_);
  Rows& lambda = lambda_of_[k];
  Square matrix;
  Rows change;
  for (std::size_t r = 0; r < rows; ++r) {
    const double* slope = value_.gradient[r];
    for (std::size_t c = 0; c <= r; ++c) {
      double sum = 0;
      for (std::size_t i = 0; i < size; ++i)
        sum += slope[i] * w[i] * value_.gradient[c][i];
      matrix[r][c] = sum;
    }
    double along = 0;
    for (std::size_t i = 0; i < size; ++i) along += slope[i] * moved[i];
    const double alpha = block.alpha[r] / (h * h);
    const double gamma = block.alpha[r] * block.friction[r] / h;
    matrix[r][r] += alpha / (1 + gamma);
    change[r] =
        -(value_.c[r] + alpha * lambda[r] + gamma * (along + h * value_.drift[r])) /
        (1 + gamma);
  }
  solve(matrix, change, rows);
  for (std::size_t r = 0; r < rows; ++r) {
    lambda[r] += change[r];
    for (std::size_t i = 0; i < size; ++i) {
      y[static_cast<std::size_t>(block.coordinates[i])] +=
          w[i] * value_.gradient[r][i] * change[r];
    }
  }
}

/// Cholesky's method on the lower triangle of a, in place; b becomes the solution.
void PositionSweeps::solve(Square& a, Rows& b, std::size_t rows) {
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      for (std::size_t i = 0; i < c; ++i) a[r][c] -= a[r][i] * a[c][i];
      a[r][c] = c < r ? a[r][c] / a[c][c] : std::sqrt(a[r][r]);
    }
    for (std::size_t i = 0; i < r; ++i) b[r] -= a[r][i] * b[i];
    b[r] /= a[r][r];
  }
  for (std::size_t r = rows; r-- > 0;) {
    for (std::size_t i = r + 1; i < rows; ++i) b[r] -= a[i][r] * b[i];
    b[r] /= a[r][r];
  }
}

std::string compliances(System& system, Formulation /*formulation*/) {
  if (system.compliance_form() != nullptr) return {};
  if (driven_bodies(system) != nullptr) {
    return "takes forces as compliant constraints, which leave out bodies that strands "
           "drive";
  }
  return "needs the model's energy as compliant constraints";
}

std::vector<Gap> gaps_of_sweeps() {
  return {{Formulation::acceleration, no_multipliers},
          {Formulation::baumgarte, no_multipliers},
          {Formulation::projection, no_multipliers},
          {Formulation::index2_ggl, no_multipliers},
          {Formulation::index3, no_multipliers},
          {Formulation::rattle, no_multipliers},
          {Formulation::correction, no_multipliers}};
}

}  // namespace tress::integrators
