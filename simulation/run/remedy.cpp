#include "simulation/run/remedy.h"

#include <fmt/format.h>

#include <algorithm>

namespace tress::simulation {
namespace {

/// Advice for a method driven by rtol and atol.
std::string remedy_of_tolerances(std::string_view integrator, const Options& options) {
  if (options.atol == 0) return "try atol > 0: a speed of 0 has no relative error";
  const std::string of_rtol = fmt::format("tolerance than rtol = {:g}", options.rtol);
  // A step h scales errors of multipliers by 1 / h^2 (index 3) or 1 / h (index 2): below
  // some rtol, Newton's iteration meets no tolerance of theirs.
  if (options.formulation == Formulation::index3) {
    return fmt::format(
        "try a larger {} ({} on index3 often needs 1e-4), or formulation = "
        "\"index2_ggl\"",
        of_rtol, integrator);
  }
  if (options.formulation == Formulation::index2_ggl) {
    return fmt::format("try a larger {}", of_rtol);
  }
  return fmt::format("try a smaller {}", of_rtol);
}

}  // namespace

bool ends_after_sweeps(const integrators::IntegratorEntry& method) {
  return std::ranges::any_of(
      method.parameters, [](const Parameter& option) { return option.name == "sweeps"; });
}

std::string remedy(std::string_view integrator, const Options& options, Limit limit,
                   std::string_view model) {
  const integrators::IntegratorEntry& method = integrators::find_integrator(integrator);
  const bool adaptive = method.adaptive;
  if (limit == Limit::steps && options.tolerance > 0) {
    return fmt::format("try a larger tolerance than {:g}, or more than max_steps = {}",
                       options.tolerance, options.max_steps);
  }
  if (limit == Limit::steps) {
    return (adaptive
                ? fmt::format("try a larger tolerance than rtol = {:g}, a method for "
                              "stiff systems such as ida",
                              options.rtol)
                : fmt::format("try a longer step than {:g} s", options.step)) +
           fmt::format(", or more than max_steps = {}", options.max_steps);
  }
  if (limit == Limit::work) {
    return fmt::format("try more than max_work = {:g}", options.max_work);
  }
  // docs/theory/models/reconstructions.md
  if (model == "force_transport") {
    return "small oscillations of force_transport grow at any step: try "
           "more internal_friction_kg_m3_s or more drag, which damp, or another model";
  }
  if (adaptive) return remedy_of_tolerances(integrator, options);
  if (options.tolerance > 0) {
    return fmt::format("try another tolerance than {:g}, or a max_step_s",
                       options.tolerance);
  }
  if (ends_after_sweeps(method)) {
    return fmt::format(
        "{} ends a step after a number of sweeps, solved or not, and shorter steps need "
        "not help: try more sweeps, or backward_euler, which solves its steps",
        integrator);
  }
  std::string words = fmt::format("try a shorter step than {:g} s", options.step);
  if (integrator == "radau5") {
    words += ", or esdirk43, which finds a solution at some steps where radau5 does not";
  } else if (integrator != "backward_euler") {
    words += ", or backward_euler, which damps";
  }
  return words;
}

}  // namespace tress::simulation
