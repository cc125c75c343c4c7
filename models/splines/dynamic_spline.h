#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/maximal/maximal_system.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Dynamic spline [Lenoir et al. 2004; Theetten et al. 2008]: the centreline is a cubic
/// B-spline (cubic_spline.h) whose control points are coordinates, with an angle theta at
/// each knot for the material frame there and a knot at every joint of segments. With s
/// the arc length at rest, t = r'/|r'| and `rest` in the natural shape,
///
///     E = int EA (|r'| - |r'|_rest)^2/2 + EI1 (kappa_1 - kappa_1rest)^2/2
///         + EI2 (kappa_2 - kappa_2rest)^2/2 ds + sum_spans GJ (phi - phi_rest)^2/(2 h),
///     friction = gamma on the rates of kappa_1, kappa_2 and phi/h,
///
/// where kappa = t x t' = r' x r''/|r'|^2, the geometrically exact curvature per length
/// at rest, is taken along the axes of the section (SplineBend), and phi is the twist of
/// a span of length h between the frames at its ends (SplineTwist, between -pi and pi).
/// Rest strains are those of the spline through the natural shape.
///
/// Mass rho A int N_k N_l ds is consistent (four Gauss points per span, exact). Bending
/// is summed over two points per span, stretching over n + 2 in all: one per span and
/// another in the first and the last, as many as a straight strand has stretching modes.
/// With two or three points in every span, the unavoidable stretch of a bent cubic, about
/// EA h^6, costs a hair of ten spans two digits (EA L^2/EI = 4e6). rho (I1 + I2) is
/// lumped at the angles, with theta' for the section's spin as in der.h: a free strand
/// conserves momentum and energy up to the share of this term, some (r/L)^2.
///
/// Plane bending is of order 4: statics, and frequencies, which are (beta h)^4/1440 too
/// high. Twisting is of order 2: torsional frequencies are (beta h)^2/24 too low. The
/// initial shape is interpolated: its length is off by O(h^4).
///
/// Clamped by multipliers: r = r_0(t) (3 rows) and r' orthogonal to e1 and e2 of the
/// clamp (2 rows), whose frame is that of the first knot. Frames at the other knots are
/// functions of q relative to reference frames, like those of edges in der.h.
///
/// Without twist there are neither angles nor frames, and bending is EI |kappa|^2/2. Up
/// to the omitted rotational inertia of the section, this is exact for a naturally
/// straight rod of circular section with a free tip, where the twisting moment is 0
/// everywhere. Natural curvature or twist, other sections and internal friction are then
/// InputErrors.
struct DynamicSplineOptions {
  bool twist = true;  // angles and frames
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

}  // namespace tress::models
