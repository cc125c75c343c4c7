#pragma once

#include <vector>

#include "contract/basics.h"

namespace tress::integrators {

/// Broyden's good rank-one updates of a matrix by the steps of Newton's iteration with
/// it, in the product form of [Deuflhard 2011, Newton Methods for Nonlinear Problems,
/// section 2.1.4]. An update costs two products of vectors in each of the next steps.
/// Convergence with an old or incomplete matrix is then faster with every step instead of
/// linear.
class SecantUpdates {
 public:
  /// `typical`: sizes of the unknowns, by which they are compared. It must outlive this.
  explicit SecantUpdates(In typical);

  /// The matrix is another one.
  void forget() noexcept;
  /// The next step is from another point than where the last one ended.
  void begin() noexcept { follows_ = false; }
  /// `step`: as the matrix gives it; in return as the updated one does.
  void improve(InOut step) noexcept;

 private:
  struct Update {
    std::vector<double> step, before;  // before: over its square
  };
  double product(In x, In y) const noexcept;

  In typical_;
  std::vector<Update> updates_;
  std::size_t count_ = 0;
  std::vector<double> last_;
  bool follows_ = false;  // last_ is the step before this one
};

}  // namespace tress::integrators
