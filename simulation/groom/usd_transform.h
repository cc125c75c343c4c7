#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "math/mat3.h"

namespace tress::simulation {

/// x -> linear x + shift.
struct Affine {
  /// Linear part.
  Mat3 linear = identity();
  Vec shift;  // part that moves the origin

  /// Returns the image of x.
  Vec operator()(const Vec& x) const { return linear * x + shift; }
  /// The map that applies `inner` first.
  friend Affine operator*(const Affine& outer, const Affine& inner) {
    return {outer.linear * inner.linear, outer(inner.shift)};
  }
};

/// The inverse; none: the linear part is singular.
std::optional<Affine> inverse(const Affine& a);

/// Returns the map of an operation of USD's Xformable: its name, xformOp:KIND or
/// xformOp:KIND:SUFFIX, and its numbers [OpenUSD, UsdGeomXformOp]. Kinds are translate,
/// scale and rotate along or about one axis (translateX) or three, orient (w, x, y, z)
/// and transform (a matrix by rows, for row vectors). Rotations are in the order of their
/// letters (degrees). None: another kind, the wrong number of numbers, or a matrix that
/// is not affine.
std::optional<Affine> usd_operation(std::string_view name, std::span<const double> x);

}  // namespace tress::simulation
