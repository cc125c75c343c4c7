#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contract/forms/explicit_form.h"
#include "contract/forms/moving_history.h"
#include "integrators/gradient/contact_columns.h"
#include "integrators/gradient/linearized.h"

namespace tress::integrators {

/// The variational equations of a run: the derivatives (dq, dv) of its state by P
/// parameters as P columns of n coordinates, one behind the other, with
///
///     r_q dq + r_v dv + r_a da + dr/ds = 0
///
/// at the solutions of the run's stages. A Runge-Kutta, multistep or generalized-alpha
/// method is linear algebra around the solution of its stages. The same method with the
/// same steps on these equations therefore gives the exact derivative of its own run.
/// Sources: [Hairer, Lubich, Wanner, Geometric Numerical Integration, 2nd ed., VI.4.1]
/// for Runge-Kutta methods and [Bock 1981] for multistep methods.
///
/// The residual is that of these equations times S^-1 (Linearized::excess()) with the
/// S(w) of the last linearize(), so that the matrix is the identity. Constraints g(q) = 0
/// (index 3) are solved for in it: seen from outside the columns are not constrained. The
/// equations are linear, and one correction from any guess gives their solution, which
/// Newton's method must not repeat: it needs a tolerance that any correction meets.
///
/// Accelerations at a start are those of M da = -(r_q dq + r_v dv + dr/ds). The maps of
/// History::accept() and MovingHistory::carry() are differentiated by the stencils.
///
/// Exact contact: the method moves the places of points along bodies as it moves q
/// (ContactColumns), and their forces follow from the laws (ContactDerivative).
///
/// A stage costs one linearization, however many the columns are. Each column costs two
/// residuals at the stage's own q (or products with the matrices of SparseForm), the
/// residuals of its stencil (none, one or four) and a solution.
class VariationalSystem final : public System,
                                private ExplicitForm,
                                private MovingHistory {
 public:
  /// `system`: the one of the run, with the exact Jacobian; it follows the run. `run`
  /// records it. `forces`, `copies`: as ResidualDerivative. All must outlive this.
  VariationalSystem(const WatchedSystem& run, System& system,
                    std::span<const VariedSystem> varied, const Options& options,
                    KnownForces forces, System* copies);

  /// Writes the columns of initial_state().
  void initial_state(Out dq, Out dv) const override;
  /// The run has come to this state by the step that its record holds, or starts there.
  void follow(double t, In q, In v);
  /// Returns the derivatives of exact contact; null: there is none.
  ContactDerivative* contacts() { return contacts_ ? &*contacts_ : nullptr; }
  /// Returns the state at which the last step of the run began.
  const WatchedSystem::Motion& step_start() const { return from_; }
  /// Why a step failed beyond its equations; empty: nothing did.
  const std::string& failure() const { return failure_; }

  Layout layout() const override { return {static_cast<int>(columns() * n_), 0}; }
  Traits traits() const override { return {}; }
  void scale(Out q_typ, Out v_typ) const override;
  Status residual(double t, In dq, In dv, In da, Out r) noexcept override;
  Status linearize(double t, In dq, In dv, In da, Weights w) noexcept override;
  Status solve(In b, Out x) noexcept override;
  ExplicitForm* explicit_form() override { return this; }
  History* history() override { return system_.history() == nullptr ? nullptr : this; }
  ContactForm* contact_form() override {
    return contact_columns_ ? &*contact_columns_ : nullptr;
  }

 private:
  Status acceleration(double t, In dq, In dv, Out da) noexcept override;
  bool accept(double t, InOut dq, InOut dv) override;
  bool carry(double t, InOut dq, InOut dv, InOut da) const override;
  std::string not_smooth() const override { return {}; }
  void reset() override {}
  std::vector<double> memory() const override { return {}; }
  void recall(In /*memory*/) override {}

  std::size_t columns() const { return varied_.size(); }
  In column(In x, std::size_t k) const { return x.subspan(k * n_, n_); }
  Out column(Out x, std::size_t k) const { return x.subspan(k * n_, n_); }
  Linearized& at_start() { return starts_ ? *starts_ : stages_; }
  Status look_at(double t) noexcept;

  const WatchedSystem& run_;
  System& system_;
  std::span<const VariedSystem> varied_;
  std::size_t n_;
  Linearized stages_;
  std::optional<Linearized> starts_;  // with g'' = 0, where there are constraints
  std::optional<ContactDerivative> contacts_;
  std::optional<ContactColumns> contact_columns_;
  std::vector<double> laws_;            // of contact, of all columns
  WatchedSystem::Motion start_, from_;  // from_: where the last step of the run began
  double looked_at_ = 0;                // of the record
  bool looked_ = false;
  mutable std::size_t carried_ = 0;
  std::string failure_;
};

}  // namespace tress::integrators
