#include "experiments/problems/formulations.h"

namespace tress::experiments {

std::vector<Formulation> usable_formulations(const IntegratorEntry& entry,
                                             System& system) {
  constexpr Formulation preference[] = {Formulation::parametric,  Formulation::rattle,
                                        Formulation::index2_ggl,  Formulation::index3,
                                        Formulation::projection,  Formulation::correction,
                                        Formulation::acceleration};
  std::vector<Formulation> list;
  for (const Formulation formulation : preference) {
    if (refusal(entry, system, formulation).empty()) list.push_back(formulation);
  }
  return list;
}

std::optional<Formulation> preferred_formulation(const IntegratorEntry& entry,
                                                 System& system, double tolerance) {
  if (tolerance > 0 && system.contact_form() != nullptr &&
      entry.controlled_contact == integrators::Contact::regular) {
    return {};
  }
  for (const Formulation each : usable_formulations(entry, system)) {
    if (tolerance == 0 || each != Formulation::index3) return each;
  }
  return {};
}

}  // namespace tress::experiments
