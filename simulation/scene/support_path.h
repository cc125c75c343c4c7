#pragma once

#include <string>
#include <vector>

#include "models/supports/support_rows.h"
#include "simulation/scene/scene.h"
#include "simulation/table/table.h"

/// Motion of a support over time, from its table.
namespace tress::simulation {

/// A head, or a body that strands do not drive.
struct Carrier {
  /// Kinds of motion: prescribed or none.
  enum Motion {
    moves,  // prescribed
    still   // none
  };
  std::string name;           // "head", or that of a body
  models::RootMotion motion;  // if it moves
  Motion is = moves;          // supports are on those that move
};
/// Returns the head and the bodies of a scene that strands do not drive.
std::vector<Carrier> carriers(const Scene& scene);

/// Returns the motion that a [[supports]] table describes: that of its carrier among
/// these, or its keyframes, directions and twist. `start` is the place and the frame of
/// the held point where the strand begins. They are kept where the table has no rows.
/// Throws InputError with the location of rows that are not ascending, or of directions
/// that determine no rotation, and of a carrier that is unknown or does not carry.
models::RootMotion support_path(const Table& table, const models::StrandPlace& start,
                                const std::vector<Carrier>& carriers);

/// Leaves out of the held directions of a support the one in which its table lets the
/// point slide. Throws InputError with its location if that direction is not held.
void let_slide(const Table& table, models::Support& support);

}  // namespace tress::simulation
