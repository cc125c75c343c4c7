#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "contract/basics.h"
#include "contract/forms/material_points.h"
#include "contract/pattern.h"
#include "linear/block_matrix.h"
#include "linear/linear_solver.h"
#include "models/coupling/coupling.h"

namespace tress::models {

/// Numbers of the four points of a contact.
using CoupledPoints = std::array<std::size_t, 4>;
/// Returns the numbers of a contact's points.
inline CoupledPoints points_of(const Coupling& contact) {
  const auto& e = contact.ends;
  return {e[0].point, e[1].point, e[2].point, e[3].point};
}

/// Solves with matrices of fixed pattern, one after the other on the diagonal, plus the
/// contacts between distant points, by KLU. The pattern follows the contacts.
class CoupledSolver {
 public:
  /// a point as a mean of coordinates.
  using Mean = MaterialPoints::Mean;

  /// `uncoupled` must outlive this; `means` are the contact points, over all coordinates.
  CoupledSolver(std::vector<const Pattern*> uncoupled, std::vector<Mean> means);

  /// Contacts may be added for the points that `points_of` gives for each entry of `all`.
  /// If they are not the points of before, allocates and analyses again.
  template <class Entries, class PointsOf>
  void touch(const Entries& all, PointsOf points_of) {
    touching_.clear();
    for (const auto& entry : all) touching_.push_back(points_of(entry));
    follow();
  }

  // The matrix as a sum, then its factors.
  /// Sets the matrix to 0.
  void clear() noexcept;
  /// Adds the values of a matrix on the diagonal, in the order of its pattern.
  void add(std::size_t uncoupled, In values) noexcept;
  /// Less w.pos and w.vel times the contact's derivatives.
  void add(const Coupling& contact, Weights w) noexcept;
  /// Factors the sum; `retry` if it is singular.
  Status factor() noexcept;
  /// Solves with the last factors; b becomes the solution.
  Status solve(InOut b) noexcept { return solver_->solve(b); }

 private:
  void follow();

  std::vector<const Pattern*> uncoupled_;
  std::vector<Mean> means_;
  std::vector<CoupledPoints> touching_, touched_;  // current, and in the pattern
  Pattern coupling_;
  std::vector<double> coupling_values_;
  std::unique_ptr<BlockMatrix> matrix_;  // the uncoupled ones, then the coupling
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace tress::models
