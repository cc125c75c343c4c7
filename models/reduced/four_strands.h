#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/system.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// Makes one system of up to four strands of super_helix (Unknown::curvature) or
/// articulated_chain (joint_angle), one strand per SIMD lane. Its results agree with
/// those of the single strands to rounding. Coordinates and points are ordered strand
/// after strand; effects of a strand see its own points only. All strands use the largest
/// number of quadrature points that any of them needs. Returns null unless the strands
/// are clamped, have no branches and agree in discretisation, and options select two or
/// three modes, the elastic Jacobian and `recursive`.
std::unique_ptr<System> four_strands(std::span<const Strand> strands, Unknown unknown,
                                     const ReducedOptions& options,
                                     const std::vector<Effects>& effects);

}  // namespace tress::models
