#include "integrators/idle_option.h"

#include <algorithm>
#include <array>

#include "integrators/catalogue.h"

namespace tress::integrators {
namespace {

/// Condition under which an option has an effect.
struct Need {
  std::string_view option, what;
  bool (*met)(const IntegratorEntry&, const Options&);
};

/// The methods that call chosen_order(); tests compare them with the behaviour.
constexpr std::array of_several_orders{"cvode_adams", "cvode_bdf",  "arkode_erk",
                                       "arkode_dirk", "arkode_ark", "arkode_mri",
                                       "ida"};

/// Plug-ins do not declare which common options they read.
bool added(const IntegratorEntry& method) {
  return std::ranges::count(added_integrators(), method.id, &IntegratorEntry::id) > 0;
}

bool stabilised(const IntegratorEntry& /*method*/, const Options& options) {
  return options.formulation == Formulation::baumgarte;
}

bool adaptive(const IntegratorEntry& method, const Options& /*options*/) {
  return method.adaptive;
}

bool fixed(const IntegratorEntry& method, const Options& /*options*/) {
  return !method.adaptive;
}

bool chooses_steps(const IntegratorEntry& method, const Options& options) {
  return method.adaptive || options.tolerance > 0;
}

bool has_orders(const IntegratorEntry& method, const Options& /*options*/) {
  return std::ranges::count(of_several_orders, method.id) > 0;
}

bool solves_multipliers(const IntegratorEntry& method, const Options& options) {
  return method.id == "ida" || options.formulation != Formulation::parametric;
}

constexpr Need needs[] = {
    {"alpha", "formulation = \"baumgarte\"", stabilised},
    {"beta", "formulation = \"baumgarte\"", stabilised},
    {"step", "a method that takes dt_s, such as tr_bdf2", fixed},
    {"rtol", "a method that takes rtol, such as cvode_bdf", adaptive},
    {"atol", "a method that takes rtol, such as cvode_bdf", adaptive},
    {"max_step", "position_tol_rel, or a method that takes rtol", chooses_steps},
    {"max_order", "a method of several orders, such as cvode_bdf", has_orders},
    {"linear", "ida, or a model with constraints ([model] solver selects other solvers)",
     solves_multipliers}};

}  // namespace

std::string_view idle_option(const IntegratorEntry& method, const Options& options,
                             std::string_view option) {
  const auto need = std::ranges::find(needs, option, &Need::option);
  if (need == std::end(needs) || added(method) || need->met(method, options)) return {};
  return need->what;
}

}  // namespace tress::integrators
