#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/forms/compliance_form.h"
#include "integrators/entry.h"
#include "integrators/position_based/anderson.h"

namespace tress::integrators {

/// Option for the number of sweeps.
inline constexpr Parameter sweeps_option{.name = "sweeps",
                                         .help = "Gauss-Seidel sweeps per step",
                                         .number = 10,
                                         .min = 1,
                                         .max = 1e6,
                                         .whole = true};
/// Option for the order of blocks in a sweep.
inline constexpr Parameter sweep_order_option{.name = "sweep_order",
                                              .help = "order of the blocks in a sweep",
                                              .choices = "root_to_tip|bilateral"};

/// The options above, which all methods that sweep have.
std::span<const Parameter> sweep_options();

/// Returns the indices of `count` blocks in the order of a sweep: from the root to the
/// tip, or from both ends alternately. In the latter, even indices ascend and odd ones
/// descend, after the bilateral interleaving of [Kugelstadt & Schoemer 2016].
std::vector<std::size_t> sweep_indices(std::string_view sweep_order, std::size_t count);

/// Gauss-Seidel sweeps over the blocks of a model's ComplianceForm. From a guess x and
/// lambda = 0 every block is corrected in turn by x += W G^T dlambda with
///
///     ((1 + gamma) G W G^T + alpha/h^2) dlambda
///         = -C - alpha lambda/h^2 - gamma (G (x - origin) + h C_t),   gamma = alpha c/h,
///
/// so that converged sweeps solve x = guess + h^2 W G^T s, except for the change of G.
/// The stress s is that of the energy and of its friction at the rates (x - origin)/h.
/// [Macklin, Mueller & Chentanez 2016, eqs. 18, 26]
///
/// anderson: AndersonMixing of x and lambda together. This keeps x - guess = W G^T lambda
/// for linear C. The norm is that of x by the masses. unsettled() does not allow for it.
class PositionSweeps {
 public:
  /// Constructs the sweeps from sweep_options(), or from another list that contains them
  /// and may contain anderson_option. Throws InputError if an option is out of range.
  PositionSweeps(System& system, const Options& options,
                 std::span<const Parameter> parameters = sweep_options());

  /// Solves the equations of time t; x is the guess, then the solution. Adds to `stats`.
  void run(double t, double h, In origin, InOut x, Stats& stats);
  /// Estimates the remaining error of the last run's sweeps relative to the distance of x
  /// from its origin. The norm is the root of the sum of squares weighted by the diagonal
  /// of the mass. The remainder is that of a geometric series of the moves m of the last
  /// two sweeps: r m/(1 - r), with r = m/m_before, at most `slowest`. After a single
  /// sweep r is not known: `unknown`.
  double unsettled() const { return unsettled_; }

 private:
  using Block = ComplianceForm::Block;
  static constexpr int columns = ComplianceForm::most_coordinates;
  using Rows = std::array<double, ComplianceForm::most_rows>;
  using Square = std::array<Rows, ComplianceForm::most_rows>;

  PositionSweeps(System& system, const Parameters& chosen);
  void correct(double t, double h, std::size_t k, In origin, InOut x);
  static void solve(Square& a, Rows& b, std::size_t rows);
  double weighed(In from, In to) const;
  void gather(In x, Out z) const;
  void mix(InOut x);

  static constexpr double slowest = 0.999, unknown = 0.9;

  int sweeps_;
  ComplianceForm& form_;
  const std::vector<Block>& blocks_;
  std::vector<std::size_t> order_;
  std::vector<Rows> lambda_of_;  // of the blocks, in this step
  std::vector<double> w_, last_;
  AndersonMixing mixing_;
  std::vector<double> from_, to_;  // x and lambda before a sweep and after
  double unsettled_ = 0;
  ComplianceForm::Value value_{};
};

/// Why a system cannot be swept: it has no ComplianceForm.
std::string compliances(System& system, Formulation formulation);

/// The formulations that sweeps lack: all with multipliers.
std::vector<Gap> gaps_of_sweeps();

}  // namespace tress::integrators
