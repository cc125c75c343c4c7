#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Curves of USD's BasisCurves [OpenUSD, UsdGeomBasisCurves].
enum class CurveBasis { linear, bezier, bspline, catmull_rom };
std::optional<CurveBasis> curve_basis(std::string_view type, std::string_view basis);

/// Points on the curve of these control points, which are not on it themselves: four to a
/// piece of a cubic, and its end; those of a linear curve are its own. Pinned: the curve
/// begins and ends at the outer control points. Empty if there are too few for a piece,
/// or of bezier no whole number of pieces.
std::vector<Vec> points_on(std::span<const Vec> control, CurveBasis basis, bool pinned);

}  // namespace tress::simulation
