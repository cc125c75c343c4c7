#pragma once

#include <array>
#include <memory>
#include <vector>

#include "integrators/stage.h"

namespace tress::integrators {

/// Coefficients of an ESDIRK method: a Runge-Kutta method whose first stage is the known
/// state, whose other stages are implicit with one diagonal entry a_ii = gamma, and whose
/// last stage is the new state (b = the last row of a), so that its first stage is the
/// last one of the step before.
struct EsdirkTable {
  static constexpr std::size_t most_stages = 6;
  std::size_t stages = 0;
  int order = 0;
  int embedded_order = 0;
  std::array<std::array<double, most_stages>, most_stages> a{};
  std::array<double, most_stages> embedded{};  // weights of the comparison solution

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
/// so that every stage hands the same weights (1, h gamma, (h gamma)^2) to Stage, and one
/// matrix serves all of them (Refresh::every_step: one a step).
class EsdirkStages {
 public:
  EsdirkStages(Dynamics& dynamics, const Options& options, const EsdirkTable& table);

  /// From (q, v) at t with its acceleration a and multipliers over h.
  Status step(double t, double h, In q, In v, In a, In lambda) noexcept;

  // The end of the last step.
  In q() const { return stage_.q(); }
  In v() const { return v_[last()]; }
  In a() const { return a_[last()]; }
  In lambda() const { return lambda_; }

  /// The method minus its embedded comparison over the last step, of length h.
  void difference(double h, Out dq, Out dv) const noexcept;

 private:
  std::size_t last() const { return table_.stages - 1; }
  void guess(std::size_t i) noexcept;

  const EsdirkTable& table_;
  Stage stage_;
  std::vector<std::vector<double>> v_, a_;  // of the stages
  std::vector<double> q_bar_, v_bar_, lambda_;
};

/// The method with a fixed step. `table` must live as long as it.
std::unique_ptr<Integrator> make_esdirk(const EsdirkTable& table, System& system,
                                        const Options& options);

}  // namespace tress::integrators
