#pragma once

#include "models/elements/element_elasticity.h"
#include "models/maximal/nodal_strand.h"
#include "models/strand/rod_joint.h"

namespace tress::models {

/// Builds a rod model from the laws of its elements (rod_element.h). Nodes are the ends
/// of the segments with half of the mass of each neighbour; the clamp, gravity and all
/// effects, energies and linear solvers come from MaximalSystem.
class ElementRod {
 public:
  /// Throws InputError naming `model` unless the strand is a chain.
  ElementRod(const Strand& strand, const std::string& model);

  /// Adds an element over nodes `first`, `first` + 1, ..., which is free of stress at the
  /// strand's rest shape. Node -1 belongs to the clamp (ElementElasticity).
  template <RodLaw Law>
  void add(int first, Law law, const ElementConstants<Law>& constants) {
    place(first, std::make_unique<LawElement<Law>>(std::move(law), constants));
  }

  /// Edge between two nodes.
  struct Edge {
    int first;               // node
    const Segment& segment;  // segment that the edge is made from
  };
  /// Returns the edges from the root on.
  std::vector<Edge> edges() const;

  /// A joint: three nodes with two edges between them. The first joint of a clamped
  /// strand is that of the clamp with edge 0, half an edge long.
  struct Joint {
    int first;     // node
    RodJoint rod;  // section and rest shape of the joint
  };
  /// Returns the joints from the root on.
  std::vector<Joint> joints() const;

  /// Makes the system of all elements.
  std::unique_ptr<System> system(Effects effects, LinearKind solver) &&;

 private:
  void place(int first, std::unique_ptr<RodElement> element);

  const Strand& strand_;
  NodalStrand nodal_;
  std::vector<Vec> rest_;  // the clamp's node, then all others
  std::vector<ElementElasticity::Placed> elements_;
};

}  // namespace tress::models
