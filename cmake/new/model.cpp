// FILL IN: what this model is, in one sentence.
#include "contract/fill_in.h"
#include "models/elements/element_rod.h"
#include "models/entry.h"

namespace tress::models {
namespace {

/// FILL IN: the equations with symbols and units, the cost, and the source with equation
/// numbers.
///
///     E = sum_edges EA/l (|e| - l)^2/2 + sum_joints ...
///
/// Length of an edge (m). rod_element.h says what a law may state.
struct Stretch {
  static constexpr int nodes = 2, strains = 1;

  template <class T>
  void strain(const Vec3<T>* x, T* s) const {
    using std::sqrt;
    const Vec3<T> edge = x[1] - x[0];
    s[0] = sqrt(dot(edge, edge));
  }
};

ElementConstants<Stretch> constants(const Material& material, const Segment& segment) {
  return {{material.youngs_modulus * segment.section.area() / segment.length}, {0}};
}

/// FILL IN: what bends a joint of three nodes.
struct Bend {
  static constexpr int nodes = 3, strains = 1;

  template <class T>
  void strain(const Vec3<T>* /*x*/, T* /*s*/) const {
    fill_in("the strains s of a joint with its three nodes at x[0], x[1], x[2]");
  }
};

/// FILL IN: stiffness and friction of each strain, from RodJoint's twist, curvature about
/// e1, curvature about e2.
ElementConstants<Bend> constants(const RodJoint& /*joint*/) {
  fill_in("stiffness and friction of a joint's strains");
}

constexpr Parameter own_parameters[] = {maximal_solver_parameter};

std::unique_ptr<System> make_rod(const Strand& strand, const Parameters& parameters,
                                 Effects effects) {
  ElementRod rod(strand, "skeleton_name");
  for (const auto& [first, segment] : rod.edges()) {
    rod.add(first, Stretch{}, constants(strand.material, segment));
  }
  for (const auto& [first, joint] : rod.joints()) {
    rod.add(first, Bend{}, constants(joint));
  }
  return std::move(rod).system(std::move(effects), maximal_solver(parameters));
}

}  // namespace

ModelEntry skeleton_name_entry() {
  return {.id = "skeleton_name",
          .summary = "FILL IN: unknowns and variants, one line",
          .source = "FILL IN: author year",
          .parameters = own_parameters,
          .make = on_described_strand<make_rod>,
          .on_strand = make_rod};
}

}  // namespace tress::models
