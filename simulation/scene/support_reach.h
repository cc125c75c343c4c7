#pragma once

#include <string>

#include "contract/parameters.h"
#include "models/motion/root_motion.h"
#include "models/strand/strand.h"
#include "models/supports/support_rows.h"
#include "simulation/table/table.h"

/// Checks of supports against the strand that they hold, over a whole run.
namespace tress::simulation {

/// A support, or a clamped root, as one end of a part of a strand.
struct SupportedEnd {
  std::string name;                // name for messages
  double arc;                      // arc length from the root, m
  const models::RootMotion* path;  // its places
};

/// Throws InputError with the location of `table`, which describes `b`, if the strand
/// between two ends does not reach from one to the other within `duration` (s).
void check_reach(const SupportedEnd& a, const SupportedEnd& b, bool inextensible,
                 double duration, const Table& table);

/// Holds a strand of a planar model in the two directions of its plane. Throws InputError
/// with the location of `table` if the support leaves the plane within `duration` (s).
void stay_in_plane(const Parameters& model_options, double duration,
                   const models::Strand& strand, const Table& table,
                   models::Support& support);

}  // namespace tress::simulation
