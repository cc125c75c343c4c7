#pragma once

#include <optional>
#include <span>

#include "models/strand/strand.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// [root]: the common motion of all roots.
std::span<const Parameter> root_table_parameters();
/// Returns which keys apply to which motion.
std::span<const Use> root_uses();

/// A rigid motion that maps the rest position x to `position + frame x`; its own rest
/// position is the origin. Throws InputError with the location of an invalid key.
RootMotion head_motion(const Table& root);

/// Returns the velocity and spin for motion = "free", without a position.
std::optional<FreeRoot> free_motion(const Table& root);

/// Puts the root of a strand at this position, moving with `head`, or free.
void set_root(Strand& strand, const RootMotion& head,
              const std::optional<FreeRoot>& free_root, Vec position, const Frame& frame);

}  // namespace tress::simulation
