#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "models/reduced/tree/block_product.h"

namespace tress::models {

/// Size of a reduced-coordinate linear problem. Every segment passes `states` numbers
/// from its start to its tip, returns a wrench of `wrench` numbers, and has `dofs`
/// unknowns of its own. Symmetric problems (mass, friction and stiffness only) have
/// states == wrench: the acceleration of the frame. The exact Jacobian carries
/// displacement, velocity and acceleration: states == 3 wrench. Real = Pack: four
/// problems side by side.
template <int states_, int wrench_, int dofs_, class Real_ = double>
struct TreeShape {
  using Real = Real_;                     // scalar: a number, or a pack of SIMD lanes
  static constexpr int states = states_;  // numbers of a state
  static constexpr int wrench = wrench_;  // numbers of a wrench
  static constexpr int dofs = dofs_;      // unknowns of a segment
  static constexpr int columns = states + dofs;        // numbers of [s; x]
  static constexpr int rows = wrench + dofs;           // numbers of [w; r]
  static constexpr bool symmetric = states == wrench;  // whether S is symmetric

  /// Matrix of scalars with r rows and c columns.
  template <int r, int c>
  using Matrix = Eigen::Matrix<Real, r, c>;
};

/// Linearised equations of one segment: with s the state at its start, x its unknowns and
/// w_tip the wrench on its tip,
///
///     s_tip = transfer [s; x]
///     [w; r] = local [s; x] + lift w_tip
///     w_tip = tip s_tip + sum of the children's w
///
/// and the equations to solve are r = b. Symmetric: lift = transfer^T, local and tip are
/// symmetric. Exact: transfer maps displacement to displacement, velocity to velocity and
/// acceleration, acceleration to acceleration. In the plane, where a rotation changes the
/// components of the clamp's omega, it also maps displacement to acceleration.
/// `stiffness` is the diagonal part of local from friction and elasticity.
template <class Shape>
struct SegmentTangent {
  /// Matrix of scalars with r rows and c columns.
  template <int r, int c>
  using Matrix = typename Shape::template Matrix<r, c>;

  Matrix<Shape::states, Shape::columns> transfer;  // [s; x] to s_tip
  Matrix<Shape::rows, Shape::columns> local;       // [s; x] to [w; r]
  Matrix<Shape::wrench, Shape::states> tip;        // s_tip to w_tip
  Matrix<Shape::rows, Shape::wrench> lift;         // w_tip to [w; r]
  Matrix<Shape::dofs, 1> stiffness;                // part of the diagonal of local
};

/// Adds m transfer to c, where m has one column per state; skips the zero blocks of
/// transfer.
template <class M, class Shape, class C>
void add_pulled(const M& m, const SegmentTangent<Shape>& segment, C& c) {
  constexpr int size = Shape::wrench, levels = Shape::states / size;
  constexpr int rows = M::RowsAtCompileTime;
  const auto add = [&](int from, int to) {
    multiply<1, true, rows, size, size>(
        m.data() + rows * size * from, rows,
        segment.transfer.data() + size * from + Shape::states * size * to, 1,
        Shape::states, c.data() + rows * size * to, rows);
  };
  for (int level = 0; level < levels; ++level) add(level, level);
  if constexpr (levels == 3) add(2, 1);
  if constexpr (levels == 3 && size == 3) add(2, 0);  // in the plane
  multiply<1, true, rows, Shape::states, Shape::dofs>(
      m.data(), rows, segment.transfer.data() + Shape::states * Shape::states, 1,
      Shape::states, c.data() + rows * Shape::states, rows);
}

/// Maps [s; x] of a segment to its [w; r], with the wrench `hanging` s_tip on its tip:
/// local + lift hanging transfer.
template <class Shape>
auto with_hanging(
    const SegmentTangent<Shape>& segment,
    const typename Shape::template Matrix<Shape::wrench, Shape::states>& hanging) {
  typename Shape::template Matrix<Shape::wrench, Shape::columns> pulled;
  pulled.setZero();
  add_pulled(hanging, segment, pulled);
  typename Shape::template Matrix<Shape::rows, Shape::columns> full = segment.local;
  add_product(segment.lift, pulled, full);
  return full;
}

/// Jacobian of a free root. Its 6 unknowns y give the state s = transfer y at the start
/// of the first segments, and satisfy local y + lift (sum of their w) = b.
template <class Shape>
struct RootTangent {
  /// Matrix of scalars with r rows and c columns.
  template <int r, int c>
  using Matrix = typename Shape::template Matrix<r, c>;

  Matrix<Shape::states, 6> transfer;  // y to s
  Matrix<6, 6> local;                 // y to its equations
  Matrix<6, Shape::wrench> lift;      // sum of w to the equations of y
};

/// Contribution of one contact between segments (Coupling): with y = sum by_a [s_a; x_a]
/// over its ends, [w_a; r_a] += onto_a y.
template <class Shape>
struct TreeCoupling {
  static constexpr int rank = 4;  // numbers of y
  /// One end of the contact.
  struct End {
    int segment;                                               // index of the segment
    typename Shape::template Matrix<rank, Shape::columns> by;  // [s; x] to y
    typename Shape::template Matrix<Shape::rows, rank> onto;   // y to [w; r]
  };
  std::array<End, 4> ends;  // ends of the contact
};

/// Input of a tree solver. Unknowns are ordered by segment, the root's last.
template <class Shape>
struct TreeTangent {
  std::vector<int> parent;  // per segment, an earlier one; -1: the root
  std::vector<SegmentTangent<Shape>> segments;  // equations of all segments
  RootTangent<Shape> root;                      // read when free_root
  bool free_root = false;                       // whether the root has 6 unknowns
  std::vector<TreeCoupling<Shape>> couplings;   // for TreeMethod::composite only

  /// Returns the number of unknowns, a free root's included.
  int unknowns() const {
    return static_cast<int>(parent.size()) * Shape::dofs + (free_root ? 6 : 0);
  }
};

}  // namespace tress::models
