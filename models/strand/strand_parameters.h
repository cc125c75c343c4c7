#pragma once

#include <span>
#include <vector>

#include "models/effects/effect.h"
#include "models/parameters.h"
#include "models/strand/strand.h"

namespace tress {

/// The catalogue parameters that every strand model shares, followed by its own.
std::vector<Parameter> with_strand_parameters(std::span<const Parameter> own);
/// The same for models that bring their own geometry (trees): material, root motion and
/// effects, no length, discretisation or shape.
std::vector<Parameter> with_material_parameters(std::span<const Parameter> own);

Material material(const Parameters& parameters);
RootMotion root_motion(const Parameters& parameters);
Effects strand_effects(const Parameters& parameters);  // gravity and drag, when not 0
/// Everything above, the section, the cut, the shapes and the root, free or clamped.
Strand strand(const Parameters& parameters);

}  // namespace tress
