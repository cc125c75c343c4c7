#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/integrator.h"

/// Catalogue entries of the methods. Every method's file ends with a function
/// `IntegratorEntry <id>_entry()`, which is listed in catalogue.cpp.
namespace tress::integrators {

/// A supported formulation and the method's order in it: errors O(h^order) at a fixed
/// time; for adaptive methods the highest order used by default.
struct Treatment {
  Formulation formulation;  // form of the constraints
  int order;                // order of the method
};

/// An unsupported formulation and the method's own reason, if it has one.
struct Gap {
  Formulation formulation;  // form of the constraints
  std::string_view reason;  // reason for messages, may be empty
};

/// The contact forces that a method can drive.
enum class Contact {
  regular,          // given by the state
  exact,            // ContactForm: equations are solved at ends of stages, by Stage
  exact_rebounding  // the same, in one stage from the velocity of the step's start
};

/// The default objection: none.
std::string any_system(System& system, Formulation formulation);

/// One line of the list of integrators.
struct IntegratorEntry {
  std::string_view id;            // id in scenes, tables and the command line
  std::string_view summary;       // damping, cost; lists print the order before it
  std::string_view source;        // paper and year
  bool adaptive = false;          // driven by rtol/atol instead of step
  bool error_controlled = false;  // takes Options::tolerance as well as step
  bool impulsive = false;         // goes on after impulses at ends of steps (Impulsive)
  bool tangent = false;           // solves with the model's tangent
  bool exact_jacobian = false;    // an approximate Jacobian lowers its order
  bool replaces_steps = false;    // backward Euler replaces steps (Stats::replaced)
  int stages = 0;                 // solutions by Newton's method in a step (Stage)
  Contact contact = Contact::regular;  // contact forces that it can drive
  /// Contact forces that it can drive with Options::tolerance, if error_controlled.
  Contact controlled_contact = contact;
  std::vector<Treatment> formulations;  // supported formulations
  std::vector<Gap> gaps = {};           // unsupported formulations with a reason
  /// Options of its own, read by own_options(); methods of a family share their list.
  std::span<const Parameter> parameters = {};
  /// Returns empty text when the method can drive `system` under `formulation`,
  /// otherwise the reason (beyond the general rules that `refusal` checks).
  std::string (*objection)(System& system, Formulation formulation) = any_system;
  /// Makes an integrator of the system, which must outlive it.
  std::unique_ptr<Integrator> (*make)(System& system, const Options& options);

  /// Order under `formulation`; empty if unsupported.
  std::optional<int> order(Formulation formulation) const;
  /// Nominal order: under the first formulation.
  int order() const { return formulations.front().order; }
  /// Why `formulation` is unsupported: the method's own reason, else the general one.
  std::string_view gap(Formulation formulation) const;
};

/// Makes an integrator of a type, as IntegratorEntry::make.
template <class Method>
std::unique_ptr<Integrator> make_method(System& system, const Options& options) {
  return std::make_unique<Method>(system, options);
}

// ---- formulations supported by families of methods

/// ODE solvers: the equations give the acceleration.
inline constexpr std::array ode_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte};
/// ODE solvers that can also continue from a projected state.
inline constexpr std::array projected_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte,
    Formulation::projection};
/// Fixed-step methods that pass their weights to Stage and are stable there with g = 0.
inline constexpr std::array stage_formulations{
    Formulation::parametric, Formulation::acceleration, Formulation::baumgarte,
    Formulation::projection, Formulation::index3};

/// All `formulations`, with the same order.
std::vector<Treatment> of_order(int order, std::span<const Formulation> formulations);

/// Gaps of a method that enforces g = 0 by its own formulation; `unconstrained` is the
/// reason why it does not apply to systems without constraints.
std::vector<Gap> holds_constraints(std::string_view unconstrained);

// ---- objections shared by several methods

/// Objects to a mass matrix that may be singular, without constraints.
std::string inverts_mass(System& system, Formulation formulation);
/// Objects to a mass matrix that is not constant.
std::string constant_mass(System& system, Formulation formulation);

}  // namespace tress::integrators
