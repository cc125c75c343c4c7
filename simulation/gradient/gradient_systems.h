#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/system.h"
#include "integrators/gradient/residual_derivative.h"
#include "integrators/gradient/varied_system.h"
#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// Makes the model of a strand on its supports, with the model's own Jacobian. Throws
/// InputError where a search would lead the strand onto rigid supports.
std::unique_ptr<System> system_of(const Scene& scene, std::size_t strand);
/// Makes the same, with the exact Jacobian.
std::unique_ptr<System> exact_system_of(const Scene& scene, std::size_t strand);
/// The systems of a strand at changed values of the parameters, which both must outlive.
std::vector<integrators::RunParameter> run_parameters(
    const Scene& scene, std::size_t strand, std::span<const SceneParameter> parameters);
/// Returns what the scene's effects tell of the forces on a strand.
integrators::KnownForces known_forces(const Scene& scene);
/// Returns copies of a strand for the derivatives of its residual; null: supports change
/// it.
std::unique_ptr<System> copies_of(const Scene& scene, std::size_t strand);
/// Throws InputError where a parameter takes a strand off its rigid supports at the
/// start. `system`: the strand as it is.
void check_starts(const Scene& scene, std::size_t strand, System& system,
                  std::span<const SceneParameter> parameters);

}  // namespace tress::simulation
