#include "models/catalogue.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "models/constrained/bead_on_wire.h"
#include "models/constrained/inextensible_chain.h"
#include "models/constrained/tinkertoys.h"
#include "models/maximal/der.h"
#include "models/maximal/kirchhoff_nodal.h"
#include "models/maximal/mass_spring.h"
#include "models/published/andrews_squeezer.h"
#include "models/published/beam.h"
#include "models/published/double_pendulum.h"
#include "models/published/slider_crank.h"
#include "models/quaternion_rods/corde.h"
#include "models/quaternion_rods/xpbd_cosserat.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/force_transport.h"
#include "models/reduced/super_helix.h"
#include "models/splines/dynamic_spline.h"
#include "models/strand/strand_parameters.h"

namespace tress::models {
namespace {

using OnStrand = std::unique_ptr<System>(const Strand&, const Parameters&, Effects);

/// On the strand that strand_parameters() describe.
template <OnStrand* make>
std::unique_ptr<System> on_described_strand(const Parameters& parameters) {
  return make(strand(parameters), parameters, strand_effects(parameters));
}

using Batch = std::unique_ptr<System>(std::span<const Strand>, const ReducedOptions&,
                                      std::vector<Effects>);

/// Null for options that batches do not support.
template <Batch* make>
std::unique_ptr<System> together(std::span<const Strand> strands,
                                 const Parameters& parameters,
                                 std::vector<Effects> effects) {
  const ReducedOptions options = reduced_options(parameters);
  const bool can = options.tangent == ReducedTangent::stiff &&
                   options.method == TreeMethod::recursive && !strands.front().free_root;
  return can ? make(strands, options, std::move(effects)) : nullptr;
}

}  // namespace

// clang-format off
std::span<const ModelEntry> model_catalogue() {
  static const std::array entries = {
      ModelEntry{"bead_on_wire", "bead on a circle, ellipse, helix or trefoil; x with lambda, or one coordinate", "Witkin 1997", bead_on_wire_parameters(), make_bead_on_wire},
      ModelEntry{"tinkertoys", "3n particles as a chain, ring, net, tree or over-constrained truss", "Witkin 1997", tinkertoys_parameters(), make_tinkertoys},
      ModelEntry{"inextensible_chain", "hanging strand of n rigid links; 3n with n multipliers, open or closed", "Baraff 1996", inextensible_chain_parameters(), make_inextensible_chain},
      ModelEntry{"double_pendulum", "2 angles, point masses, chaotic", "Landau & Lifshitz 1976, section 5", double_pendulum_parameters(), make_double_pendulum},
      ModelEntry{"andrews_squeezer", "7 angles, 6 loop closures; planar mechanism with one spring", "Test Set for IVP Solvers 2.4, andrews", andrews_squeezer_parameters(), make_andrews_squeezer},
      ModelEntry{"slider_crank", "2 angles, 1 slide, 4 elastic modes, 3 constraints (one driven)", "Simeon 1996; Test Set for IVP Solvers 2.4, crank", slider_crank_parameters(), make_slider_crank},
      ModelEntry{"beam", "n angles of inextensible segments, clamped, pushed at the tip", "Hairer & Wanner 1996, IV.1; Test Set for IVP Solvers 2.4, beam", beam_parameters(), make_beam},
      ModelEntry{"super_helix", "inextensible rod of n helices; 3n, 2n or n curvatures and twists", "Bertails 2006, 2009", super_helix_parameters(), on_described_strand<make_super_helix>, make_super_helix, together<super_helix_batch>},
      ModelEntry{"super_helix_tree", "the same, branching: palm tree, algae, complex tree, man, willow", "Bertails 2009", super_helix_tree_parameters(), make_super_helix_tree},
      ModelEntry{"articulated_chain", "n rigid links with ball joints and springs; 3n, 2n or n angles", "Hadap 2001, 2006; Featherstone 1983", articulated_chain_parameters(), on_described_strand<make_articulated_chain>, make_articulated_chain, together<articulated_chain_batch>, Roots::clamped},
      ModelEntry{"force_transport", "the same, what lies beyond a joint moving rigidly with it: our reconstruction", "Wang, thesis, NCTU", force_transport_parameters(), on_described_strand<make_force_transport>, make_force_transport, together<force_transport_batch>, Roots::clamped},
      ModelEntry{"der", "discrete elastic rod of n edges; 3n positions and n angles, extensible or with n multipliers", "Bergou 2008, 2010", der_parameters(), on_described_strand<make_der>, make_der},
      ModelEntry{"corde", "Cosserat rod of n edges; 3n positions and n quaternions held together by penalties", "Spillmann & Teschner 2007", corde_parameters(), on_described_strand<make_corde>, make_corde},
      ModelEntry{"xpbd_cosserat", "Cosserat rod of n edges as compliant constraints; 3n positions and n quaternions", "Kugelstadt & Schoemer 2016; Deul 2018", xpbd_cosserat_parameters(), on_described_strand<make_xpbd_cosserat>, make_xpbd_cosserat},
      ModelEntry{"dynamic_spline", "cubic B-spline of n spans with material angles at its knots; 3(n + 3) control points, clamped by 5 multipliers", "Lenoir 2004; Theetten 2008", dynamic_spline_parameters(), on_described_strand<make_dynamic_spline>, make_dynamic_spline},
      ModelEntry{"kirchhoff_nodal", "Kirchhoff's equations by finite differences; 3n curvatures and twists of inextensible edges", "Hou, Klapper & Si 1998", kirchhoff_nodal_parameters(), on_described_strand<make_kirchhoff_nodal>, make_kirchhoff_nodal, nullptr, Roots::clamped},
      ModelEntry{"mass_spring", "point masses with springs for stretch, bending and torsion; 3n", "Rosenblum 1991; Selle 2008", mass_spring_parameters(), on_described_strand<make_mass_spring>, make_mass_spring},
      ModelEntry{"inextensible_strand", "n rigid links with bending springs and rest angles; 3n with n multipliers", "Baraff 1996; Rosenblum 1991", inextensible_strand_parameters(), on_described_strand<make_inextensible_strand>, make_inextensible_strand},
  };
  return entries;
}
// clang-format on

std::span<const Parameter> setup_parameters(const ModelEntry& model) {
  if (model.on_strand == nullptr) return model.parameters;
  static const auto all = [] {
    std::map<std::string_view, std::vector<Parameter>> lists;
    const std::span<const Parameter> strand = strand_parameters();
    for (const ModelEntry& one : model_catalogue()) {
      std::vector<Parameter>& list = lists[one.id];
      list.assign(strand.begin(), strand.end());
      const auto root = std::ranges::find(list, "motion", &Parameter::name);
      if (one.roots == Roots::clamped) root->choices = bound_root_choices;
      list.insert(list.end(), one.parameters.begin(), one.parameters.end());
    }
    return lists;
  }();
  return all.at(model.id);
}

const ModelEntry& find_model(std::string_view id) {
  std::vector<std::string_view> ids;
  for (const ModelEntry& entry : model_catalogue()) {
    if (entry.id == id) return entry;
    ids.push_back(entry.id);
  }
  throw InputError("unknown model '" + std::string(id) + "'", "--models",
                   suggestion(id, ids, "--list shows the models"));
}

}  // namespace tress::models
