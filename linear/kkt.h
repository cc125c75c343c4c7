#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "contract/pattern.h"
#include "linear/block_matrix.h"
#include "linear/linear_solver.h"
#include "linear/rank.h"

namespace tress {

/// Diagnostics of the last factorisation.
struct KktReport {
  std::string_view solver;  // name of the linear solver
  int rank_deficiency = 0;  // number of redundant constraints
  double condition = 0;     // of the equilibrated matrix, order of magnitude only
};

/// Solves the saddle-point system of a constrained step,
///
///     [S  -G^T] [x]   [b]        x (n) coordinates, y (m) multipliers,
///     [H   0  ] [y] = [c]        S (n x n) any; G, H (m x n) on one pattern.
///
/// Unknowns and rows are scaled with D from the diagonal of S (x = D x~), constraints to
/// unit length in that metric. Neither units nor a mass of 1e-8 kg are then mistaken for
/// rank deficiency. Cost: one sparse factorisation, two solves for the condition.
///
/// Redundant constraints (G of deficient rank) are solved in the least-squares sense.
/// With A = H S^-1 G^T, y has the least norm among those that minimise |A y - (c - H S^-1
/// b)|. The parts of c in null(H^T) and of y in null(G^T) are removed. The rest is solved
/// with delta added to the (2,2) block and refined against the unmodified matrix. Each
/// such factorisation allocates and repeats the QR of rank.h, since null spaces move with
/// G.
class Kkt {
 public:
  /// `gt` (n x m): column k holds the gradient of constraint k; m = 0 is allowed.
  Kkt(LinearKind kind, const Pattern& s, const Pattern& gt);
  ~Kkt();

  /// `retry` when the matrix is singular although the constraints are independent, or not
  /// finite. No allocation after the first call while the constraints are independent.
  Status factor(In s, In gt, In ht) noexcept;
  Status solve(InOut b, InOut c) noexcept;  // b -> x, c -> y
  /// Returns the diagnostics of the last factorisation.
  const KktReport& report() const { return report_; }

 private:
  void scale(In s, In gt, In ht) noexcept;
  void scale_massless(In s, In gt) noexcept;
  void assemble(In s, In gt, In ht, double delta) noexcept;
  Status factor_redundant(In s, In gt, In ht);
  Status factor_assembled() noexcept;
  void subtract_product() noexcept;
  Status refine() noexcept;

  Pattern s_, gt_;
  BlockMatrix matrix_;
  int s_block_, g_block_, h_block_, delta_block_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<int> diagonal_;                       // (n) entry of s, -1 where absent
  std::vector<double> scaled_;                      // equilibrated values of matrix_
  std::vector<double> row_scale_, column_scale_;    // (n + m): D F and D E
  std::vector<double> delta_;                       // (m)
  std::vector<double> right_, residual_, unknown_;  // (n + m), equilibrated
  std::unique_ptr<NullSpace> null_g_, null_h_;      // while constraints are redundant
  double shift_ = 0;                                // delta in the factored matrix
  double suspicious_;                               // condition above which a QR is done
  KktReport report_;
};

}  // namespace tress
