#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/maximal/maximal_system.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Discrete elastic rod [Bergou et al. 2008, 2010]: n edges between nodes x_i, an angle
/// theta per edge for its material frame. With integrated strains kappa (twist and two
/// curvatures, joint_strain.h) between neighbouring edges and l the mean of their
/// lengths,
///
///     E = sum_joints (kappa - kappa_rest)^T diag(GJ, EI1, EI2) (kappa - kappa_rest)/(2
///     l)
///       + sum_edges EA l (|e|/l - 1)^2/2,    friction = gamma/l per integrated strain.
///
/// The clamp is a wall half an edge before the first edge's middle: a joint of length l/2
/// between the clamp's frame and edge 0, which makes the scheme second order. Rest
/// strains are those between the chords of the natural shape. Mass is lumped at the
/// nodes, rho (I1 + I2) l at the angles. A joint's twist is between -pi and pi.
///
/// Frames are functions of q relative to reference frames, which are fixed until an edge
/// has turned by more than 60 degrees from its reference; accept() then takes the current
/// frame as the reference and adds to theta' the turning of the old one, so neither
/// frames nor spins jump.
///
/// The kinetic energy of the angles uses theta' in place of the section's spin,
/// theta' + c . e' with c of rod_edge.h, which keeps M constant; the difference grows
/// with the angle from the reference. The angular momentum of a free strand therefore
/// drifts by some (r/L)^2 of itself per radian for any step size, and a new reference
/// changes the energy by as much (tests/models/maximal/test_framed_spline.cpp). The
/// quaternions of corde do not have this error.
struct DerOptions {
  bool inextensible = false;         // |e| = l by constraints with multipliers
  bool quasi_static_twist = false;   // angles have no inertia
  Tangent tangent = Tangent::exact;  // stiff: no second derivatives of strains
  LinearKind solver = LinearKind::automatic;
};

/// Throws InputError unless the strand is a chain.
std::unique_ptr<System> der(const Strand& strand, const DerOptions& options,
                            Effects effects);

std::span<const Parameter> der_parameters();
std::unique_ptr<System> make_der(const Strand& strand, const Parameters& parameters,
                                 Effects effects);

}  // namespace tress::models
