#include "integrators/catalogue.h"

#include <algorithm>
#include <array>
#include <vector>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "integrators/formulation/relaxation.h"
#include "integrators/methods.h"
#include "integrators/sundials/factories.h"

namespace tress {
namespace {

using enum Formulation;

// What a family of methods can take on; a method outside its list gets `gap`'s reason.
constexpr std::array one_step_ode{parametric, acceleration, baumgarte, projection};
constexpr std::array implicit_dae{parametric, acceleration, baumgarte, projection,
                                  index3};
constexpr std::array rattle_only{rattle};
constexpr std::array correction_only{correction};
constexpr std::array unconstrained_only{parametric};

std::string any(System&, Formulation) { return {}; }

std::string inverts_mass(System& system, Formulation) {
  if (system.layout().constraints > 0 || system.traits().regular_mass) return {};
  return "needs M^-1 and the model's mass matrix can be singular";
}

std::string constant_mass(System& system, Formulation) {
  if (system.traits().constant_mass) return {};
  return "needs a constant mass matrix";
}

/// Constraints met one by one weigh coordinates, not directions.
std::string weighs_coordinates(System& system, Formulation formulation) {
  if (!diagonal_mass(system)) return "needs a diagonal mass matrix";
  return constant_mass(system, formulation);
}

std::string compliances(System& system, Formulation) {
  if (system.compliance_form() != nullptr) return {};
  return "needs the model's energy as compliant constraints";
}

// A dense Jacobian by differences costs n^2 residual entries per step.
constexpr int most_dense_coordinates = 200;

std::string dense_jacobian(System& system, Formulation formulation) {
  if (system.layout().coordinates > most_dense_coordinates) {
    return "needs a dense Jacobian: at most 200 coordinates";
  }
  return inverts_mass(system, formulation);
}

// clang-format off
constexpr std::array table{
    IntegratorEntry{"explicit_euler", "order 1, amplifies; baseline", "Euler 1768", 1, false, one_step_ode, inverts_mass, make_explicit_euler},
    IntegratorEntry{"symplectic_euler", "order 1, symplectic, conditionally stable", "Hairer-Lubich-Wanner VI.3", 1, false, one_step_ode, inverts_mass, make_symplectic_euler},
    IntegratorEntry{"velocity_verlet", "order 2, symplectic, conditionally stable", "Swope 1982", 2, false, one_step_ode, inverts_mass, make_velocity_verlet},
    IntegratorEntry{"rk4", "order 4, conditionally stable", "Kutta 1901", 4, false, one_step_ode, inverts_mass, make_rk4},
    IntegratorEntry{"rattle", "order 2, symplectic, exact constraints", "Andersen 1983", 2, false, rattle_only, constant_mass, make_rattle},
    IntegratorEntry{"predictor_corrector", "order 1, lengths corrected between two implicit half steps", "Kim 2010; Provot 1995; Bridson 2002", 1, false, correction_only, weighs_coordinates, make_predictor_corrector},
    IntegratorEntry{"semi_implicit_euler", "order 1, one linear solve, strong damping", "Baraff-Witkin 1998", 1, false, implicit_dae, any, make_semi_implicit_euler},
    IntegratorEntry{"backward_euler", "order 1, L-stable, strong damping", "Hairer-Wanner IV.3", 1, false, implicit_dae, any, make_backward_euler},
    IntegratorEntry{"implicit_midpoint", "order 2, A-stable, no damping, symplectic", "Gauss 1 stage", 2, false, one_step_ode, any, make_implicit_midpoint},
    IntegratorEntry{"linearly_implicit_midpoint", "order 2 with any tangent, one linear solve", "Steihaug-Wolfbrandt 1979", 2, false, one_step_ode, any, make_linearly_implicit_midpoint},
    IntegratorEntry{"bdf2", "order 2, L-stable, damps fast modes", "Gear 1971", 2, false, implicit_dae, any, make_bdf2},
    IntegratorEntry{"newmark", "order 2, average acceleration, no damping", "Newmark 1959", 2, false, implicit_dae, any, make_newmark},
    IntegratorEntry{"generalized_alpha", "order 2, damping by rho_inf", "Chung-Hulbert 1993", 2, false, implicit_dae, any, make_generalized_alpha},
    IntegratorEntry{"xpbd", "order 1, position-based, Gauss-Seidel on compliances", "Macklin-Mueller-Chentanez 2016", 1, false, unconstrained_only, compliances, make_xpbd},
    IntegratorEntry{"gsl_rkf45", "order 5(4) explicit Runge-Kutta", "GSL odeiv2", 5, true, one_step_ode, inverts_mass, make_gsl_rkf45},
    IntegratorEntry{"gsl_rk8pd", "order 8(7) explicit Runge-Kutta", "GSL odeiv2", 8, true, one_step_ode, inverts_mass, make_gsl_rk8pd},
    IntegratorEntry{"gsl_msadams", "orders 1-12 Adams", "GSL odeiv2", 12, true, ode_formulations, inverts_mass, make_gsl_msadams},
    IntegratorEntry{"gsl_bsimp", "implicit extrapolation, stiff", "GSL odeiv2, Bader-Deuflhard 1983", 8, true, one_step_ode, dense_jacobian, make_gsl_bsimp},
    IntegratorEntry{"cvode_adams", "orders 1-12 Adams-Moulton", "SUNDIALS CVODE", 12, true, ode_formulations, inverts_mass, make_cvode_adams},
    IntegratorEntry{"cvode_bdf", "BDF, order 2 by default, 1-5 on request", "SUNDIALS CVODE", 2, true, cvode_bdf_formulations, inverts_mass, make_cvode_bdf},
    IntegratorEntry{"arkode_erk", "explicit Runge-Kutta, orders 2-8", "SUNDIALS ARKODE", 4, true, ode_formulations, inverts_mass, make_arkode_erk},
    IntegratorEntry{"arkode_dirk", "ESDIRK4(3)6L[2]SA, L-stable", "SUNDIALS ARKODE", 4, true, ode_formulations, inverts_mass, make_arkode_dirk},
    IntegratorEntry{"ida", "BDF on the residual form, orders 1-5", "SUNDIALS IDA", 5, true, ida_formulations, any, make_ida},
};
// clang-format on

/// Why a method that lacks `formulation` lacks it.
std::string gap(const IntegratorEntry& entry, Formulation formulation) {
  if (entry.id == "xpbd") return "takes energies, not constraints with multipliers";
  switch (formulation) {
    case parametric:
      return entry.id == "rattle"
                 ? "is velocity_verlet when there is nothing to constrain"
                 : "has no constraint to correct";
    case acceleration:
    case baumgarte:
      return "holds g = 0 itself";
    case projection:
      return entry.id == "ida" || entry.id == "rattle" ||
                     entry.id == "predictor_corrector"
                 ? "holds g = 0 itself: use its own formulations"
                 : "a projected state would not match the method's history";
    case index2_ggl:
      return "only ida solves this index-2 form";
    case index3:
      return entry.id.ends_with("implicit_midpoint")
                 ? "Gauss methods are unstable on index 3"
                 : "an ODE method cannot hold g = 0 inside the step";
    case correction:
      return "only predictor_corrector leaves constraints out of its solves";
    case rattle:
      break;
  }
  return "only the rattle method applies these impulses";
}

}  // namespace

std::string_view name(Formulation formulation) {
  switch (formulation) {
    case parametric:
      return "parametric";
    case acceleration:
      return "acceleration";
    case baumgarte:
      return "baumgarte";
    case projection:
      return "projection";
    case index2_ggl:
      return "index2_ggl";
    case index3:
      return "index3";
    case rattle:
      return "rattle";
    case correction:
      return "correction";
  }
  return "";
}

std::span<const IntegratorEntry> integrators() { return table; }

const IntegratorEntry& find_integrator(std::string_view id) {
  std::vector<std::string_view> ids;
  for (const IntegratorEntry& entry : table) {
    if (entry.id == id) return entry;
    ids.push_back(entry.id);
  }
  throw InputError("unknown integrator '" + std::string(id) + "'", "--integrators",
                   suggestion(id, ids, "--list shows the integrators"));
}

std::string refusal(const IntegratorEntry& entry, System& system,
                    Formulation formulation) {
  const bool constrained = system.layout().constraints > 0;
  if (constrained && formulation == parametric) {
    return "the model has constraints: choose a formulation of them";
  }
  if (!constrained && formulation != parametric) {
    return "the model has no constraints: the formulation is parametric";
  }
  if (std::ranges::find(entry.formulations, formulation) == entry.formulations.end()) {
    return gap(entry, formulation);
  }
  if (constrained && system.sparse_form() == nullptr) {
    return "constraints need the model's sparse form";
  }
  return entry.objection(system, formulation);
}

std::unique_ptr<Integrator> make_integrator(std::string_view id, System& system,
                                            const Options& options) {
  const IntegratorEntry& entry = find_integrator(id);
  const std::string reason = refusal(entry, system, options.formulation);
  if (!reason.empty()) {
    throw InputError(std::string(id) + " cannot drive this model as " +
                         std::string(name(options.formulation)),
                     reason, "--list shows what can drive what");
  }
  return entry.make(system, options);
}

}  // namespace tress
