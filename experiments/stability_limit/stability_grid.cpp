#include <algorithm>
#include <span>
#include <string>

#include "contract/input_error.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

// EI/gamma is the relaxation rate; gamma damps modes beyond 2 EI/gamma over-critically.
// The published gamma does so from 120 rad/s on, the third bending mode of a hair of 10
// cm; a hundredth of it from 12 000 rad/s on, the highest bending mode of 20 elements: it
// leaves the motion unchanged and only damps artefacts of the grid.
constexpr Damping dampings[] = {undamped, {"light", "1e-12"}, {"published", "1e-10"}};

struct Variation {
  std::string_view model, integrator, solver, jacobian;
};

/// Against the number of elements: the linearly implicit step with the elastic Jacobian
/// on every solver, our reconstruction of the published recursion, the exact Jacobian,
/// and the serial chain.
constexpr Variation methods[] = {
    {"super_helix", "linearly_implicit_euler", "recursive", "elastic"},
    {"super_helix", "linearly_implicit_euler", "composite", "elastic"},
    {"super_helix", "linearly_implicit_euler", "recursive", "elastic_local"},
    {"super_helix", "linearly_implicit_euler", "recursive", "exact"},
    {"super_helix", "backward_euler", "recursive", "exact"},
    {"articulated_chain", "linearly_implicit_euler", "recursive", "elastic"},
};

/// Every other strand model with its first solver, by the usual step and by full Newton
/// steps.
std::vector<Variation> methods_of(const ModelEntry& model) {
  const std::string_view solver = first_word(model, "solver");
  return {{model.id, "linearly_implicit_euler", solver, usual_tangent(model)},
          {model.id, "backward_euler", solver, first_word(model, "jacobian")}};
}

bool of_the_seed(std::string_view model) {
  return std::ranges::find(methods, model, &Variation::model) != std::end(methods);
}

/// Only where methods are compared with each other.
constexpr Variation further_methods[] = {
    {"super_helix", "linearly_implicit_euler", "sparse", "elastic"},
    {"super_helix", "linearly_implicit_euler", "composite", "exact"},
    {"super_helix", "linearly_implicit_euler", "sparse", "exact"},
    {"articulated_chain", "linearly_implicit_euler", "composite", "elastic"},
    {"articulated_chain", "linearly_implicit_euler", "recursive", "exact"},
    {"articulated_chain", "backward_euler", "recursive", "exact"},
};

/// For --quick, one method of each kind that a user is likely to consider: explicit, of
/// order 1, symplectic, with one solve a step, and two that damp fast modes. The others
/// add nothing about stability.
constexpr std::string_view quick_integrators[] = {"rk4",
                                                  "linearly_implicit_euler",
                                                  "backward_euler",
                                                  "implicit_midpoint",
                                                  "bdf2",
                                                  "generalized_alpha",
                                                  "linearly_implicit_midpoint"};
constexpr std::string_view quick_scenes[] = {"release", "compress", "shake", "curl_drop",
                                             "whip"};
/// For models other than those of of_the_seed(): these scenes and numbers of elements.
constexpr std::string_view quick_scenes_of_others[] = {"release", "shake"};
constexpr int quick_elements_of_others[] = {5, usual_elements, 40};

bool contains(std::span<const std::string_view> words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

std::vector<int> element_counts(const CommandLine& line) {
  if (!line.elements.empty()) return line.elements;
  if (line.full) return {1, 2, 3, 5, 8, 10, 15, 20, 30, 40, 60, 100, 200};
  return {1, 2, 5, 10, usual_elements, 40};
}

/// Every pair of --models and --integrators that `all` has not, if the user gives both.
std::vector<Variation> named_pairs(const CommandLine& line,
                                   std::span<const Variation> all) {
  std::vector<Variation> more;
  if (line.models.empty() || line.integrators.empty()) return more;
  for (const ModelEntry* model : strand_models()) {
    if (!wanted(line.models, model->id)) continue;
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      const bool there = std::ranges::any_of(all, [&](const Variation& one) {
        return one.model == model->id && one.integrator == entry.id;
      });
      if (there || !considered(line, entry)) continue;
      more.push_back({model->id, entry.id, first_word(*model, "solver"),
                      first_word(*model, "jacobian")});
    }
  }
  return more;
}

/// `others`: also every other fixed-step integrator, by the linear-time solver with the
/// exact Jacobian, and named_pairs().
std::vector<Variation> all_methods(const CommandLine& line, bool others) {
  std::vector<Variation> all(std::begin(methods), std::end(methods));
  for (const ModelEntry* model : strand_models()) {
    if (of_the_seed(model->id)) continue;
    const std::vector<Variation> own = methods_of(*model);
    all.insert(all.end(), own.begin(), own.end());
  }
  if (!others) return all;
  all.insert(all.end(), std::begin(further_methods), std::end(further_methods));
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (std::ranges::count(methods, entry.id, &Variation::integrator) > 0) continue;
    if (!considered(line, entry)) continue;
    all.push_back({"super_helix", entry.id, "recursive", "exact"});
    if (line.full) all.push_back({"articulated_chain", entry.id, "recursive", "exact"});
  }
  const std::vector<Variation> named = named_pairs(line, all);
  all.insert(all.end(), named.begin(), named.end());
  return all;
}

/// Whether a row is included by default. --quick shows the effect of damping on two
/// scenes at two sizes, the default on four scenes at all sizes.
bool usual(const CommandLine& line, const StabilityCase& c) {
  if (line.full) return true;
  constexpr std::string_view damped[] = {"shake", "curl_drop", "release", "whip"};
  const std::string_view scene = c.scene->name;
  const bool undamped_row = c.damping.name == undamped.name;
  if (!line.quick) return undamped_row || contains(damped, scene);
  if (!of_the_seed(c.model->id)) {
    return undamped_row && contains(quick_scenes_of_others, scene) &&
           std::ranges::find(quick_elements_of_others, c.elements) !=
               std::end(quick_elements_of_others);
  }
  if (undamped_row) return contains(quick_scenes, scene);
  return contains(std::span(damped).first(2), scene) &&
         (c.elements == 5 || c.elements == usual_elements);
}

}  // namespace

bool possible(const StabilityCase& c, const Settings& settings) {
  for (const auto& [key, word] :
       {std::pair{"solver", c.solver}, {"jacobian", c.jacobian}}) {
    if (!word.empty() && !has_word(*c.model, key, word)) return false;
  }
  try {
    const auto system = c.model->make(c.parameters(settings));
    return !usable_formulations(find_integrator(c.integrator), *system).empty();
  } catch (const InputError&) {
    return false;  // a scene that the model does not support
  }
}

Row StabilityCase::identity() const {
  Row row;
  row.set("study", "grid").set("scene", scene->name);
  row.set("model", model->id).set("integrator", integrator);
  row.set("solver", solver).set("jacobian", jacobian).set("modes", modes);
  row.set("elements", elements).set("damping", damping.name);
  return row;
}

bool StabilityCase::selected(const CommandLine& line, const Parameters& rows) const {
  for (const auto& [key, word] : {std::pair{"scene", scene->name},
                                  {"damping", damping.name},
                                  {"solver", solver},
                                  {"jacobian", jacobian}}) {
    if (rows.word(key) != "all" && rows.word(key) != word) return false;
  }
  return wanted(line.models, model->id) && wanted(line.integrators, integrator);
}

Parameters StabilityCase::parameters(const Settings& settings) const {
  Parameters p = settings.parameters(*model);
  for (const auto& [key, value] : scene->settings) p.set(key, value);
  p.set("elements", std::to_string(elements));
  p.set("internal_friction_kg_m3_s", damping.internal_friction);
  set_known(p, {{"solver", solver}, {"jacobian", jacobian}, {"modes", modes}});
  return p;
}

bool considered(const CommandLine& line, const IntegratorEntry& entry) {
  if (entry.adaptive) return false;
  if (!line.integrators.empty()) return wanted(line.integrators, entry.id);
  return !line.quick || contains(quick_integrators, entry.id);
}

std::vector<StabilityCase> stability_cases(const CommandLine& line,
                                           const Settings& settings) {
  const Parameters& rows = settings.experiment();
  std::vector<StabilityCase> all;
  if (rows.word("study") != "all" && rows.word("study") != "grid") return all;
  const bool chosen = rows.word("scene") != "all" || rows.word("damping") != "all" ||
                      !line.elements.empty();
  for (const StrandScene& scene : strand_scenes()) {
    for (const Damping& damping : dampings) {
      for (const int elements : element_counts(line)) {
        const bool others = !line.integrators.empty() || rows.word("solver") != "all" ||
                            (elements == usual_elements && damping.name == "none");
        for (const Variation& m : all_methods(line, others)) {
          const StabilityCase c{&scene,     &find_model(m.model), m.integrator, m.solver,
                                m.jacobian, rows.word("modes"),   elements,     damping};
          if (!c.selected(line, rows) || !(chosen || usual(line, c))) continue;
          if (possible(c, settings)) all.push_back(c);
        }
      }
    }
  }
  return all;
}

}  // namespace tress::experiments::stability_limit
