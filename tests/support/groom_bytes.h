#pragma once

#include <string>
#include <string_view>

#include "simulation/groom/polylines.h"

namespace tress::testing_support {

/// The bytes of a groom file: hair, data, bin, ply (ascii), ply.little, ply.big, usda,
/// vtp (ascii), vtp.binary, vtp.appended.
std::string groom_bytes(std::string_view format, const simulation::Polylines& lines);

}  // namespace tress::testing_support
