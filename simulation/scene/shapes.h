#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "models/strand/strand.h"
#include "simulation/scene/material_table.h"

namespace tress::simulation {

/// Returns curvatures about e1 and e2 that vary smoothly and at random along the strand:
/// 32 waves of random phase and wave number. Over all seeds each curvature has mean 0,
/// root mean square `amplitude` (1/m) and covariance exp(-d^2/(2 correlation^2))
/// amplitude^2 at distance d (m). One draw deviates by about 1/sqrt(32) of these. Throws
/// InputError unless correlation > 0 and both are finite.
Shape fuzzy_shape(double amplitude, double correlation, std::uint64_t seed,
                  std::uint64_t stream);

/// A strand through points in space.
struct PointCurve {
  double length = 0;  // m
  Vec position;       // of the root
  Frame frame;        // there, e1 nearest to `normal`
  Shape shape;        // constant over each segment
};

/// Returns the curve through these points: a natural cubic spline over the length of the
/// polyline, straight at its two ends (noticeable over about two points). Frames are
/// carried along it without twist (double reflection: Wang, Juttler, Zheng & Liu 2008).
/// Each segment has the Darboux vector that turns the frame at its start into that at its
/// end. Tangents at the joints are those of the spline; positions have an error of second
/// order in the length of the segments. Throws InputError naming `where` on fewer than
/// three points, or two equal ones in a row.
PointCurve through_points(std::span<const double> points, int elements, double grading,
                          Vec normal, const std::string& where);

/// The keys of a shape that [strand] and [groom] share.
std::span<const Parameter> shape_parameters();
/// The keys that apply to each shape.
std::span<const Use> shape_uses();

/// The natural shape that a table with shape_parameters() gives a strand of this length
/// (m); not "points". Strands of one scene share its seed and differ by `stream`.
Shape natural_shape(const Table& table, const StrandMaterial& material, double length,
                    std::uint64_t seed, std::uint64_t stream);

}  // namespace tress::simulation
