#include "models/reduced/super_helix.h"

#include "models/reduced/arc.h"
#include "models/reduced/reduced_system.h"
#include "models/reduced/trees.h"
#include "models/strand/strand_parameters.h"

namespace tress::models {

std::unique_ptr<System> super_helix(const Strand& strand, const ReducedOptions& options,
                                    Effects effects) {
  return make_reduced_system<Helix, Arc>(
      reduced_strand(strand, Unknown::curvature, options, std::move(effects)),
      Unknown::curvature, options.dofs);
}

std::span<const Parameter> super_helix_parameters() { return reduced_parameters(); }

std::unique_ptr<System> make_super_helix(const Strand& strand,
                                         const Parameters& parameters, Effects effects) {
  return super_helix(strand, reduced_options(parameters), std::move(effects));
}

std::span<const Parameter> super_helix_tree_parameters() {
  static const std::vector<Parameter> all = [] {
    const std::span<const Parameter> material = material_parameters();
    std::vector<Parameter> own(material.begin(), material.end());
    own.push_back({.name = "tree", .help = "shape of the tree", .choices = tree_choices});
    // Branches leave the plane.
    own.push_back({.name = "modes",
                   .help =
                       "unknowns of an element. bend_twist: two curvatures and twist. "
                       "bend: two curvatures",
                   .choices = "bend_twist|bend"});
    for (const Parameter& p : reduced_parameters()) {
      if (p.name != "modes") own.push_back(p);
    }
    return own;
  }();
  return all;
}

Strand described_tree(const Parameters& parameters) {
  Strand tree;
  tree.material = material(parameters);
  tree.segments = tree_segments(parameters.word("tree"));
  tree.root = root_motion(parameters);
  tree.free_root = free_root(parameters);
  return tree;
}

std::unique_ptr<System> make_super_helix_tree(const Parameters& parameters) {
  return super_helix(described_tree(parameters), reduced_options(parameters),
                     strand_effects(parameters));
}

}  // namespace tress::models
