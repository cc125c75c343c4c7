#pragma once

#include "models/supports/support_rows.h"
#include "simulation/table/table.h"

/// Motion of a support over time, from its table.
namespace tress::simulation {

/// Returns the motion that a [[supports]] table describes: its keyframes, directions and
/// twist. `start` is the place and the frame of the held point where the strand begins.
/// They are kept where the table has no rows. Throws InputError with the location of rows
/// that are not ascending, or of directions that determine no rotation.
models::RootMotion support_path(const Table& table, const models::StrandPlace& start);

/// Leaves out of the held directions of a support the one in which its table lets the
/// point slide. Throws InputError with its location if that direction is not held.
void let_slide(const Table& table, models::Support& support);

}  // namespace tress::simulation
