#pragma once

#include <memory>
#include <span>

#include "models/effects/effect.h"
#include "models/maximal/maximal_system.h"
#include "models/parameters.h"
#include "models/strand/strand.h"

namespace tress {

/// Dynamic spline [Lenoir et al. 2004; Theetten et al. 2008]: the centreline is a cubic
/// B-spline (cubic_spline.h) whose control points are the coordinates; a knot at every
/// joint of segments. With s the arc length at rest,
///
///     E = int EA (|r'| - 1)^2/2 + EI |t x t'|^2/2 ds,    t = r'/|r'|,
///
/// geometrically exact: |t x t'| = |r' x r''|/|r'|^2 turns per length at rest. Mass
/// rho A int N_k N_l ds is consistent (four points of Gauss a span, exact); bending is
/// summed over two points a span, stretching over n + 2 in all: one a span and another in
/// the first and the last, as many as there are ways to stretch a straight strand.
/// Frequencies, (beta h)^4/1440 too high, and statics are of order 4. With two or three
/// points in every span what a bent cubic cannot help stretching, EA h^6 or so, takes two
/// digits from a hair of ten spans (EA L^2/EI = 4e6). The initial shape is interpolated:
/// its length is off by O(h^4).
///
/// Clamped by multipliers: r = r_0(t) (3 rows) and r' across e1 and e2 of the clamp (2
/// rows).
///
/// No twist: exact for a naturally straight rod of circular section whose tip is free,
/// where the twisting moment is 0 all along, but for the section's rotational inertia,
/// which is left out. Natural curvature or twist, other sections and internal friction
/// need a material frame: InputError.
struct DynamicSplineOptions {
  LinearKind solver = LinearKind::automatic;
};

/// Throws InputError unless the strand is a chain that the equations above describe.
std::unique_ptr<System> dynamic_spline(const Strand& strand,
                                       const DynamicSplineOptions& options,
                                       Effects effects);

std::span<const Parameter> dynamic_spline_parameters();
std::unique_ptr<System> make_dynamic_spline(const Strand& strand,
                                            const Parameters& parameters,
                                            Effects effects);

}  // namespace tress
