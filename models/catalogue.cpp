#include "models/catalogue.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "contract/open_catalogue.h"
#include "models/clothoid/super_clothoid.h"
#include "models/constrained/bead_on_wire.h"
#include "models/constrained/inextensible_chain.h"
#include "models/constrained/tinkertoys.h"
#include "models/reduced/articulated_chain.h"
#include "models/reduced/force_transport.h"
#include "models/reduced/four_strands.h"
#include "models/reduced/super_helix.h"

namespace tress::models {

// Each is defined in its model's file.
ModelEntry double_pendulum_entry();
ModelEntry andrews_squeezer_entry();
ModelEntry slider_crank_entry();
ModelEntry car_axis_entry();
ModelEntry beam_entry();
ModelEntry wheelset_entry();
ModelEntry filament_entry();
ModelEntry der_entry();
ModelEntry corde_entry();
ModelEntry xpbd_cosserat_entry();
ModelEntry dynamic_spline_entry();
ModelEntry kirchhoff_nodal_entry();
ModelEntry mass_spring_entry();
ModelEntry inextensible_strand_entry();
ModelEntry lifted_curls_entry();

namespace {

/// Makes one system of several strands; null where options or strands have no such form.
template <Unknown unknown>
std::unique_ptr<System> together(std::span<const Strand> strands,
                                 const Parameters& parameters,
                                 std::vector<Effects> effects) {
  if (std::ranges::any_of(effects, hold_contacts)) return nullptr;
  return four_strands(strands, unknown, reduced_options(parameters), effects);
}

// clang-format off
std::vector<ModelEntry> built_in_models() {
  return {
      ModelEntry{"bead_on_wire", "bead on a circle, ellipse, helix or trefoil; x with lambda, or one coordinate", "Witkin 1997", bead_on_wire_parameters(), make_bead_on_wire},
      ModelEntry{"tinkertoys", "3n particles as a chain, ring, net, tree or over-constrained truss", "Witkin 1997", tinkertoys_parameters(), make_tinkertoys},
      ModelEntry{"inextensible_chain", "hanging strand of n rigid links; 3n with n multipliers, open or closed", "Baraff 1996", inextensible_chain_parameters(), make_inextensible_chain},
      double_pendulum_entry(),
      andrews_squeezer_entry(),
      slider_crank_entry(),
      car_axis_entry(),
      beam_entry(),
      wheelset_entry(),
      filament_entry(),
      ModelEntry{"super_helix", "inextensible rod of n helices; 3n, 2n or n curvatures and twists", "Bertails 2006, 2009", super_helix_parameters(), on_described_strand<make_super_helix>, make_super_helix, together<Unknown::curvature>},
      ModelEntry{"super_helix_tree", "super_helix with branches: palm tree, algae, complex tree, man, willow", "Bertails 2009", super_helix_tree_parameters(), make_super_helix_tree},
      ModelEntry{"super_clothoid", "inextensible rod of n clothoids; 6n, 4n or 2n curvatures and twists", "Casati 2013", super_clothoid_parameters(), on_described_strand<make_super_clothoid>, make_super_clothoid, nullptr, Roots::clamped_or_free, 4},
      ModelEntry{"super_clothoid_tree", "super_clothoid with branches: the trees of super_helix_tree", "Casati 2013", super_clothoid_tree_parameters(), make_super_clothoid_tree, nullptr, nullptr, Roots::clamped_or_free, 4},
      ModelEntry{"articulated_chain", "n rigid links with ball joints and springs; 3n, 2n or n angles", "Hadap 2001, 2006; Featherstone 1983", articulated_chain_parameters(), on_described_strand<make_articulated_chain>, make_articulated_chain, together<Unknown::joint_angle>},
      ModelEntry{"force_transport", "articulated_chain whose part beyond a joint moves rigidly with it: our reconstruction", "Wang, thesis, NCTU", force_transport_parameters(), on_described_strand<make_force_transport>, make_force_transport, nullptr, Roots::clamped},
      der_entry(),
      corde_entry(),
      xpbd_cosserat_entry(),
      dynamic_spline_entry(),
      kirchhoff_nodal_entry(),
      mass_spring_entry(),
      inextensible_strand_entry(),
      lifted_curls_entry(),
  };
}
// clang-format on

OpenCatalogue<ModelEntry>& all_models() {
  static OpenCatalogue<ModelEntry> all("model", built_in_models());
  return all;
}

}  // namespace

std::span<const ModelEntry> model_catalogue() {
  static const std::span<const ModelEntry> closed = all_models().close();
  return closed;
}

std::span<const ModelEntry> added_models() { return all_models().added(); }

void add_model(const ModelEntry& model, const std::string& where) {
  const std::string name = "model '" + std::string(model.id) + "'";
  refuse_if(model.make == nullptr, name + " cannot be made", where,
            "set ModelEntry::make");
  for (const Parameter& p : model.parameters) {
    refuse_if(model.on_strand != nullptr &&
                  std::ranges::count(strand_parameters(), p.name, &Parameter::name) > 0,
              name + " declares '" + std::string(p.name) + "', which all strands have",
              where, "leave it out: the strand has its value");
  }
  all_models().add(model, where);
}

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
