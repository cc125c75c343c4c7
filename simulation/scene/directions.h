#pragma once

#include <string_view>

#include "contract/layers.h"
#include "math/frame.h"
#include "simulation/scene/table.h"

namespace tress::simulation {

/// The vector of `key`, its length 1. Throws InputError at its place when it is 0.
Vec direction(const Table& table, std::string_view key);

/// x without its part along the unit vector `axis`, its length 1; 0 where nothing is left
/// (less than 1e-9 of x).
Vec across(const Vec& axis, const Vec& x);

/// Of unit tangent e0 and e1 nearest to `normal`, which is across() it and not 0.
Frame frame_of(const Vec& tangent, const Vec& normal);

}  // namespace tress::simulation
