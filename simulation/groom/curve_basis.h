#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Curves of USD's BasisCurves [OpenUSD, UsdGeomBasisCurves]: `linear`, or cubic with one
/// of the bases `bezier`, `bspline` and `catmull_rom`.
enum class CurveBasis { linear, bezier, bspline, catmull_rom };
/// Returns the basis of these words of USD; none if there is no such basis.
std::optional<CurveBasis> curve_basis(std::string_view type, std::string_view basis);

/// Returns the number of points of points_on() for this number of control points; 0:
/// too few for a piece or, for bezier, no whole number of pieces.
std::size_t points_of_curve(std::size_t control, CurveBasis basis, bool pinned);

/// Returns the numbers of control points that suit a basis, as "... need 4, 7, 10
/// points".
std::string counts_in_words(CurveBasis basis, bool pinned);

/// Returns points on the curve of these control points, which are not on it themselves:
/// four per piece of a cubic, and its end. Points of a linear curve are its control
/// points. A pinned bspline or catmullRom begins and ends at the outer control points;
/// otherwise its first piece lies between the second and the third. Empty if
/// points_of_curve() is 0.
std::vector<Vec> points_on(std::span<const Vec> control, CurveBasis basis, bool pinned);

}  // namespace tress::simulation
