#pragma once

#include <Eigen/Core>
#include <vector>

#include "contract/forms/sparse_form.h"
#include "contract/system.h"
#include "linear/dense_lu.h"

namespace tress::models {

/// Returns the pattern of a full matrix (n x n).
Pattern full_pattern(int n);

/// S(w) as a full matrix, of systems that only solve with it. The mass matrix follows
/// column by column from the residual, which is affine in the acceleration. Any other S
/// is the inverse of the solutions for unit vectors; without w.acc, less the inertia that
/// makes it regular. Cost: 2 n residuals, or n solves and 2 n^3 operations.
class DenseTangent final : public SparseForm {
 public:
  /// Works on `system`, which must outlive it.
  explicit DenseTangent(System& system);

  const Pattern& pattern() const override { return full_; }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override;

 private:
  Status mass(double t, In q, double factor, Out s) noexcept;
  Status without_mass(double t, In q, In v, In a, Weights w, Out s) noexcept;

  System& system_;
  Pattern full_;
  Eigen::VectorXd typical_;                          // sizes of the coordinates
  double rate_ = 0;                                  // largest typical one, 1/s
  std::vector<double> a_typ_, zero_, unit_, ahead_;  // scratch
  std::vector<double> inertia_;                      // scratch of without_mass()
  Eigen::MatrixXd compliance_;
  DenseLu lu_;
};

}  // namespace tress::models
