#include "contract/jacobian_choice.h"
#include "models/entry.h"
#include "models/maximal/der_elasticity.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/nodal_strand.h"

namespace tress::models {
namespace {

/// Discrete elastic rod [Bergou et al. 2008, 2010]: n edges between nodes x_i, an angle
/// theta per edge for its material frame. With integrated strains kappa (twist and two
/// curvatures, joint_strain.h) between neighbouring edges and l the mean of their
/// lengths,
///
///     E = sum_joints (kappa - kappa_rest)^T diag(GJ, EI1, EI2) (kappa - kappa_rest)/(2
///     l)
///       + sum_edges EA l (|e|/l - 1)^2/2,    friction = gamma/l per integrated strain.
///
/// The clamp is a wall half an edge before the first edge's middle. A joint of length l/2
/// between the clamp's frame and edge 0 makes the scheme second order. Rest strains are
/// those between the chords of the natural shape. Mass is lumped at the nodes, rho (I1 +
/// I2) l at the angles. A joint's twist starts within half a turn of its rest and counts
/// whole turns from then on (wound(), joint_strain.h).
///
/// Frames are functions of q relative to reference frames. A reference frame is fixed
/// until its edge has turned by more than 60 degrees from it. The function accept() then
/// takes the current frame as the reference and adds the turning of the old one to
/// theta', so neither frames nor spins jump.
///
/// The kinetic energy of the angles uses theta' in place of the section's spin, theta' +
/// c . e' with c of rod_edge.h, which keeps M constant. The difference grows with the
/// angle from the reference. The angular momentum of a free strand therefore drifts by
/// about (r/L)^2 of itself per radian for any step size. A new reference changes the
/// energy by the same fraction (tests/models/maximal/test_framed_spline.cpp). The
/// quaternions of corde do not have this error.
struct DerOptions {
  bool inextensible = false;            // |e| = l by constraints with multipliers
  bool quasi_static_twist = false;      // angles have no inertia
  Jacobian jacobian = Jacobian::exact;  // elastic: no second derivatives of strains
  LinearKind solver = LinearKind::automatic;
};

/// Throws InputError unless the strand is a chain.
std::unique_ptr<System> der(const Strand& strand, const DerOptions& options,
                            Effects effects) {
  const std::size_t n = strand.segments.size();
  NodalStrand nodal(strand, "der", n);
  MaximalStrand& parts = nodal.parts;
  std::vector<DerElasticity::EdgeData> edges;
  for (std::size_t i = 0; i < n; ++i) {
    const Segment& segment = strand.segments[i];
    const Material material = strand.material_of(segment);
    const double stretch =
        material.youngs_modulus * segment.section.area() / segment.length;
    edges.push_back(
        {nodal.initial[i], segment.length, options.inextensible ? 0.0 : stretch});
    if (!options.quasi_static_twist) {
      parts.inertia[i] = material.density * segment.section.polar() * segment.length;
    }
    // The frames of a rigid motion turn with the whole.
    parts.rate[3 * (n + 1) + i] = dot(nodal.root.spin, nodal.initial[i].e0);
  }
  std::vector<RodJoint> joints;
  for (std::size_t i = 0; i < n; ++i) {
    const Segment* before = i > 0 ? &strand.segments[i - 1] : nullptr;
    if (before == nullptr && !parts.clamped) continue;
    const Vec rest =
        joint_strain(before != nullptr ? nodal.natural[i - 1] : nodal.root.place.frame,
                     nodal.natural[i]);
    joints.push_back(rod_joint(strand, before, strand.segments[i], rest));
  }
  parts.elasticity = std::make_unique<DerElasticity>(std::move(edges), std::move(joints),
                                                     parts.clamped, options.jacobian);
  if (options.inextensible) parts.constraints = inextensible(parts, strand);
  parts.effects = std::move(effects);
  parts.solver = options.solver;
  parts.jacobian = options.jacobian;
  return std::make_unique<MaximalSystem>(std::move(parts));
}

std::span<const Parameter> der_parameters() {
  static constexpr std::array all{
      Parameter{.name = "stretch",
                .help = "springs of stiffness EA, or edges of constant length",
                .choices = "extensible|inextensible"},
      Parameter{.name = "twist",
                .help = "angles with the section's inertia, or without",
                .choices = "dynamic|quasi_static"},
      jacobian_parameter, maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_der(const Strand& strand, const Parameters& parameters,
                                 Effects effects) {
  DerOptions options;
  options.inextensible = parameters.word("stretch") == "inextensible";
  options.quasi_static_twist = parameters.word("twist") == "quasi_static";
  options.jacobian = jacobian_choice(parameters);
  options.solver = maximal_solver(parameters);
  return der(strand, options, std::move(effects));
}

}  // namespace

ModelEntry der_entry() {
  return {.id = "der",
          .summary =
              "discrete elastic rod of n edges; 3n positions and n angles, extensible or "
              "with n multipliers",
          .source = "Bergou 2008, 2010",
          .parameters = der_parameters(),
          .make = on_described_strand<make_der>,
          .on_strand = make_der};
}

}  // namespace tress::models
