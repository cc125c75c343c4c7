#pragma once

#include <Eigen/Core>

#include "experiments/statics/static_strand.h"

namespace tress::experiments::statics {

/// A direction of the coordinates and of the parameter of a path.
struct Direction {
  Eigen::VectorXd q;
  double value = 0;
};

/// Outcome of Newton's method.
struct Newton {
  bool converged = false;
  int iterations = 0;
  double last = 0;  // last correction, over the typical sizes
};

/// Newton's method for equilibria of a strand with one more condition, which chooses one
/// of a path, in the metric of equilibrium_path().
class PathNewton {
 public:
  /// Works on `strand`, which must outlive it.
  explicit PathNewton(StaticStrand& strand);

  /// Displacements without energy, by columns: corrections leave them out.
  Eigen::MatrixXd neutral;

  /// Returns the product of two directions in the metric.
  double product(const Direction& a, const Direction& b) const;
  /// Returns the row w for which w . d is product(of, d).
  Direction row(const Direction& of) const;
  /// Returns the row that keeps the parameter.
  Direction fixed() const;

  /// Leads `at` to R = 0, g = 0 and row . (at - origin) = 0.
  Newton correct(Balance& at, const Direction& row, const Balance& origin);
  /// Returns the tangent of the path whose product with `before` is positive, of length
  /// 1. Throws std::runtime_error where there is none.
  Direction tangent(const Balance& at, const Direction& before);

  /// Returns the typical sizes of the coordinates.
  const Eigen::VectorXd& size() const { return size_; }

 private:
  Eigen::MatrixXd bordered(const Balance& at, const Eigen::VectorXd& by_parameter,
                           const Direction& row);

  StaticStrand& strand_;
  Eigen::VectorXd size_;
  double range_;
};

}  // namespace tress::experiments::statics
