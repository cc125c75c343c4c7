#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/integrator.h"

/// What a method says of itself. Every method's own file ends with a function
/// `IntegratorEntry <id>_entry()`, which the list in catalogue.cpp names.
namespace tress::integrators {

/// A formulation that a method can take on, and its order there: errors O(h^order) at a
/// fixed time; of adaptive methods the highest order by default.
struct Treatment {
  Formulation formulation;
  int order;
};

/// A formulation that it cannot take on, and why, where the reason is its own.
struct Gap {
  Formulation formulation;
  std::string_view reason;
};

/// The general objection: none.
std::string any_system(System& system, Formulation formulation);

/// One line of the list of integrators.
struct IntegratorEntry {
  std::string_view id;
  std::string_view summary;  // damping, cost; lists say the order before it
  std::string_view source;
  bool adaptive = false;  // driven by rtol/atol instead of step
  bool tangent = false;   // solves with the model's tangent
  std::vector<Treatment> formulations;
  std::vector<Gap> gaps = {};
  /// Options that it alone reads, by own_options().
  std::span<const Parameter> parameters = {};
  /// Empty when the method can drive `system` under `formulation`, otherwise the reason
  /// (beyond the general rules that `refusal` checks).
  std::string (*objection)(System& system, Formulation formulation) = any_system;
  std::unique_ptr<Integrator> (*make)(System& system, const Options& options);

  /// Under `formulation`; nothing where it cannot take it on.
  std::optional<int> order(Formulation formulation) const;
  /// The nominal one: under the first formulation.
  int order() const { return formulations.front().order; }
  /// Why it cannot take on `formulation`: its own reason, else what all others lack.
  std::string_view gap(Formulation formulation) const;
};

template <class Method>
std::unique_ptr<Integrator> make_method(System& system, const Options& options) {
  return std::make_unique<Method>(system, options);
}

// ---- formulations that families of methods take on

/// Of an ODE solver: its equations are those of the acceleration.
inline constexpr std::array ode_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte};
/// Of one that also goes on from a state moved onto the constraints.
inline constexpr std::array projected_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte,
    Formulation::projection};
/// Of a fixed-step method that hands its weights to Stage and is stable with g = 0 there.
inline constexpr std::array stage_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte,
    Formulation::projection, Formulation::index3};

/// All of them with the same order.
std::vector<Treatment> of_order(int order, std::span<const Formulation> formulations);

/// The gaps of a method that holds g = 0 by a formulation of its own; `unconstrained`
/// says why it does nothing for a system without constraints.
std::vector<Gap> holds_constraints(std::string_view unconstrained);

// ---- objections that several methods have

/// To a mass matrix that may be singular, without constraints.
std::string inverts_mass(System& system, Formulation formulation);
/// To a mass matrix that changes.
std::string constant_mass(System& system, Formulation formulation);

}  // namespace tress::integrators
