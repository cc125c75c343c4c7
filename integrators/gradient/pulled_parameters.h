#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contract/forms/moved_clamp.h"
#include "contract/forms/natural_strains.h"
#include "contract/forms/transposed_form.h"
#include "integrators/gradient/linearized.h"

namespace tress::integrators {

/// n_hat -= r_n^T mu of the natural strains n (NaturalStrains). r_n is -diag(stiffness)
/// where strains are coordinates. Elsewhere r is affine in n, and strains that are in
/// different equations are changed together: O(1) residuals for a strand.
class PulledNatural {
 public:
  /// `system` must outlive it and have the form.
  PulledNatural(System& system, Dynamics& dynamics);

  /// Returns the number of natural strains.
  std::size_t count() const { return stiffness_.size(); }
  /// Adds to each n_hat what belongs to its mu (n).
  Status pull(const WatchedSystem::Motion& at, std::span<const std::vector<double>> mu,
              std::span<std::vector<double>> n_hat) noexcept;

 private:
  struct Member {
    std::size_t strain;
    std::vector<std::size_t> rows;  // of its equations
  };
  void find_groups(System& system);

  NaturalStrains& form_;
  Dynamics& dynamics_;
  std::vector<double> stiffness_;
  bool coordinates_;
  std::vector<std::vector<Member>> groups_;
  std::vector<double> base_, r_, c_, natural_, changed_;
};

/// p_hat -= R_s^T x for the parameters s of a run, with x = (mu, nu) of
/// TransposedEquations. Those that act through constants of the system alone
/// (TransposedForm) cost one product together, loads of effects and the motion of the
/// clamp their own evaluation. Natural strains of other systems are together as expensive
/// as a few residuals. Any other parameter costs the residuals of its stencil.
class PulledParameters {
 public:
  /// `forces`: as constants_derivative(). `system` must outlive it.
  PulledParameters(System& system, std::span<const RunParameter> parameters,
                   const Options& options, KnownForces forces);

  /// Returns the number of parameters.
  std::size_t count() const { return natural_by_.size(); }
  /// Begins a sweep of several numbers.
  void begin(std::size_t numbers);
  /// The systems remember what the run did, relative to what each began with: reference
  /// frames at the start depend on parameters.
  void recall(In memory);
  /// Adds the part of constants, loads and clamp for one number. `placed`: the system has
  /// just solved for x with its TransposedForm at this state.
  void pull_constants(const WatchedSystem::Motion& at, bool placed, std::size_t number,
                      In x) noexcept;
  /// Adds the other part of a stage with x (n + m) for each number. `starts`: the stage
  /// is an acceleration, in which constraints are g'' = 0.
  Status pull(const WatchedSystem::Motion& at, bool starts,
              std::span<const std::vector<double>> x) noexcept;
  /// Adds the part of the start: q_hat and v_hat, (n) for each number.
  void pull_start(System& system, std::span<const In> q_hat, std::span<const In> v_hat);
  /// Adds that of points at a fixed q: x_hat for each number.
  void pull_points(System& system, double t, In q,
                   std::span<const std::vector<double>> x_hat);
  /// Writes the derivatives, (numbers x count).
  void write(Out by) const;

 private:
  System& system_;
  TransposedForm* transposed_;  // null: the system has none
  MovedClamp* clamp_;           // likewise
  std::vector<std::optional<ConstantsDerivative>> constants_by_;  // where it is all
  std::vector<std::vector<double>> natural_by_;  // empty: by constants or a stencil
  std::vector<VariedSystem> varied_;             // of start and points, and of residuals
  std::vector<std::size_t> index_;               // of varied_, among the parameters
  std::vector<std::size_t> residuals_;  // those of varied_ that no constants replace
  /// Memory at the start of each system of varied_, less that of the run's system.
  std::vector<std::vector<double>> began_;
  Linearized stages_;
  std::optional<Linearized> starts_;  // where there are constraints
  std::optional<PulledNatural> natural_;
  std::vector<std::vector<double>> by_;     // [number][parameter], of varied_
  std::vector<std::vector<double>> n_hat_;  // [number]
  bool any_constants_ = false;
  std::vector<std::vector<double>> c_hat_;     // [number], of constants
  std::vector<std::vector<double>> by_loads_;  // [number][parameter], and of the clamp
  std::vector<double> r_, c_;
};

}  // namespace tress::integrators
