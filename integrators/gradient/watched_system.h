#pragma once

#include <span>
#include <vector>

#include "contract/forms/moving_history.h"
#include "contract/forms/stage_watcher.h"
#include "contract/system.h"

namespace tress::integrators {

/// A system that records what derivatives of its run need: the solutions of stages, and
/// what History::accept() and MovingHistory::carry() were given since the last forget().
/// All else it passes on.
class WatchedSystem final : public System, public StageWatcher, private MovingHistory {
 public:
  /// State with its accelerations and multipliers.
  struct Motion {
    double t = 0;                 // time, s
    std::vector<double> q, v, a;  // coordinates, rates and accelerations (n)
    std::vector<double> lambda;   // multipliers of the constraints (m)
    /// Exact contact of a stage.
    struct Contact {
      double tau = 0;                  // as q0, v0, x0: arguments of ContactForm::begin()
      std::vector<double> q0, v0, x0;  // the state from which the motion continues
      std::vector<double> multipliers;  // multipliers of the solution
    };
    Contact contact = {};  // empty without exact contact
  };

  /// `system` must outlive it.
  explicit WatchedSystem(System& system) : system_(system) {}

  /// Solutions in the order in which they were found.
  std::span<const Motion> stages() const { return stages_.all(); }
  /// Returns the states that carry() was given and could carry, in order.
  std::span<const Motion> carried() const { return carried_.all(); }
  /// The state that accept() was given, and its answer.
  const Motion& accepted() const { return accepted_; }
  /// Returns the answer of the last accept(): whether it changed the equations.
  bool moved() const { return moved_; }
  /// Begins a new record.
  void forget() { stages_.count = carried_.count = 0; }

  Layout layout() const override { return system_.layout(); }
  Traits traits() const override { return system_.traits(); }
  void initial_state(Out q, Out v) const override { system_.initial_state(q, v); }
  void scale(Out q_typ, Out v_typ) const override { system_.scale(q_typ, v_typ); }
  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    return system_.residual(t, q, v, a, r);
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    return system_.linearize(t, q, v, a, w);
  }
  Status solve(In b, Out x) noexcept override { return system_.solve(b, x); }
  double next_breakpoint(double t) const override { return system_.next_breakpoint(t); }
  std::string not_finite(double t, In q, In v) override {
    return system_.not_finite(t, q, v);
  }
  SparseForm* sparse_form() override { return system_.sparse_form(); }
  ExplicitForm* explicit_form() override { return system_.explicit_form(); }
  ConstraintForm* constraint_form() override { return system_.constraint_form(); }
  ComplianceForm* compliance_form() override { return system_.compliance_form(); }
  StressForm* stress_form() override { return system_.stress_form(); }
  Energetics* energetics() override { return system_.energetics(); }
  MaterialPoints* material_points() override { return system_.material_points(); }
  ContactForm* contact_form() override { return system_.contact_form(); }
  History* history() override { return system_.history() == nullptr ? nullptr : this; }

  void solved(double t, In q, In v, In a, In lambda) noexcept override;
  void prepared(double tau, In q0, In v0, In x0) noexcept override;

 private:
  /// Motions whose storage is used again.
  struct Motions {
    std::vector<Motion> storage;
    std::size_t count = 0;

    std::span<const Motion> all() const { return {storage.data(), count}; }
    void add(double t, In q, In v, In a, In lambda);
  };

  bool accept(double t, InOut q, InOut v) override;
  bool carry(double t, InOut q, InOut v, InOut a) const override;
  std::string not_smooth() const override { return tress::not_smooth(system_); }
  void reset() override { system_.history()->reset(); }
  std::vector<double> memory() const override { return system_.history()->memory(); }
  void recall(In memory) override { system_.history()->recall(memory); }

  System& system_;
  Motions stages_;
  mutable Motions carried_;
  Motion accepted_;
  Motion::Contact contact_;  // of the next solution
  bool moved_ = false;
};

}  // namespace tress::integrators
