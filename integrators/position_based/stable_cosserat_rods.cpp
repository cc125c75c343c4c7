#include "integrators/position_based/descent_method.h"
#include "integrators/position_based/position_sweeps.h"

namespace tress::integrators {
namespace {

/// Stable Cosserat rods. Every sweep treats all nodes by block descent with inertia, then
/// all orientations in closed form and without inertia (ComplianceForm::orient). Sweeps
/// start from the adaptive start and the orientations of the last step. Converged sweeps
/// solve backward Euler's step of a rod whose sections have no rotary inertia. The
/// paper's energies are isotropic, and it replaces the multiplier of the norm by a bound.
/// The closed form here is exact, and its fixed point is that of the model's energy. [Hsu
/// et al. 2025]
std::unique_ptr<Integrator> cosserat_of(System& system, const Options& options) {
  const Parameters chosen = own_options(options, sweep_options());
  return std::make_unique<DescentMethod>(
      system, options,
      DescentChoice{.sweeps = chosen.whole("sweeps"),
                    .sweep_order = std::string(chosen.word("sweep_order")),
                    .oriented = true},
      Start::adaptive);
}

std::string without_orientations(System& system, Formulation formulation) {
  std::string why = compliances(system, formulation);
  if (why.empty() && system.compliance_form()->orientations().empty()) {
    why = "needs a quaternion for every edge, with a closed form";
  }
  return why;
}

}  // namespace

IntegratorEntry stable_cosserat_rods_entry() {
  return {.id = "stable_cosserat_rods",
          .summary = "vbd with quaternions in closed form",
          .source = "Hsu et al. 2025",
          .formulations = {{Formulation::parametric, 1}},
          .gaps = gaps_of_sweeps(),
          .parameters = sweep_options(),
          .objection = without_orientations,
          .make = cosserat_of};
}

}  // namespace tress::integrators
