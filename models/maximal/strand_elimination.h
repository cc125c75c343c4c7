#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "models/maximal/elasticity.h"
#include "models/maximal/kernel/algebra.h"

namespace tress::models {

/// Solutions with the transposed matrix of a StrandElimination.
class TransposedElimination {
 public:
  virtual ~TransposedElimination() = default;
  /// Solves S^T x = b with the last factors; b and x must be different.
  virtual void solve_transposed(In b, Out x) noexcept = 0;
  /// f += D^T x with the x of the last solution and D the derivatives of the
  /// elasticity's forces by rates; over all coordinates z.
  virtual void add_by_rates(InOut f) noexcept = 0;
  /// Prepares the calls here as a solution x would, at a placement.
  virtual void place_transposed(const Placement& p, In x) noexcept = 0;
  /// Returns the constants of the elasticity, as TransposedForm::constants().
  virtual std::vector<double> constants() const = 0;
  /// Adds the products of that x with the derivatives of forces by constants to `by`.
  virtual void add_by_constants(InOut by) noexcept = 0;
};

/// S of a clamped strand by elimination from the tip to the root, O(nodes), where joints
/// couple neighbouring edges only and all other terms belong to single coordinates.
class StrandElimination {
 public:
  virtual ~StrandElimination() = default;
  /// Terms of S in addition to those of the Elasticity.
  struct Others {
    In mass;     // kg, of all nodes
    In inertia;  // of the coordinates that are not positions
    In blocks;   // of the loads on all nodes, 3 x 3 by rows; empty: none
  };
  /// Factors the matrix S. Returns false if elimination without pivoting is inaccurate or
  /// does not take these terms: S must then be assembled.
  virtual bool factor(const Placement& p, Weights w, const Others& others) noexcept = 0;
  /// Solves for the coordinates that are not prescribed; b and x may be the same.
  virtual void solve(In b, Out x) noexcept = 0;
  /// Null if there are no solutions with the transposed matrix.
  virtual TransposedElimination* transposed() { return nullptr; }
};

/// Notes whether a pivot is lost to rounding. Elimination without exchange of rows
/// amplifies roundings by entry over pivot: corrections keep half of their digits.
class StrandPivots {
 public:
  /// Notes a pivot and the entry that it is compared with.
  void operator()(double pivot, double entry) {
    constexpr double least = 1.5e-8;  // square root of a rounding
    kept_ = kept_ && std::abs(pivot) > least * std::abs(entry);
  }
  /// Returns true if no pivot was lost.
  bool kept() const { return kept_; }

 private:
  bool kept_ = true;
};

/// Adds the block of a node's load to what an elimination keeps of all beyond an edge.
/// False if its matrix is symmetric, and the block is not.
template <class Beyond>
bool add_block(const double* b, Beyond& beyond) {
  if constexpr (requires(Matrix3<double> m) { beyond.add_block(m); }) {
    beyond.add_block(Matrix3<double>{{load3(b), load3(b + 3), load3(b + 6)}});
    return true;
  } else {
    // Sums of the same terms in another order differ by a few roundoffs.
    constexpr double rounding = 1e-12;
    const auto alike = [](double a, double c, double x, double y) {
      return (a - c) * (a - c) <= rounding * rounding * std::abs(x * y);
    };
    beyond.add_block(Symmetric3<double>{b[0], b[4], b[8], b[1], b[2], b[5]});
    return alike(b[1], b[3], b[0], b[4]) && alike(b[2], b[6], b[0], b[8]) &&
           alike(b[5], b[7], b[4], b[8]);
  }
}

/// The placement at which something was computed, to see whether it is needed again:
/// Newton's method needs matrix and residual of the same.
class LastPlacement {
 public:
  /// Allocates for a number of coordinates; no placement is known.
  explicit LastPlacement(std::size_t coordinates) : z_(coordinates), rate_(coordinates) {}

  /// Returns true if this is the placement, bit by bit.
  bool is(const Placement& p) const noexcept {
    return known_ && same(p.z, z_) && same(p.rate, rate_) && same(p.root.omega, omega_) &&
           same(p.root.frame.e0, frame_.e0) && same(p.root.frame.e1, frame_.e1) &&
           same(p.root.frame.e2, frame_.e2);
  }
  /// Takes a placement.
  void take(const Placement& p) noexcept {
    std::ranges::copy(p.z, z_.begin());
    std::ranges::copy(p.rate, rate_.begin());
    frame_ = p.root.frame;
    omega_ = p.root.omega;
    known_ = true;
  }
  /// Forgets the placement.
  void forget() noexcept { known_ = false; }

 private:
  static bool same(In a, In b) {  // bits
    return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
  }
  static bool same(const Vec& a, const Vec& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }

  std::vector<double> z_, rate_;
  Frame frame_;
  Vec omega_;
  bool known_ = false;
};

}  // namespace tress::models
