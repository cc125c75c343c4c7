#pragma once

#include <memory>
#include <optional>
#include <span>

#include "models/motion/skin.h"
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

/// Returns the surface that roots sit on with motion = "skin", null otherwise. Throws
/// InputError with the file of an invalid mesh, and as Skin does.
std::shared_ptr<const Skin> skin_of(const Table& root);

/// Motions of the roots of a scene.
struct RootMotions {
  const RootMotion& head;                    // rigid motion of all roots
  const std::optional<FreeRoot>& free_root;  // root that moves freely, if it does
  const Skin* skin = nullptr;                // surface that carries roots; null: the head
  /// A free root begins with the velocity and the spin that a clamped one has there.
  bool begins_with_head = false;
};

/// Puts the root of a strand at this position, moving with the head or the skin, or free.
void set_root(Strand& strand, const RootMotions& motions, Vec position,
              const Frame& frame);

}  // namespace tress::simulation
