#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/system.h"
#include "integrators/gradient/residual_derivative.h"
#include "integrators/gradient/varied_system.h"
#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// Makes the model of a strand on its supports, with the model's own Jacobian; of a
/// joined strand that of all strands of its group. Throws InputError where a search would
/// lead the strand onto rigid supports.
std::unique_ptr<System> system_of(const Scene& scene, std::size_t strand);
/// Points of a strand among those of its system.
struct PointRange {
  std::size_t first, count;  // number of the first point, number of points
};
/// Returns the points of a strand.
PointRange points_of(const Scene& scene, std::size_t strand);
/// Makes the same, with the exact Jacobian.
std::unique_ptr<System> exact_system_of(const Scene& scene, std::size_t strand);
/// The systems of a strand at changed values of the parameters, which both must outlive.
std::vector<integrators::RunParameter> run_parameters(
    const Scene& scene, std::size_t strand, std::span<const SceneParameter> parameters);
/// Returns what the scene's effects tell of the forces on a strand.
integrators::KnownForces known_forces(const Scene& scene);
/// Returns copies of a strand for the derivatives of its residual; null: supports or
/// joints change it.
std::unique_ptr<System> copies_of(const Scene& scene, std::size_t strand);
/// Throws InputError where a parameter takes a strand off its rigid supports or joints at
/// the start. `system`: the strand as it is.
void check_starts(const Scene& scene, std::size_t strand, System& system,
                  std::span<const SceneParameter> parameters);

}  // namespace tress::simulation
