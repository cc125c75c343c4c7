#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/maximal/nodal_strand.h"
#include "models/quaternion_rods/corde_edge.h"
#include "models/quaternion_rods/cosserat_edge.h"
#include "models/quaternion_rods/quaternion_joint.h"

namespace tress::models {

/// A model of rods with a quaternion for every edge: the Edge of a segment, and the
/// inertia of quaternions, 4 rho (I1 + I2 + rotary A l^2) l.
template <class Edge>
struct QuaternionRodKind {
  std::string model;  // id of the model
  /// Makes the edge of a segment.
  std::function<Edge(const Material&, const Segment&)> edge_of;
  double rotary = 0;  // factor of the inertia that edges add
};
/// Returns the kind with options of the model; null: default options.
template <class Edge>
QuaternionRodKind<Edge> rod_kind(const Parameters* options);
/// Returns the kind of corde.
template <>
QuaternionRodKind<CordeEdge> rod_kind(const Parameters* options);
/// Returns the kind of xpbd_cosserat.
template <>
QuaternionRodKind<CosseratEdge> rod_kind(const Parameters* options);

/// A chain with nodes at the segments' ends, masses lumped there, and quaternions: the
/// coordinates behind those of nodes. Joints are between edges; the clamp's comes first.
template <class Edge>
struct QuaternionStrandParts {
  NodalStrand nodal;                    // nodes and root
  std::vector<Edge> edges;              // edges from the root on
  std::vector<QuaternionJoint> joints;  // joints from the root on
};
/// Throws InputError naming the model unless the strand is a chain.
template <class Edge>
QuaternionStrandParts<Edge> quaternion_strand(const Strand& strand,
                                              const QuaternionRodKind<Edge>& kind);

}  // namespace tress::models
