#include "models/maximal/kirchhoff_nodal.h"

#include "contract/input_error.h"
#include "contract/tangent_choice.h"
#include "math/quaternion.h"
#include "models/maximal/nodal_strand.h"
#include "models/maximal/nodal_system.h"

namespace tress::models {
namespace {

/// The vector of Cayley's map that turns one frame into the other: 2 tan(angle/2) along
/// the axis.
Vec turn(const Frame& before, const Frame& after) {
  const Quaternion p = quaternion_of(before), q = nearer(p, quaternion_of(after));
  const Vec phi = (1 / dot(p, q)) * turn_between(p, q);
  // At 2 tan(angle/2) = 1e6 the angle is 4e-6 short of pi: no grid for that shape.
  if (!(dot(phi, phi) < 1e12)) {
    throw InputError("neighbouring elements are turned by pi", "kirchhoff_nodal",
                     "take more elements for this shape");
  }
  return phi;
}

}  // namespace

std::unique_ptr<System> kirchhoff_nodal(const Strand& strand,
                                        const KirchhoffNodalOptions& options,
                                        Effects effects) {
  check_unbranched(strand, "kirchhoff_nodal");
  if (strand.free_root) {
    throw InputError("curvatures do not say where a free root is", "kirchhoff_nodal",
                     "use a clamped root, or der, corde or super_helix");
  }
  const NodalStrand nodal(strand, "kirchhoff_nodal", 0);
  NodalParts parts;
  for (const MaximalStrand::MassPoint& point : nodal.parts.mass) {
    parts.rod.mass.push_back(point.mass);
    parts.node_length.push_back(point.length);
  }
  for (std::size_t j = 0; j < strand.segments.size(); ++j) {
    const Segment& segment = strand.segments[j];
    const Segment* before = j > 0 ? &strand.segments[j - 1] : nullptr;
    const auto of_joint = [&](const std::vector<Frame>& edges) {
      return turn(j > 0 ? edges[j - 1] : nodal.root.place.frame, edges[j]);
    };
    const double arc = (segment.length + (before != nullptr ? before->length : 0)) / 2;
    parts.rod.length.push_back(segment.length);
    parts.rod.rotor.push_back(strand.material.density * segment.section.polar() *
                              segment.length);
    parts.rod.arc.push_back(arc);
    parts.rod.joints.push_back(
        rod_joint(strand.material, before, segment, of_joint(nodal.natural)));
    const Vec start = (1 / arc) * of_joint(nodal.initial);
    parts.start.insert(parts.start.end(), {start.x, start.y, start.z});
  }
  parts.root = strand.root;
  parts.curvature = 1 / strand.length();
  parts.rate = typical_rate(strand);
  parts.tangent = options.tangent;
  parts.effects = std::move(effects);
  return std::make_unique<NodalSystem>(std::move(parts));
}

std::span<const Parameter> kirchhoff_nodal_parameters() {
  return {&tangent_parameter, 1};
}

std::unique_ptr<System> make_kirchhoff_nodal(const Strand& strand,
                                             const Parameters& parameters,
                                             Effects effects) {
  return kirchhoff_nodal(strand, {.tangent = tangent_choice(parameters)},
                         std::move(effects));
}

}  // namespace tress::models
