#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Curves of USD's BasisCurves [OpenUSD, UsdGeomBasisCurves].
enum class CurveBasis { linear, bezier, bspline, catmull_rom };
std::optional<CurveBasis> curve_basis(std::string_view type, std::string_view basis);

/// Returns the number of points of points_on() for this number of control points; 0:
/// too few for a piece or, for bezier, no whole number of pieces.
std::size_t points_of_curve(std::size_t control, CurveBasis basis, bool pinned);

/// Returns the numbers of control points that suit a basis, as "... need 4, 7, 10
/// points".
std::string counts_in_words(CurveBasis basis, bool pinned);

/// Points on the curve of these control points, which are not on it themselves: four to a
/// piece of a cubic, and its end; those of a linear curve are its own. A bspline or
/// catmullRom that is pinned begins and ends at the outer control points; one that is not
/// has its first piece between the second and the third. Empty if points_of_curve() is 0.
std::vector<Vec> points_on(std::span<const Vec> control, CurveBasis basis, bool pinned);

}  // namespace tress::simulation
