#pragma once

#include "models/reduced/stiff_tangent.h"
#include "models/reduced/transport_matrix.h"

namespace tress::models {

/// The equations of ForceTransport and their elastic Jacobian, in O(n).
template <class Kernel, int dofs>
class TransportSweeps {
 public:
  using K = Kinematics<Kernel, dofs>;
  using In = typename K::In;
  using Out = std::span<typename K::Real>;

  TransportSweeps(K& kinematics, InverseDynamics<Kernel, dofs>& dynamics,
                  StiffTangent<Kernel, dofs>& mass)
      : kinematics_(kinematics),
        dynamics_(dynamics),
        mass_(mass),
        matrix_(kinematics.segments().size()),
        zero_(static_cast<std::size_t>(kinematics.unknowns())),
        restoring_(zero_) {}

  void residual(double t, In q, In v, In a, Out r) {
    dynamics_.residual(t, q, v, zero_, r);
    compose(q);
    matrix_.add_product(a, r);
  }
  Status factor(In q, Weights w) {
    kinematics_.shape(q);
    compose(q);
    return matrix_.factor(w.acc, restoring(w));
  }
  void solve(In b, Out x) { matrix_.solve(b, x); }

  /// Composite bodies at q, the state of Kinematics; kept for the next call.
  void compose(In q) {
    if (std::ranges::equal(q, composed_)) return;
    matrix_.compose(mass_.here({1, 0, 0}));
    composed_.assign(q.begin(), q.end());
  }
  In restoring(Weights w) {
    for (std::size_t i = 0; i < kinematics_.segments().size(); ++i) {
      const auto of_segment = models::restoring(kinematics_.segments()[i], w);
      for (int k = 0; k < dofs; ++k) {
        restoring_[dofs * i + static_cast<std::size_t>(k)] = dot(K::unit(k), of_segment);
      }
    }
    return restoring_;
  }
  TransportMatrix<Kernel, dofs>& matrix() { return matrix_; }

 private:
  K& kinematics_;
  InverseDynamics<Kernel, dofs>& dynamics_;
  StiffTangent<Kernel, dofs>& mass_;
  TransportMatrix<Kernel, dofs> matrix_;
  std::vector<typename K::Real> zero_, restoring_, composed_;
};

}  // namespace tress::models
