#include <array>
#include <cmath>
#include <vector>

#include "integrators/entry.h"
#include "integrators/fixed_step.h"

namespace tress::integrators {
namespace {

constexpr Parameter own_xpbd[] = {
    {.name = "sweeps",
     .help = "Gauss-Seidel sweeps per step",
     .number = 10,
     .min = 1,
     .max = 1e6,
     .whole = true},
    {.name = "sweep_order",
     .help = "order of the blocks in a sweep",
     .choices = "root_to_tip|bilateral"},
};
using Block = ComplianceForm::Block;

/// Indices of `count` blocks in the order of a sweep: from the root to the tip, or from
/// both ends alternately, even indices upwards and odd ones downwards, after the
/// bilateral interleaving of [Kugelstadt & Schoemer 2016].
std::vector<std::size_t> order_of(std::string_view sweep_order, std::size_t count) {
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

/// Position-based dynamics with compliance: backward Euler on the energy, explicit on all
/// other forces, by a fixed number of Gauss-Seidel sweeps over the blocks of the model's
/// ComplianceForm. From x = q + h v + h^2 rest(q, v) and lambda = 0 every block is
/// corrected in turn by x += W G^T dlambda with
///
///     ((1 + gamma) G W G^T + alpha/h^2) dlambda
///         = -C - alpha lambda/h^2 - gamma (G (x - q) + h C_t),   gamma = alpha c/h,
///
/// then v = (x - q)/h. Order 1. With few sweeps it is softer than the model, increasingly
/// so for longer steps and finer strands. Converged sweeps give backward Euler's step
/// except for the change of G during the step, O(h^2) of the force (none for linear C,
/// large if light coordinates turn far). [Macklin, Mueller & Chentanez 2016, eqs. 18, 26]
class Xpbd final : public FixedStep {
 public:
  Xpbd(System& system, const Options& options)
      : Xpbd(system, options, own_options(options, own_xpbd)) {}

 private:
  static constexpr int columns = ComplianceForm::most_coordinates;
  using Rows = std::array<double, ComplianceForm::most_rows>;
  using Square = std::array<Rows, ComplianceForm::most_rows>;

  Xpbd(System& system, const Options& options, const Parameters& chosen)
      : FixedStep(system, options),
        sweeps_(chosen.whole("sweeps")),
        form_(*system.compliance_form()),
        blocks_(form_.blocks()),
        order_(order_of(chosen.word("sweep_order"), blocks_.size())),
        lambda_of_(blocks_.size()),
        w_(vector_n()),
        x_(vector_n()) {
    form_.inverse_mass(w_);
  }

  Status step(double t, double h) override {
    if (const Status s = form_.rest(t, q_, v_, x_); s != Status::ok) return s;
    ++dynamics_.stats.residuals;
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = q_[i] + h * (v_[i] + h * x_[i]);
    for (Rows& lambda : lambda_of_) lambda.fill(0);
    for (int sweep = 0; sweep < sweeps_; ++sweep) {
      for (const std::size_t k : order_) correct(t + h, h, k);
      ++dynamics_.stats.sweeps;
    }
    for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - q_[i]) / h;
    q_.swap(x_);
    return Status::ok;
  }

  /// Solves the equation above with rows divided by 1 + gamma: symmetric positive
  /// definite.
  void correct(double t, double h, std::size_t k) {
    const Block& block = blocks_[k];
    const std::size_t size = block.coordinates.size();
    const auto rows = static_cast<std::size_t>(block.rows);
    double x[columns], moved[columns], w[columns];
    for (std::size_t i = 0; i < size; ++i) {
      const auto from = static_cast<std::size_t>(block.coordinates[i]);
      x[i] = x_[from];
      moved[i] = x_[from] - q_[from];
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
        x_[static_cast<std::size_t>(block.coordinates[i])] +=
            w[i] * value_.gradient[r][i] * change[r];
      }
    }
  }

  /// Cholesky's method on the lower triangle of a, in place; b becomes the solution.
  static void solve(Square& a, Rows& b, std::size_t rows) {
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

  int sweeps_;
  ComplianceForm& form_;
  const std::vector<Block>& blocks_;
  std::vector<std::size_t> order_;
  std::vector<Rows> lambda_of_;  // of the blocks, in this step
  std::vector<double> w_, x_;
  ComplianceForm::Value value_{};
};

std::string compliances(System& system, Formulation /*formulation*/) {
  if (system.compliance_form() != nullptr) return {};
  return "needs the model's energy as compliant constraints";
}

constexpr std::string_view no_multipliers =
    "takes energies, not constraints with multipliers";

}  // namespace

IntegratorEntry xpbd_entry() {
  return {.id = "xpbd",
          .summary = "position-based, Gauss-Seidel on compliances",
          .source = "Macklin-Mueller-Chentanez 2016",
          .formulations = {{Formulation::parametric, 1}},
          .gaps = {{Formulation::acceleration, no_multipliers},
                   {Formulation::baumgarte, no_multipliers},
                   {Formulation::projection, no_multipliers},
                   {Formulation::index2_ggl, no_multipliers},
                   {Formulation::index3, no_multipliers},
                   {Formulation::rattle, no_multipliers},
                   {Formulation::correction, no_multipliers}},
          .parameters = own_xpbd,
          .objection = compliances,
          .make = make_method<Xpbd>};
}

}  // namespace tress::integrators
