#include "integrators/entry.h"

#include <algorithm>

namespace tress::integrators {
namespace {

/// What `formulation` requires, phrased for a method that lacks it.
std::string_view what_it_asks(Formulation formulation) {
  switch (formulation) {
    case Formulation::parametric:
      return "needs constraints";
    case Formulation::acceleration:
    case Formulation::baumgarte:
      return "does not solve for the acceleration of the constraints";
    case Formulation::projection:
      return "does not go on from a projected state";
    case Formulation::index2_ggl:
      return "has no second multiplier, which would hold g' = 0";
    case Formulation::index3:
      return "cannot hold g = 0 inside the step";
    case Formulation::rattle:
      return "does not apply the impulses of half steps";
    case Formulation::correction:
      break;
  }
  return "does not leave constraints out of its solves";
}

}  // namespace

std::string any_system(System& /*system*/, Formulation /*formulation*/) { return {}; }

std::optional<int> IntegratorEntry::order(Formulation formulation) const {
  const auto found =
      std::ranges::find(formulations, formulation, &Treatment::formulation);
  if (found == formulations.end()) return {};
  return found->order;
}

std::string_view IntegratorEntry::gap(Formulation formulation) const {
  const auto found = std::ranges::find(gaps, formulation, &Gap::formulation);
  return found == gaps.end() ? what_it_asks(formulation) : found->reason;
}

std::vector<Treatment> of_order(int order, std::span<const Formulation> formulations) {
  std::vector<Treatment> all;
  for (const Formulation formulation : formulations) all.push_back({formulation, order});
  return all;
}

std::vector<Gap> holds_constraints(std::string_view unconstrained) {
  return {{Formulation::parametric, unconstrained},
          {Formulation::acceleration, "holds g = 0 itself"},
          {Formulation::baumgarte, "holds g = 0 itself"},
          {Formulation::projection, "holds g = 0 itself: use its own formulation"}};
}

std::string inverts_mass(System& system, Formulation /*formulation*/) {
  if (system.layout().constraints > 0 || system.traits().regular_mass) return {};
  return "needs M^-1 and the model's mass matrix can be singular";
}

std::string constant_mass(System& system, Formulation /*formulation*/) {
  if (system.traits().constant_mass) return {};
  return "needs a constant mass matrix";
}

}  // namespace tress::integrators
