#include <algorithm>
#include <cmath>

#include "contract/forms/energetics.h"
#include "integrators/control/impulsive.h"
#include "integrators/entry.h"
#include "integrators/esdirk43.h"
#include "integrators/fixed_step.h"
#include "integrators/tr_bdf2.h"

namespace tress::integrators {
namespace {

/// A part of the kinetic energy by which a sound step may gain energy. In hard_cases a
/// fifth instead changes the outcome of 7 runs in 580.
constexpr double gain_part = 0.02;
/// Rounding of the energies over their size.
constexpr double rounding = 1e-9;
/// Largest number of backward Euler steps in place of one step.
constexpr int most_parts = 16;

/// An L-stable step of order 2 or 4. A backward Euler step replaces it where its
/// equations have no solution, or where the energy grows by more than the work done.
/// Where that step has no solution either, 2, 4, ... equal ones replace it. The energy
/// grows if
///
///     E_{n+1} > E_n + h max(0, P_n, P_i, P_{n+1}) + 0.02 max(T_n, T_{n+1})
///
/// with the energy E, its kinetic part T and the power P of Energetics, where i runs over
/// the stages. A root may move, and a force act, in the middle of a step alone. The order
/// is that of the method while no step is replaced.
class Guarded final : public FixedStep, public Impulsive {
 public:
  Guarded(System& system, const Options& options, const EsdirkTable& table)
      : FixedStep(system, options),
        stages_(dynamics_, options, table, {}),
        q_part_(q_),
        v_part_(v_),
        energetics_(system.energetics()) {
    if (energetics_ != nullptr) stages_.measure(*energetics_);
  }

  std::vector<InOut> state() override { return {q_, v_, a_}; }

 private:
  /// Energies (J) and power (W) at a state.
  struct Account {
    Energy energy;
    double power = 0;
  };

  Account account(double t, In q, In v) {
    if (energetics_ == nullptr) return {};
    return {energetics_->energy(t, q, v), energetics_->power(t, q, v)};
  }

  Status reset(double t) override { return dynamics_.accelerate(t, q_, v_, a_, lambda_); }

  Status go_on(In q, In v) override {
    stages_.forget();
    const Status s = replace(q, v);
    return s == Status::ok ? reset(time()) : s;
  }
  void lose_matrix() override { dynamics_.lose_matrix(); }

  Status step(double t, double h) override {
    const double gently = Stage::gentle_speed(h);
    Status s = stages_.step(t, h, q_, v_, a_, lambda_, gently);
    if (s == Status::fatal) return s;
    if (s == Status::retry || gains(t, h)) {
      ++dynamics_.stats.replaced;
      dynamics_.reached = 0;
      s = replaced(t, h, gently);
    }
    take_end(stages_);
    return s;
  }

  /// Takes the fewest backward Euler steps whose solutions are found, one with the whole
  /// effort or several with the plain one.
  Status replaced(double t, double h, double gently) {
    Status s = Status::retry;
    for (int parts = 1; parts <= most_parts && s == Status::retry; parts *= 2) {
      const double part = h / parts;
      const Effort effort = parts == 1 ? Effort::whole : Effort::plain;
      std::ranges::copy(q_, q_part_.begin());
      std::ranges::copy(v_, v_part_.begin());
      for (int i = 0; i < parts; ++i) {
        s = stages_.backward_euler(t + i * part, part, q_part_, v_part_, gently, effort);
        if (s != Status::ok) break;
        std::ranges::copy(stages_.q(), q_part_.begin());
        std::ranges::copy(stages_.v(), v_part_.begin());
      }
    }
    return s;
  }

  /// Whether the step that was just tried made energy. So does one that is not finite.
  bool gains(double t, double h) {
    const Account before = account(t, q_, v_);
    const Account after = account(t + h, stages_.q(), stages_.v());
    const double work = h * std::max({0.0, before.power, stages_.power(), after.power});
    const double allowed =
        work + gain_part * std::max(before.energy.kinetic, after.energy.kinetic) +
        rounding * (std::abs(before.energy.potential) + before.energy.kinetic);
    return !(after.energy.total() - before.energy.total() <= allowed);
  }

  EsdirkStages stages_;
  std::vector<double> q_part_, v_part_;  // between the parts of a replaced step
  Energetics* energetics_;  // null: steps are replaced only where they have no solution
};

template <const EsdirkTable& (*table)()>
std::unique_ptr<Integrator> make_guarded(System& system, const Options& options) {
  return std::make_unique<Guarded>(system, options, table());
}

/// Fixed steps of `method`, with its formulations and contact forces.
template <const EsdirkTable& (*table)()>
IntegratorEntry guarded(std::string_view id, std::string_view summary,
                        const IntegratorEntry& method) {
  return {.id = id,
          .summary = summary,
          .source = method.source,
          .impulsive = true,
          .tangent = true,
          .replaces_steps = true,
          .contact = method.contact,
          .formulations = method.formulations,
          .make = make_guarded<table>};
}

}  // namespace

IntegratorEntry tr_bdf2_entry();   // defined in tr_bdf2.cpp
IntegratorEntry esdirk43_entry();  // defined in esdirk43.cpp

IntegratorEntry guarded_entry() {
  return guarded<tr_bdf2_table>(
      "guarded", "tr_bdf2; backward Euler for steps that fail or gain energy",
      tr_bdf2_entry());
}

IntegratorEntry guarded_esdirk43_entry() {
  return guarded<esdirk43_table>(
      "guarded_esdirk43", "esdirk43; backward Euler for steps that fail or gain energy",
      esdirk43_entry());
}

}  // namespace tress::integrators
