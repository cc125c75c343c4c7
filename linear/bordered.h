#pragma once

#include <functional>
#include <memory>

#include "contract/pattern.h"
#include "linear/kkt.h"

namespace tress {

/// Solves the saddle-point system of Kkt for a matrix S that is only available as a
/// solver. With Y = S^-1 G^T and W = H Y,
///
///     y = W^-1 (c - H S^-1 b),      x = S^-1 b + Y y.
///
/// W (m x m, dense) is scaled: entry (k, j) is divided by the root of the sums that its
/// diagonal entries k and j would be without cancellation. The condition of the scaled W
/// does not grow as a strand becomes straight. Cost: m solves to factor, one for each
/// right-hand side, and m^2 n operations.
///
/// Redundant constraints are solved as Kkt does: y has the least norm, and the parts of c
/// in null(H^T) and of y in null(G^T) are removed.
class Bordered {
 public:
  /// `solve` replaces b by S^-1 b, with the S of the caller's last factorisation.
  /// `gt` (n x m): pattern of G^T. `typical` (n): sizes of the coordinates, the metric in
  /// which constraints count as dependent.
  Bordered(std::function<Status(InOut b)> solve, const Pattern& gt, In typical);
  ~Bordered();

  /// `retry` when W is singular although the constraints are independent, or not finite.
  Status factor(In gt, In ht) noexcept;
  Status solve(InOut b, InOut c) noexcept;  // b -> x, c -> y
  /// Returns the diagnostics of the last factorisation.
  const KktReport& report() const { return report_; }

 private:
  struct Matrices;

  Status factor_redundant(In gt, In ht);
  void subtract_rows(In x, InOut c) const noexcept;
  Status solve_for_multipliers() noexcept;

  std::function<Status(InOut)> solve_;
  Pattern gt_;
  std::vector<double> typical_, ht_;
  std::unique_ptr<Matrices> of_;
  std::unique_ptr<NullSpace> null_g_, null_h_;  // while constraints are redundant
  KktReport report_;
};

}  // namespace tress
