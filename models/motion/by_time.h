#pragma once

#include <limits>

namespace tress::models {

/// Time of the last teleport where none was carried out: a motion with teleports then
/// jumps at their times. After a teleport the motion is that after it, also at times
/// before it and after the next one.
inline constexpr double by_time = std::numeric_limits<double>::quiet_NaN();

}  // namespace tress::models
