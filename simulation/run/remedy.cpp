#include "simulation/run/remedy.h"

#include <fmt/format.h>

#include <algorithm>

namespace tress::simulation {

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
           "internal_friction_kg_m3_s or [effects.linear_drag], which damp, or another "
           "model";
  }
  if (adaptive) {
    return fmt::format("try a smaller tolerance than rtol = {:g}", options.rtol);
  }
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
  if (integrator != "backward_euler") words += ", or backward_euler, which damps";
  return words;
}

}  // namespace tress::simulation
