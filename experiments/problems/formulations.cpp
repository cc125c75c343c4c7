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

}  // namespace tress::experiments
