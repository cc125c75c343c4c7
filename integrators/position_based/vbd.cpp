#include "integrators/position_based/descent_method.h"
#include "integrators/position_based/position_sweeps.h"
#include "integrators/position_based/vbd_options.h"

namespace tress::integrators {
namespace {

/// Vertex block descent: DescentMethod on the energy as it is. With `block` 0 a sweep is
/// a Newton iteration of the whole step. [Chen et al. 2024; Wang 2015;
/// Anderson 1965]
constexpr Parameter vbd_own[] = {sweeps_option,    sweep_order_option, block_option,
                                 curvature_option, start_option,       chebyshev_option,
                                 anderson_option};

std::unique_ptr<Integrator> vbd_of(System& system, const Options& options) {
  const Parameters chosen = own_options(options, vbd_own);
  return std::make_unique<DescentMethod>(system, options, descent_choice(chosen),
                                         start_choice(chosen));
}

std::string not_an_energy(System& system, Formulation formulation) {
  std::string why = compliances(system, formulation);
  if (why.empty() && has_rigid_rows(*system.compliance_form())) {
    why =
        "descends on an energy, which rows without compliance have not: use xpbd or "
        "vbd_augmented";
  }
  return why;
}

}  // namespace

IntegratorEntry vbd_entry() {
  return {.id = "vbd",
          .summary = "backward Euler by descent node by node",
          .source = "Chen et al. 2024",
          .formulations = {{Formulation::parametric, 1}},
          .gaps = gaps_of_sweeps(),
          .parameters = vbd_own,
          .objection = not_an_energy,
          .make = vbd_of};
}

}  // namespace tress::integrators
