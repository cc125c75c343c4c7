#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contract/forms/energetics.h"
#include "integrators/control/step_sequence.h"
#include "integrators/stage/stage.h"

namespace tress::integrators {

/// Coefficients of an ESDIRK method. The first stage of this Runge-Kutta method is the
/// known state; the other stages are implicit with one diagonal entry a_ii = gamma. The
/// last stage is the new state (b = the last row of a), so that the first stage is the
/// last one of the step before.
struct EsdirkTable {
  static constexpr std::size_t most_stages = 6;  // bound of the stages
  std::size_t stages = 0;                        // number of stages
  int order = 0;                                 // order of the method
  int embedded_order = 0;                        // order of the comparison solution
  /// Coefficients a_ij, by rows.
  std::array<std::array<double, most_stages>, most_stages> a{};
  std::array<double, most_stages> embedded{};  // weights of the comparison solution
  /// The estimate allowed in one step is share tolerance^power. In the limit of short
  /// steps the error of a whole run is proportional to the tolerance with power =
  /// k/order, where the estimate falls as h^k [Söderlind, Wang 2006, J. Comput. Appl.
  /// Math. 185, 244].
  double share = 1, power = 1;  // factor and power of the tolerance

  /// Returns the diagonal coefficient.
  double gamma() const { return a[1][1]; }
  /// Time of stage i over the step: the sum of its row.
  double c(std::size_t i) const;
};

/// The stages of one step of q' = v, v' = a. Stage i has
///
///     v_i = v_bar + h gamma a_i,                v_bar = v + h sum_{j<i} a_ij a_j
///     q_i = q_bar + (h gamma)^2 a_i,            q_bar = q + h sum_{j<i} a_ij v_j
///                                                         + h gamma v_bar
///
/// so that every stage passes the same weights (1, h gamma, (h gamma)^2) to Stage, and
/// one matrix serves all stages (Refresh::every_step: one per step). Positions along
/// bodies (ContactForm) follow the same rule: X_i = X + h sum_{j<=i} a_ij U_j.
///
/// A step in one of whose stages a rigid contact stops points (Stage::stops) is a
/// backward Euler step. Velocities jump there, and the stages of a higher-order method
/// would weight the impulse with coefficients of either sign. The error estimate is the
/// difference of positions to the free motion, which falls with the step. It excludes
/// velocities, whose difference does not fall.
class EsdirkStages {
 public:
  /// Works on `dynamics`, which must outlive it, as must `table`. With a tolerance, a
  /// step in which a sliding point sticks is a backward Euler step, too. Accelerations
  /// jump there, and steps short enough to resolve the jump chatter between the bounds
  /// of friction.
  EsdirkStages(Dynamics& dynamics, const Options& options, const EsdirkTable& table,
               Stage::Ending ending);

  /// The powers of the stages are measured from now on. `energetics` must outlive this.
  void measure(Energetics& energetics) { energetics_ = &energetics; }

  /// Steps from (q, v) at t, with acceleration a and multipliers lambda, over h. Points
  /// that reach a rigid surface at less than `gently` (m/s) do not cause a backward Euler
  /// step.
  Status step(double t, double h, In q, In v, In a, In lambda, double gently,
              Effort effort = Effort::whole) noexcept;

  /// A backward Euler step instead, which also ends with consistent accelerations.
  Status backward_euler(double t, double h, In q, In v, double gently,
                        Effort effort) noexcept;

  /// The next step does not guess from the last one.
  void forget() { steps_.forget(); }

  // The end of the last step.
  /// Returns the coordinates at the end of the last step.
  In q() const { return stage_.q(); }
  /// Returns the rates at the end of the last step.
  In v() const { return v_[last()]; }
  /// Returns the accelerations at the end of the last step.
  In a() const { return a_[last()]; }
  /// Returns the multipliers at the end of the last step.
  In lambda() const { return lambda_; }

  /// Largest power (W) in a stage of the last step, where measure() was called. Without
  /// exact contact, the last stage is left out: it is the end of the step.
  double power() const { return power_; }
  /// Whether the last step was that of an impact.
  bool impact() const { return impact_; }
  /// The method minus its embedded comparison over the last step, of length h.
  void difference(double h, Out dq, Out dv) const noexcept;

 private:
  Status euler(double t, double h, In q, In v, Effort effort) noexcept;
  Status take_euler(double t, double h, In q, In v, double gently) noexcept;
  Status damped(double t, double h, In q, In v, double gently, Effort effort) noexcept;
  bool sticks(std::size_t stage, double gently) const noexcept;
  std::size_t last() const { return table_.stages - 1; }
  void guess(std::size_t i, double h) noexcept;

  const EsdirkTable& table_;
  Dynamics& dynamics_;
  Stage stage_;
  std::vector<std::vector<double>> v_, a_;  // of the stages
  std::vector<double> q_bar_, v_bar_, lambda_;
  std::vector<std::vector<double>> slides_;  // of the stages, along bodies
  std::vector<double> place_;                // of the step's start
  StepSequence steps_;
  std::vector<double> a_before_;      // at its start
  std::vector<double> a_begun_;       // where steps begin, with forces of contacts
  bool begun_ = false;                // whether a_begun_ is that of this step
  bool impact_ = false;               // the last step was that of an impact
  double stuck_;                      // m/s: slower points stick; 0 without a tolerance
  Energetics* energetics_ = nullptr;  // null: powers are not measured
  double power_ = 0;                  // W, the largest in a stage
};

/// The method with a fixed step, or with Options::tolerance. `table` must outlive it.
std::unique_ptr<Integrator> make_esdirk(const EsdirkTable& table, System& system,
                                        const Options& options);

}  // namespace tress::integrators
