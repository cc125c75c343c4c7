#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

#include "models/reduced/kinematics.h"
#include "models/reduced/mass_tangent.h"
#include "models/reduced/stiff_tangent.h"

namespace tress::models {

/// M_ft of ForceTransport: the block lower triangle, diagonal included, of the mass
/// matrix of a chain of rigid links with ball joints:
///
///     (M_ft a)_j = S_j^T I_j (c_j + S_j a_j)
///
/// I_j is the composite inertia of link j and all beyond it as one rigid body. S_j holds
/// the axes of joint j. Both are in the frame at the start of link j, and c_j is the
/// acceleration of that frame due to the joints before it. Frames, wrenches
/// and blocks are as in TreeTangent. Products and solves are sweeps from the root, O(N).
template <class Kernel, int dofs>
class TransportMatrix {
  using Real = typename Kernel::Real;
  using In = std::span<const Real>;
  using Out = std::span<Real>;
  using Shape = MassShape<dofs, Real>;
  using Dofs = Eigen::Matrix<Real, dofs, 1>;

 public:
  /// Allocates for this number of segments.
  explicit TransportMatrix(std::size_t segments)
      : full_(segments), inverse_(segments), start_(segments + 1) {}

  /// Sums composite bodies from the mass tangent at weights {1, 0, 0}, which must outlive
  /// all further calls.
  void compose(const TreeTangent<Shape>& mass) {
    mass_ = &mass;
    Inertia hanging;
    for (std::size_t i = full_.size(); i-- > 0;) {
      const SegmentTangent<Shape>& segment = mass.segments[i];
      hanging = segment.tip;
      if (i + 1 < full_.size()) add(inertia(i + 1), hanging);
      full_[i] = with_hanging(segment, hanging);
    }
  }

  /// Adds M_ft a to r.
  void add_product(In a, Out r) {
    sweep(a);
    for (std::size_t i = 0; i < full_.size(); ++i) {
      const auto equation = at(r, i);
      models::add_product(coupling(i), start_[i], equation);
      models::add_product(own(i), at(a, i), equation);
    }
  }

  /// Factors acc M_ft + diagonal for solve(); `retry` if a pivot is not usable.
  Status factor(double acc, In diagonal) {
    acc_ = acc;
    for (std::size_t i = 0; i < full_.size(); ++i) {
      Square pivot;
      copy(own(i), pivot);
      for (int j = 0; j < dofs; ++j) {
        for (int k = 0; k < dofs; ++k) pivot(k, j) = Real(acc) * pivot(k, j);
        pivot(j, j) += at(diagonal, i)[j];
      }
      inverse_[i] = pivot.inverse();
      if (!is_finite(inverse_[i].sum())) return Status::retry;
    }
    return Status::ok;
  }

  /// Solves (acc M_ft + diagonal) x = b with the last factors.
  void solve(In b, Out x) {
    start_[0].setZero();
    for (std::size_t i = 0; i < full_.size(); ++i) {
      const Dofs coupled = product(coupling(i), start_[i]);
      Dofs rest;
      for (int k = 0; k < dofs; ++k) rest[k] = at(b, i)[k] - acc_ * coupled[k];
      const auto unknowns = at(x, i);
      multiply<1, false>(inverse_[i], rest, unknowns);
      move(i, start_[i], unknowns, start_[i + 1]);
    }
  }

  /// Adds factor M_ft to `dense`.
  void add_dense(double factor, Eigen::MatrixXd& dense) const {
    for (std::size_t m = 0; m < full_.size(); ++m) {
      add(own(m), block(dense, m, m), factor);
      add_below(m, scaled(factor, from_axes(m)), dense);
    }
  }

  /// Adds factor d(M_ft a)/dq to `dense`. A rotation of joint m moves everything beyond
  /// it as one body. For the twist xi = S_m e its motions change by xi x, its wrenches by
  /// xi x*. So for j < m the composite inertia I_j changes by that of I_m,
  ///
  ///     dI_m b = xi x* (I_m b) - I_m (xi x b).
  ///
  /// The links before m do not move, so c_j changes for j > m only. At the start of link
  /// m the change is -xi x (c_m + S_m a_m) + dS_m a_m. It is passed on rigidly.
  void add_slope(const Kinematics<Kernel, dofs>& kinematics, double factor, In a,
                 Eigen::MatrixXd& dense) {
    sweep(a);
    for (std::size_t m = 0; m < full_.size(); ++m) {
      const auto& g = kinematics.geometry(m);
      const Vec second = Kinematics<Kernel, dofs>::components(a, m);
      Vec turning;
      for (int k = 0; k < dofs; ++k) turning = turning + component(second, k) * g.turn[k];
      State motion = start_[m];
      Frames::put(translation(motion), rotation(motion) + turning, motion);
      const State wrench = product(inertia(m), motion);

      Axes change;  // of the motion, by each unknown
      for (int l = 0; l < dofs; ++l) {
        const Vec e = Kinematics<Kernel, dofs>::unit(l);
        State turned;
        Frames::put({}, g.kernel.dW(e, second).at(g.tip), turned);
        const auto by_l = column_of(change, l);
        copy(turned, by_l);
        add(crossed(g.turn[l], motion), by_l, -1);
        State load = crossed(g.turn[l], wrench);
        models::add_product(inertia(m), by_l, load);
        for (int k = 0; k < dofs; ++k) {
          const Vec axis = Kinematics<Kernel, dofs>::unit(k);
          block(dense, m, m)(k, l) +=
              factor * (dot(g.turn[k], rotation(load)) +
                        dot(g.kernel.dW(e, axis).at(g.tip), rotation(wrench)));
        }
      }
      add_below(m, scaled(factor, product(rigid(m), change)), dense);
      add_right(kinematics, m, factor, dense);
    }
  }

 private:
  using Vec = Vec3<Real>;
  using S = Space<dofs>;
  using Frames = SegmentFrames<Shape>;
  static constexpr int size = S::size;
  using Inertia = Eigen::Matrix<Real, size, size>;
  using State = Eigen::Matrix<Real, size, 1>;
  using Axes = Eigen::Matrix<Real, size, dofs>;
  using Square = Eigen::Matrix<Real, dofs, dofs>;

  template <class T>
  static Part<T, dofs, 1> at(std::span<T> x, std::size_t i) {
    return {&x[dofs * i], 1, dofs};
  }
  template <class A>
  static Axes scaled(double factor, const A& a) {
    Axes b = Axes::Zero();
    add(a, b, factor);
    return b;
  }
  static Real component(const Vec& x, int k) {
    return dot(Kinematics<Kernel, dofs>::unit(k), x);
  }

  static auto block(Eigen::MatrixXd& dense, std::size_t row, std::size_t column) {
    return part<dofs, dofs>(dense, dofs * static_cast<int>(row),
                            dofs * static_cast<int>(column));
  }

  // For joint i: composite inertia, coupling of the start's motion to its equation, and
  // its own term; motion of the tip due to its unknowns, and due to the start.
  auto inertia(std::size_t i) const { return part<size, size>(full_[i], 0, 0); }
  auto coupling(std::size_t i) const { return part<dofs, size>(full_[i], size, 0); }
  auto own(std::size_t i) const { return part<dofs, dofs>(full_[i], size, size); }
  auto from_axes(std::size_t i) const {
    return part<size, dofs>(mass_->segments[i].transfer, 0, size);
  }
  auto rigid(std::size_t i) const {
    return part<size, size>(mass_->segments[i].transfer, 0, 0);
  }

  /// The motion of link i's tip, given that of its start.
  template <class X>
  void move(std::size_t i, const State& start, const X& x, State& tip) const {
    multiply<1, false>(rigid(i), start, tip);
    models::add_product(from_axes(i), x, tip);
  }
  void sweep(In a) {
    start_[0].setZero();
    for (std::size_t i = 0; i < full_.size(); ++i) {
      move(i, start_[i], at(a, i), start_[i + 1]);
    }
  }

  static Vec translation(const State& s) {
    return spread(s, S::translation, 0, S::translations);
  }
  static Vec rotation(const State& s) {
    return spread(s, S::rotation, S::translations, S::rotations);
  }
  static Vec spread(const State& s, const int* axes, int first, int count) {
    Real x[3] = {};
    for (int i = 0; i < count; ++i) x[axes[i]] = s[first + i];
    return {x[0], x[1], x[2]};
  }
  /// phi x of a motion or a wrench about the same point.
  static State crossed(const Vec& phi, const State& s) {
    State turned;
    Frames::put(cross(phi, translation(s)), cross(phi, rotation(s)), turned);
    return turned;
  }

  /// Block column m below the diagonal, due to motions of the tip of link m.
  void add_below(std::size_t m, Axes motion, Eigen::MatrixXd& dense) const {
    for (std::size_t j = m + 1; j < full_.size(); ++j) {
      models::add_product(coupling(j), motion, block(dense, j, m));
      motion = product(rigid(j), motion);
    }
  }

  /// Block row j of the slope beyond the diagonal; after sweep().
  void add_right(const Kinematics<Kernel, dofs>& kinematics, std::size_t j, double factor,
                 Eigen::MatrixXd& dense) const {
    State motion = start_[j + 1];
    Axes axes = scaled(factor, from_axes(j));
    for (std::size_t m = j + 1; m < full_.size(); ++m) {
      const State wrench = product(inertia(m), motion);
      Axes change;
      for (int l = 0; l < dofs; ++l) {
        const Vec& turn = kinematics.geometry(m).turn[l];
        const auto by_l = column_of(change, l);
        copy(crossed(turn, wrench), by_l);
        subtract_product(inertia(m), crossed(turn, motion), by_l);
      }
      const Eigen::Matrix<Real, dofs, size> onto = axes.transpose();
      models::add_product(onto, change, block(dense, j, m));
      motion = product(rigid(m), motion);
      axes = product(rigid(m), axes);
    }
  }

  const TreeTangent<Shape>* mass_ = nullptr;
  std::vector<Eigen::Matrix<Real, Shape::rows, Shape::columns>> full_;
  std::vector<Square> inverse_;
  std::vector<State> start_;  // motion of each link's start, and of the last tip
  Real acc_{};
};

/// The equations of ForceTransport and their elastic Jacobian, in O(n).
template <class Kernel, int dofs>
class TransportSweeps {
  using K = Kinematics<Kernel, dofs>;
  using In = typename K::In;
  using Out = std::span<typename K::Real>;

 public:
  /// Works on the kinematics, dynamics and mass of a chain, which must outlive it.
  TransportSweeps(K& kinematics, InverseDynamics<Kernel, dofs>& dynamics,
                  StiffTangent<Kernel, dofs>& mass)
      : kinematics_(kinematics),
        dynamics_(dynamics),
        mass_(mass),
        matrix_(kinematics.segments().size()),
        zero_(static_cast<std::size_t>(kinematics.unknowns())),
        restoring_(zero_) {}

  /// Writes the residual r, as System::residual().
  void residual(double t, In q, In v, In a, Out r) {
    dynamics_.residual(t, q, v, zero_, r);
    compose(q);
    matrix_.add_product(a, r);
  }
  /// Factors the elastic Jacobian S(w) at q; `retry` if a pivot is not usable.
  Status factor(In q, Weights w) {
    kinematics_.shape(q);
    compose(q);
    return matrix_.factor(w.acc, restoring(w));
  }
  /// Solves S(w) x = b with the last factors.
  void solve(In b, Out x) { matrix_.solve(b, x); }

  /// Sums composite bodies at q, the state of Kinematics, unless they are those of the
  /// last call.
  void compose(In q) {
    if (std::ranges::equal(q, composed_)) return;
    matrix_.compose(mass_.here({1, 0, 0}));
    composed_.assign(q.begin(), q.end());
  }
  /// Returns the diagonal of friction and elasticity, w.vel C + w.pos K.
  In restoring(Weights w) {
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      const auto of_segment = models::restoring(kinematics_.segments()[i], w);
      for (int k = 0; k < dofs; ++k) {
        restoring_[dofs * i + static_cast<std::size_t>(k)] = dot(K::unit(k), of_segment);
      }
    }
    return restoring_;
  }
  /// Returns M_ft, as composed last.
  TransportMatrix<Kernel, dofs>& matrix() { return matrix_; }

 private:
  K& kinematics_;
  InverseDynamics<Kernel, dofs>& dynamics_;
  StiffTangent<Kernel, dofs>& mass_;
  TransportMatrix<Kernel, dofs> matrix_;
  std::vector<typename K::Real> zero_, restoring_, composed_;
};

}  // namespace tress::models
