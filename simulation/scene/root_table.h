#pragma once

#include <optional>
#include <span>

#include "models/strand/strand.h"
#include "simulation/scene/table.h"

namespace tress::simulation {

/// [root]: what all roots do together.
std::span<const Parameter> root_table_parameters();
std::span<const Use> root_uses();

/// A rigid motion that takes what is at rest at x to `position + frame x`: its rest place
/// is the origin. Throws InputError at the place of the key that makes no sense.
RootMotion head_motion(const Table& root);

/// For motion = "free": the velocity and spin, without a place.
std::optional<FreeRoot> free_motion(const Table& root);

/// The root of a strand at this place, moving as `head`, or free.
void set_root(Strand& strand, const RootMotion& head,
              const std::optional<FreeRoot>& free_root, Vec position, const Frame& frame);

}  // namespace tress::simulation
