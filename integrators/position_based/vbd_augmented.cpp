#include "integrators/position_based/descent_method.h"
#include "integrators/position_based/position_sweeps.h"
#include "integrators/position_based/vbd_options.h"

namespace tress::integrators {
namespace {

/// Block descent on the compliant augmented Lagrangian: DescentMethod with bounded row
/// stiffness, and multipliers that carry the stress over steps. No row is stiffer than a
/// spring that swings the row's coordinates at sqrt(penalty). Where vbd locks for
/// hundreds of sweeps, tens of sweeps converge if the penalty lies in a window. Below the
/// window multipliers converge slowly, above it sweeps do. The window lies near 5/h^2 and
/// spans a decade or less. [Giles et al. 2025 with an infinite stiffness and a penalty
/// that grows; Rockafellar 1976]
constexpr Parameter augmented_own[] = {
    sweeps_option,
    sweep_order_option,
    block_option,
    curvature_option,
    start_option,
    chebyshev_option,
    {.name = "penalty_per_s2",
     .help = "largest stiffness of a row, times its G W G^T, 0: 5 over the square of the "
             "step",
     .number = 0,
     .min = 0,
     .max = 1e30},
    {.name = "kept_multipliers",
     .help = "share of the multipliers from which the next step starts",
     .number = 0.99,
     .min = 0,
     .max = 1},
    {.name = "primal_sweeps",
     .help = "sweeps before multipliers are improved",
     .number = 1,
     .min = 1,
     .max = 1e6,
     .whole = true}};

std::unique_ptr<Integrator> augmented_of(System& system, const Options& options) {
  const Parameters chosen = own_options(options, augmented_own);
  DescentChoice choice = descent_choice(chosen);
  choice.augmentation = {.penalty = chosen.number("penalty_per_s2"),
                         .kept = chosen.number("kept_multipliers"),
                         .sweeps = chosen.whole("primal_sweeps")};
  return std::make_unique<DescentMethod>(system, options, choice, start_choice(chosen));
}

}  // namespace

IntegratorEntry vbd_augmented_entry() {
  return {.id = "vbd_augmented",
          .summary = "vbd with bounded stiffness, corrected by multipliers",
          .source = "Giles et al. 2025",
          .formulations = {{Formulation::parametric, 1}},
          .gaps = gaps_of_sweeps(),
          .parameters = augmented_own,
          .objection = compliances,
          .make = augmented_of};
}

}  // namespace tress::integrators
