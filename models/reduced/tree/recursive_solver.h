#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>
#include <vector>

#include "models/reduced/tree/transposed_tangent.h"
#include "models/reduced/tree/tree_solver.h"

namespace tress::models {

/// Two sweeps, O(N) [Featherstone 1983; Bertails 2009]. From the free ends to the root
/// every segment eliminates its unknowns, x = u - Z s, and passes on everything below it
/// as an articulated matrix: w = L s + beta. From the root to the free ends x follows.
///
/// Symmetric problems update L by the Joseph form, with V = [I; -Z]:
///     L = V^T local V + (transfer V)^T L_tip (transfer V),
/// a sum of positive semidefinite terms. The plain form L = P - Y H^-1 Y^T, with H, Y and
/// P the blocks of local + lift L_tip transfer, reads only one half of that matrix.
/// Rounding makes L unsymmetric. Near a straight rod, where rotation about its own axis
/// moves almost no mass, every segment amplifies the asymmetry. After twenty segments no
/// digit is left (tests/models/reduced/test_solvers.cpp measures it). Averaging L with
/// L^T, or eliminating without using symmetry as for exact Jacobians, also prevents this.
///
/// A pivot may be nearly singular although the whole matrix is not. Exact Jacobians,
/// which are not definite, have such pivots by contact, wind and drag. Symmetric ones
/// have them by a joint that is soft compared with the inertia of its link, where its
/// unknowns turn the link about its own axis. Without row exchange the corresponding
/// digits are lost: up to five in 300 random exact states, eleven in soft chains. The
/// function solve() then applies iterative refinement [Higham 2002, Accuracy and
/// Stability of Numerical Algorithms, chapter 12]. A difference of a few eps cond(S)
/// remains.
template <class Shape, TreeMethod method = TreeMethod::recursive>
class RecursiveSolver final : public TreeSolver<Shape> {
 public:
  using typename TreeSolver<Shape>::In, typename TreeSolver<Shape>::Out,
      typename TreeSolver<Shape>::Load;

  /// Allocates for tangents with the parents and the root of `structure`.
  explicit RecursiveSolver(const TreeTangent<Shape>& structure)
      : eliminated_(structure.parent.size()), hanging_(structure.parent.size()) {
    if constexpr (refines) {
      const auto unknowns = static_cast<std::size_t>(structure.unknowns());
      for (auto* values : {&b_, &left_, &correction_}) values->resize(unknowns);
    }
  }

  Status factor(const TreeTangent<Shape>& tangent) noexcept override {
    tangent_ = &tangent;
    growth_ = 1;
    for (std::size_t i = 0; i < hanging_.size(); ++i) {
      hanging_[i].matrix = tangent.segments[i].tip;
    }
    Articulated at_root = Articulated::Zero();
    for (std::size_t i = hanging_.size(); i-- > 0;) {
      const int parent = tangent.parent[i];
      if (!eliminate(
              tangent.segments[i], hanging_[i].matrix, eliminated_[i],
              parent < 0 ? at_root : hanging_[static_cast<std::size_t>(parent)].matrix)) {
        return Status::retry;
      }
    }
    if (!tangent.free_root) return Status::ok;
    Eigen::Matrix<double, 6, 6> root = tangent.root.local;
    add_product(tangent.root.lift, product(at_root, tangent.root.transfer), root);
    root_.compute(root);
    const double least = root_.matrixLU().diagonal().cwiseAbs().minCoeff();
    return least > 0 && std::isfinite(least) ? Status::ok : Status::retry;
  }

  Status solve(In b, Out x) noexcept override {
    if constexpr (refines) {
      if (growth_ > most_growth) {
        refine(
            b, x, [this](In of, Out to) { sweep(of, to); },
            [this](In of) { subtract_image(of); });
        return Status::ok;
      }
    }
    sweep(b, x);
    return Status::ok;
  }

  bool solve_transposed(In b, Out x) noexcept override {
    if constexpr (transposes) {
      const auto sweep = [this](In of, Out to) { sweep_transposed(of, to); };
      if (growth_ > most_growth) {
        refine(b, x, sweep, [this](In of) {
          product_.compute(*tangent_, of, left_);
          for (std::size_t k = 0; k < left_.size(); ++k) left_[k] = b_[k] - left_[k];
        });
      } else {
        sweep(b, x);
      }
    }
    return transposes;
  }

  bool respond(std::span<const Load> loads, Out blocks) noexcept override {
    if constexpr (Shape::symmetric && method == TreeMethod::recursive) {
      return respond_of_chain(loads, blocks);
    }
    return false;
  }

 private:
  using Real = typename Shape::Real;
  // A loss of up to two digits is accepted: of exact Jacobians it occurs in a third to
  // two thirds of the states of hard cases, and does not affect Newton's iteration.
  static constexpr bool refines = !Shape::symmetric || method == TreeMethod::recursive;
  static constexpr bool transposes =
      method == TreeMethod::recursive && std::is_same_v<Real, double>;
  static constexpr double most_growth = 100, most_of_one_sweep = 1e6;
  static constexpr int states = Shape::states, wrench = Shape::wrench, n = Shape::dofs;
  using Articulated = Eigen::Matrix<Real, wrench, states>;
  using Wrench = Eigen::Matrix<Real, wrench, 1>;
  using State = Eigen::Matrix<Real, states, 1>;
  using Dofs = Eigen::Matrix<Real, n, 1>;
  using Square = Eigen::Matrix<Real, n, n>;

  struct Eliminated {
    Square inverse;                           // of the pivot H
    Eigen::Matrix<Real, n, states> z;         // x = u - z s
    Eigen::Matrix<Real, wrench, n> response;  // of the wrench passed on to rest
    Dofs u;
  };
  struct Hanging {
    Articulated matrix;  // everything beyond the tip: w = matrix s + load
    Wrench load;
    State state;  // of the tip
  };

  static std::size_t at(std::size_t i, int k) {
    return n * i + static_cast<std::size_t>(k);
  }

  void sweep(In b, Out x) noexcept {
    const TreeTangent<Shape>& tangent = *tangent_;
    for (Hanging& hanging : hanging_) hanging.load.setZero();
    Wrench at_root = Wrench::Zero();
    for (std::size_t i = hanging_.size(); i-- > 0;) {
      Eliminated& e = eliminated_[i];
      const Eigen::Matrix<Real, Shape::rows, 1> lifted =
          product(tangent.segments[i].lift, hanging_[i].load);
      Dofs rest;
      for (int k = 0; k < n; ++k) rest[k] = b[at(i, k)] - lifted[wrench + k];
      multiply<1, false>(e.inverse, rest, e.u);
      const int parent = tangent.parent[i];
      Wrench& onto =
          parent < 0 ? at_root : hanging_[static_cast<std::size_t>(parent)].load;
      add(part<wrench, 1>(lifted, 0, 0), onto);
      add_product(e.response, rest, onto);
    }
    State at_start = State::Zero();
    if (tangent.free_root) {
      const std::size_t first = Shape::dofs * hanging_.size();
      Eigen::Map<Eigen::Matrix<double, 6, 1>> y(&x[first]);
      y = root_.solve(Eigen::Map<const Eigen::Matrix<double, 6, 1>>(&b[first]) -
                      tangent.root.lift * at_root);
      at_start = product(tangent.root.transfer, y);
    }
    for (std::size_t i = 0; i < hanging_.size(); ++i) {
      const int parent = tangent.parent[i];
      const State& s =
          parent < 0 ? at_start : hanging_[static_cast<std::size_t>(parent)].state;
      const Eliminated& e = eliminated_[i];
      Eigen::Matrix<Real, Shape::columns, 1> moved;
      copy(s, part<states, 1>(moved, 0, 0));
      copy(e.u, part<n, 1>(moved, states, 0));
      subtract_product(e.z, s, part<n, 1>(moved, states, 0));
      for (int k = 0; k < n; ++k) x[at(i, k)] = moved[states + k];
      multiply<1, false>(tangent.segments[i].transfer, moved, hanging_[i].state);
    }
  }

  /// The steps of sweep() transposed, in reverse order: loads become states, and states
  /// loads.
  void sweep_transposed(In b, Out x) noexcept {
    const TreeTangent<Shape>& tangent = *tangent_;
    for (Hanging& hanging : hanging_) hanging.state.setZero();
    State at_start = State::Zero();
    for (std::size_t i = hanging_.size(); i-- > 0;) {
      Eliminated& e = eliminated_[i];
      Eigen::Matrix<Real, Shape::columns, 1> moved;
      multiply_transposed<1, false>(tangent.segments[i].transfer, hanging_[i].state,
                                    moved);
      for (int k = 0; k < n; ++k) e.u[k] = b[at(i, k)] + moved[states + k];
      const int parent = tangent.parent[i];
      State& onto =
          parent < 0 ? at_start : hanging_[static_cast<std::size_t>(parent)].state;
      add(part<states, 1>(moved, 0, 0), onto);
      multiply_transposed<-1, true>(e.z, e.u, onto);
    }
    Wrench at_root = Wrench::Zero();
    if (tangent.free_root) {
      const std::size_t first = Shape::dofs * hanging_.size();
      Eigen::Matrix<double, 6, 1> right =
          Eigen::Map<const Eigen::Matrix<double, 6, 1>>(&b[first]);
      multiply_transposed<1, true>(tangent.root.transfer, at_start, right);
      Eigen::Map<Eigen::Matrix<double, 6, 1>> y(&x[first]);
      y = root_.transpose().solve(right);
      multiply_transposed<-1, true>(tangent.root.lift, y, at_root);
    }
    for (std::size_t i = 0; i < hanging_.size(); ++i) {
      const int parent = tangent.parent[i];
      const Wrench& onto =
          parent < 0 ? at_root : hanging_[static_cast<std::size_t>(parent)].load;
      const Eliminated& e = eliminated_[i];
      Eigen::Matrix<Real, Shape::rows, 1> rows;
      copy(onto, part<wrench, 1>(rows, 0, 0));
      Dofs rest;
      multiply_transposed<1, false>(e.inverse, e.u, rest);
      multiply_transposed<1, true>(e.response, onto, rest);
      for (int k = 0; k < n; ++k) {
        x[at(i, k)] = rest[k];
        rows[wrench + k] = -rest[k];
      }
      multiply_transposed<1, false>(tangent.segments[i].lift, rows, hanging_[i].load);
    }
  }

  /// Costs O(segments + loads^2). The unknowns x beyond the tip i of a load do not feel
  /// it. There, states are passed on as s_tip = T s, T = transfer [I; -Z], and a wrench
  /// reaches the start of a segment as T^T w. So Omega, the response of a tip's state to
  /// a wrench on it, follows from the root: Omega_tip = T Omega T^T + transfer_x H^-1
  /// transfer_x^T [Wensing et al. 2012].
  bool respond_of_chain(std::span<const Load> loads, Out blocks) noexcept {
    using Response = Eigen::Matrix<Real, states, wrench>;
    const TreeTangent<Shape>& tangent = *tangent_;
    Response omega = Response::Zero();
    if (tangent.free_root) {
      const Eigen::Matrix<Real, 6, wrench> y = root_.solve(tangent.root.lift);
      omega = product(tangent.root.transfer, y);
    }
    reached_.resize(loads.size());
    std::size_t met = 0;
    const auto meet = [&](int segment) {
      if (met == loads.size() || loads[met].segment != segment) return;
      const auto& columns = loads[met].columns;
      multiply<1, false>(omega, columns, reached_[met]);
      Eigen::Matrix<Real, 3, wrench> onto;
      copy(part(columns).transpose(), onto);
      for (std::size_t of = 0; of <= met; ++of) {
        const Eigen::Matrix<Real, 3, 3> block = product(onto, reached_[of]);
        for (std::size_t r = 0; r < 3; ++r) {
          for (std::size_t c = 0; c < 3; ++c) {
            const Real value = block(static_cast<int>(r), static_cast<int>(c));
            blocks[9 * (of * loads.size() + met) + 3 * r + c] = value;
            blocks[9 * (met * loads.size() + of) + 3 * c + r] = value;
          }
        }
      }
      ++met;
    };
    meet(-1);
    for (std::size_t i = 0; i < eliminated_.size() && met < loads.size(); ++i) {
      const Eliminated& e = eliminated_[i];
      const auto of_x = part<states, n>(tangent.segments[i].transfer, 0, states);
      Response passed, pulled;
      copy(part<states, states>(tangent.segments[i].transfer, 0, 0), passed);
      subtract_product(of_x, e.z, passed);
      multiply<1, false>(passed, omega, pulled);
      multiply<1, false>(pulled, part(passed).transpose(), omega);
      Eigen::Matrix<Real, states, n> freed;
      multiply<1, false>(of_x, e.inverse, freed);
      add_product(freed, of_x.transpose(), omega);
      for (std::size_t of = 0; of < met; ++of) {
        const Eigen::Matrix<Real, states, 3> before = reached_[of];
        multiply<1, false>(passed, before, reached_[of]);
      }
      meet(static_cast<int>(i));
    }
    return true;
  }

  /// Notes how much larger than a pivot the terms are that it sums.
  template <class Own, class Pivot>
  void see_growth(const Own& own, const Pivot& pivot, const Square& inverse) {
    for (int k = 0; k < n; ++k) {
      const double part = own(k, k),
                   terms = std::abs(part) + std::abs(pivot(k, k) - part);
      growth_ = std::max(growth_, terms * std::abs(inverse(k, k)));
    }
  }

  /// Solves by sweep(b, x) with one or two steps of iterative refinement;
  /// subtract_image(x): left_ = b_ less the image of x.
  template <class Sweep, class SubtractImage>
  void refine(In b, Out x, const Sweep& sweep, const SubtractImage& subtract_image) {
    std::ranges::copy(b, b_.begin());
    sweep(b_, x);
    for (const double most : {most_growth, most_of_one_sweep}) {
      if (growth_ <= most) return;
      subtract_image(x);
      sweep(left_, correction_);
      for (std::size_t k = 0; k < correction_.size(); ++k) x[k] += correction_[k];
    }
  }

  /// left_ = b_ - S x.
  void subtract_image(In x) noexcept {
    const TreeTangent<Shape>& tangent = *tangent_;
    const std::size_t root = Shape::dofs * hanging_.size();
    State at_start = State::Zero();
    if (tangent.free_root) {
      const Eigen::Map<const Eigen::Matrix<double, 6, 1>> y(&x[root]);
      at_start = product(tangent.root.transfer, y);
    }
    const auto moved = [&](std::size_t i) {
      const int parent = tangent.parent[i];
      Eigen::Matrix<Real, Shape::columns, 1> all;
      copy(parent < 0 ? at_start : hanging_[static_cast<std::size_t>(parent)].state,
           part<states, 1>(all, 0, 0));
      for (int k = 0; k < n; ++k) all[states + k] = x[at(i, k)];
      return all;
    };
    for (std::size_t i = 0; i < hanging_.size(); ++i) {
      multiply<1, false>(tangent.segments[i].transfer, moved(i), hanging_[i].state);
      multiply<1, false>(tangent.segments[i].tip, hanging_[i].state, hanging_[i].load);
    }
    Wrench at_root = Wrench::Zero();
    for (std::size_t i = hanging_.size(); i-- > 0;) {
      const SegmentTangent<Shape>& segment = tangent.segments[i];
      Eigen::Matrix<Real, Shape::rows, 1> image = product(segment.lift, hanging_[i].load);
      add_product(segment.local, moved(i), image);
      const int parent = tangent.parent[i];
      add(part<wrench, 1>(image, 0, 0),
          parent < 0 ? at_root : hanging_[static_cast<std::size_t>(parent)].load);
      for (int k = 0; k < n; ++k) left_[at(i, k)] = b_[at(i, k)] - image[wrench + k];
    }
    if (!tangent.free_root) return;
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> y(&x[root]);
    const Eigen::Matrix<double, 6, 1> image =
        tangent.root.local * y + tangent.root.lift * at_root;
    for (std::size_t k = 0; k < 6; ++k) {
      left_[root + k] = b_[root + k] - image[static_cast<int>(k)];
    }
  }

  template <class Pivot>
  static bool invert(const Pivot& pivot, Square& inverse) {
    Square h;
    copy(pivot, h);
    if constexpr (Shape::symmetric && n > 3) {
      invert_definite(h, inverse);
    } else {
      inverse = h.inverse();
    }
    return is_finite(inverse.sum());
  }

  /// Inverts by the two halves of the unknowns. With S = D - C A^-1 C^T,
  /// [A C^T; C D]^-1 = [A^-1 + Y^T S^-1 Y, -Y^T S^-1; -S^-1 Y, S^-1], Y = C A^-1.
  static void invert_definite(const Square& h, Square& inverse) {
    constexpr int half = n / 2;
    using Quarter = Eigen::Matrix<Real, half, half>;
    Quarter a, c, across, rest;
    copy(part<half, half>(h, 0, 0), a);
    copy(part<half, half>(h, half, 0), c);
    copy(part<half, half>(h, 0, half), across);  // C^T
    copy(part<half, half>(h, half, half), rest);
    const Quarter first = a.inverse();
    const Quarter y = product(c, first), y_transposed = product(first, across);
    subtract_product(y, across, rest);
    const Quarter last = rest.inverse();
    const Quarter mixed = product(last, y);
    Quarter corner = first;
    add_product(y_transposed, mixed, corner);
    for (int j = 0; j < half; ++j) {
      for (int i = 0; i < half; ++i) {
        inverse(i, j) = corner(i, j);
        inverse(half + i, half + j) = last(i, j);
        inverse(half + i, j) = inverse(j, half + i) = Real(-1) * mixed(i, j);
      }
    }
  }

  /// Adds to `onto` the articulated matrix that the segment passes on.
  bool eliminate(const SegmentTangent<Shape>& segment, const Articulated& hanging,
                 Eliminated& e, Articulated& onto) {
    if constexpr (Shape::symmetric && method == TreeMethod::recursive) {
      return eliminate_symmetric(segment, hanging, e, onto);
    } else {
      return eliminate_general(segment, hanging, e, onto);
    }
  }

  bool eliminate_symmetric(const SegmentTangent<Shape>& segment,
                           const Articulated& hanging, Eliminated& e, Articulated& onto) {
    // Transposed: [s; x] to the tip, and in local s to x and x to x.
    const auto tip_of_s = part<states, wrench>(segment.lift, 0, 0);
    const auto tip_of_x = part<n, wrench>(segment.lift, states, 0);
    const auto own_of_x = part<states, n>(segment.local, 0, states);
    const auto inner = part<n, n>(segment.local, states, states);
    // The pivot and its coupling to s: columns x of local + transfer^T hanging transfer.
    Eigen::Matrix<Real, Shape::rows, n> of_x;
    copy(part<Shape::rows, n>(segment.local, 0, states), of_x);
    add_product(segment.lift, product(hanging, tip_of_x.transpose()), of_x);
    const auto pivot = part<n, n>(of_x, states, 0);
    if (!invert(pivot, e.inverse)) return false;
    see_growth(inner, pivot, e.inverse);
    multiply<1, false>(part<states, n>(of_x, 0, 0), e.inverse, e.response);
    copy(part(e.response).transpose(), e.z);
    // V = [I; -Z]: M V = M_s - M_x Z.
    Eigen::Matrix<Real, states, states> tip_motion;
    copy(tip_of_s, tip_motion);
    subtract_product(e.response, tip_of_x, tip_motion);
    Eigen::Matrix<Real, states, n> own;
    copy(own_of_x, own);
    subtract_product(e.response, inner, own);
    add(part<states, states>(segment.local, 0, 0), onto);
    subtract_product(own_of_x, part(e.response).transpose(), onto);
    subtract_product(e.response, part(own).transpose(), onto);
    add_product(tip_motion, product(hanging, part(tip_motion).transpose()), onto);
    for (int j = 0; j < states; ++j) {  // symmetric up to rounding; enforced here
      for (int i = 0; i < j; ++i) onto(j, i) = onto(i, j);
    }
    return true;
  }

  bool eliminate_general(const SegmentTangent<Shape>& segment, const Articulated& hanging,
                         Eliminated& e, Articulated& onto) {
    const auto full = with_hanging(segment, hanging);
    const auto pivot = part<n, n>(full, wrench, states);
    const auto r_of_s = part<n, states>(full, wrench, 0);
    const auto w_of_x = part<wrench, n>(full, 0, states);
    add(part<wrench, states>(full, 0, 0), onto);
    if (!invert(pivot, e.inverse)) return false;
    if constexpr (refines) {
      see_growth(part<n, n>(segment.local, wrench, states), pivot, e.inverse);
    }
    if constexpr (method == TreeMethod::recursive_plain) {
      multiply<1, false>(e.inverse, w_of_x.transpose(), e.z);
      copy(part(e.z).transpose(), e.response);
      subtract_product(w_of_x, e.z, onto);
      return true;
    }
    multiply<1, false>(e.inverse, r_of_s, e.z);
    Square used = e.inverse;
    if constexpr (method == TreeMethod::elastic_local) {
      // Friction and stiffness of distal segments are not passed on.
      Square bare;
      copy(pivot, bare);
      for (int k = 0; k < n; ++k) bare(k, k) -= segment.stiffness[k];
      if (!invert(bare, used)) return false;
    }
    multiply<1, false>(w_of_x, used, e.response);
    subtract_product(e.response, r_of_s, onto);
    return true;
  }

  const TreeTangent<Shape>* tangent_ = nullptr;
  std::vector<Eliminated> eliminated_;
  std::vector<Hanging> hanging_;
  Eigen::PartialPivLU<Eigen::Matrix<double, 6, 6>> root_;
  std::vector<Eigen::Matrix<Real, states, 3>> reached_;  // scratch of respond()
  double growth_ = 0;  // largest product of a pivot's inverse and the terms that it sums
  std::vector<Real> b_, left_, correction_;  // scratch of refine()
  // For the refinement of solve_transposed().
  [[no_unique_address]] std::conditional_t<transposes, TransposedProduct<Shape>,
                                           std::monostate>
      product_;
};

}  // namespace tress::models
