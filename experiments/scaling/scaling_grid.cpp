#include <fmt/format.h>

#include <algorithm>

#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/scaling/scaling.h"
#include "models/catalogue.h"
#include "models/reduced/trees.h"

namespace tress::experiments::scaling {
namespace {

constexpr Parameter settings_of_rows[] = {
    {.name = "structure",
     .help = "rows of one structure",
     .choices = "all|straight|palm_tree|algae|complex_tree|man|willow"},
    {.name = "solver",
     .help = "rows of one solver of the model",
     .choices = "all|recursive|composite|sparse|banded|klu"},
    {.name = "jacobian",
     .help = "rows of one Jacobian of the model",
     .choices = "all|elastic|exact"},
    {.name = "modes",
     .help = "rows of strands with these modes",
     .choices = "all|bend_twist|bend|bend_planar"},
    {.name = "row_s",
     .help = "time to measure the step of one row (s), 0: 1, with --quick 0.02",
     .number = 0,
     .min = 0},
    {.name = "scenes", .help = "scene files instead of our strands", .text = true},
    {.name = "device",
     .help = "device that steps scene files as batches: gpu, or auto, where there is one "
             "(cpu: strand by strand, with every model)",
     .choices = device_choices},
};

struct Variation {
  std::string_view model, solver, jacobian, modes;
};

std::vector<Variation> methods_of_strands() {
  std::vector<Variation> all;
  for (const std::string_view solver : {"recursive", "composite", "sparse"}) {
    for (const std::string_view jacobian : {"elastic", "exact"}) {
      for (const std::string_view modes : {"bend_twist", "bend", "bend_planar"}) {
        all.push_back({"super_helix", solver, jacobian, modes});
      }
      if (solver != "sparse") {
        all.push_back({"articulated_chain", solver, jacobian, "bend_twist"});
      }
    }
  }
  return all;
}

/// Every other strand model: each of its solvers, or once if it has no choice, with the
/// elastic Jacobian if available.
std::vector<Variation> methods_of_others() {
  const std::vector<Variation> known = methods_of_strands();
  std::vector<Variation> all;
  for (const ModelEntry* model : strand_models()) {
    if (std::ranges::find(known, model->id, &Variation::model) != known.end()) continue;
    if (first_word(*model, "solver").empty()) {
      all.push_back({model->id, "", usual_tangent(*model), ""});
    }
    for (const std::string_view solver :
         {"banded", "klu", "sweep", "recursive", "composite"}) {
      if (has_word(*model, "solver", solver)) {
        all.push_back({model->id, solver, usual_tangent(*model), ""});
      }
    }
  }
  return all;
}

constexpr Variation methods_of_trees[] = {
    {"super_helix_tree", "recursive", "elastic", "bend_twist"},
    {"super_helix_tree", "composite", "elastic", "bend_twist"},
    {"super_helix_tree", "recursive", "exact", "bend_twist"},
};

std::vector<int> element_counts(const CommandLine& line) {
  if (!line.elements.empty()) return line.elements;
  return {1, 2, 5, 10, 20, 30, 50, 100, 200, 500};
}

/// Above this, a dense matrix takes seconds a step.
constexpr int largest_dense = 200;

struct SeedFrames {
  std::string_view structure;
  int elements;
  double composite, recursive;  // 0: not given
};

constexpr SeedFrames seed_table[] = {
    {straight, 1, 170, 170}, {straight, 2, 170, 170},     {straight, 10, 40, 120},
    {straight, 20, 4, 54},   {straight, 30, 1.4, 37},     {"palm_tree", 8, 0, 170},
    {"algae", 10, 0, 108},   {"complex_tree", 50, 0, 25}, {"man", 81, 0, 17},
    {"willow", 242, 0, 6},
};

const SeedFrames* seed_frames(const ScalingCase& c) {
  const auto found = std::ranges::find_if(seed_table, [&c](const SeedFrames& row) {
    return row.structure == c.structure && row.elements == c.elements;
  });
  return found == std::end(seed_table) ? nullptr : &*found;
}

/// Released from the natural shape, root held upright.
void set_tree(Parameters& p, std::string_view tree) {
  const Material material = tree_material(tree);
  const auto number = [&p](std::string_view key, double value) {
    p.set(key, fmt::format("{}", value));
  };
  p.set("tree", tree);
  p.set("root_tangent", "up");
  number("density_kg_m3", material.density);
  number("youngs_modulus_pa", material.youngs_modulus);
  number("shear_modulus_pa", material.shear_modulus);
  number("internal_friction_kg_m3_s", material.internal_friction);
}

}  // namespace

Row ScalingCase::identity() const {
  Row row;
  row.set("structure", structure).set("model", model->id).set("solver", solver);
  row.set("jacobian", jacobian).set("modes", modes).set("elements", elements);
  return row;
}

Parameters ScalingCase::parameters(const Settings& settings) const {
  Parameters p = settings.parameters(*model);
  if (structure == straight) {
    for (const auto& [key, value] : find_strand_scene("release").settings) {
      p.set(key, value);
    }
    p.set("elements", std::to_string(elements));
  } else {
    set_tree(p, structure);
  }
  set_known(p, {{"solver", solver}, {"jacobian", jacobian}});
  if (!modes.empty()) p.set("modes", modes);
  return p;
}

bool ScalingCase::in_seed_table() const {
  return modes == "bend_twist" && seed_frames(*this) != nullptr;
}

std::optional<double> ScalingCase::published_fps() const {
  const SeedFrames* row = seed_frames(*this);
  if (row == nullptr || !model->id.starts_with("super_helix") || jacobian != "elastic" ||
      modes != "bend_twist") {
    return {};
  }
  const double fps = solver == "composite"   ? row->composite
                     : solver == "recursive" ? row->recursive
                                             : 0;
  return fps > 0 ? std::optional(fps) : std::nullopt;
}

std::span<const Parameter> scaling_settings() { return settings_of_rows; }

std::vector<ScalingCase> scaling_cases(const CommandLine& line,
                                       const Settings& settings) {
  const Parameters& rows = settings.experiment();
  const auto keeps = [&rows](std::string_view key, std::string_view word) {
    return rows.word(key) == "all" || rows.word(key) == word;
  };
  const auto wanted_method = [&](const Variation& m) {
    return keeps("solver", m.solver) && keeps("jacobian", m.jacobian) &&
           (m.modes.empty() || keeps("modes", m.modes)) && wanted(line.models, m.model);
  };
  std::vector<Variation> methods = methods_of_strands();
  const std::vector<Variation> others = methods_of_others();
  methods.insert(methods.end(), others.begin(), others.end());
  std::vector<ScalingCase> all;
  // Size by size: compared rows are measured within the same minute.
  for (const int elements : element_counts(line)) {
    for (const Variation& m : methods) {
      if (!keeps("structure", straight) || !wanted_method(m)) continue;
      const bool too_large = m.solver == "composite" && elements > largest_dense;
      if (too_large && !line.full && line.elements.empty()) continue;
      all.push_back(
          {straight, &find_model(m.model), m.solver, m.jacobian, m.modes, elements});
    }
  }
  for (const std::string_view tree : words_of(tree_choices)) {
    if (!keeps("structure", tree)) continue;
    const auto elements = static_cast<int>(tree_segments(tree).size());
    if (!line.elements.empty() && !std::ranges::count(line.elements, elements)) continue;
    for (const Variation& m : methods_of_trees) {
      if (!wanted_method(m)) continue;
      all.push_back(
          {tree, &find_model(m.model), m.solver, m.jacobian, m.modes, elements});
    }
  }
  return all;
}

}  // namespace tress::experiments::scaling
