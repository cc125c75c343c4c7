#include <algorithm>
#include <span>
#include <string>

#include "contract/input_error.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/stability_limit/stability_limit.h"

namespace tress::experiments::stability_limit {
namespace {

constexpr Parameter settings_of_rows[] = {
    {.name = "study", .help = "rows of one study", .choices = "all|grid|tolerance|nodal"},
    {.name = "scene",
     .help = "rows of one scene",
     .choices = "all|release|compress|shake|shake_rotate|curl_drop|whip|swing"},
    {.name = "damping",
     .help = "rows of one level of internal friction: 0, 1e-12 or 1e-10 kg m^3/s",
     .choices = "all|none|light|seed"},
    {.name = "solver",
     .help = "rows of one solver of the model",
     .choices = "all|recursive|composite|sparse|recursive_plain"},
    {.name = "tangent",
     .help = "rows of one tangent of the model",
     .choices = "all|stiff|exact|less_implicit"},
    {.name = "modes",
     .help = "which modes the strands have",
     .choices = "bend_twist|bend|bend_planar"},
    {.name = "cap_s", .help = "largest step tried (s)", .number = 0.1, .min = 1e-9},
    {.name = "floor_s",
     .help = "smallest step tried (s), 0: 1e-6, of study nodal 1e-7",
     .number = 0,
     .min = 0},
    {.name = "depth",
     .help = "test below a stable step until this factor is stable, 0: 30, with --quick "
             "10, of study nodal 1",
     .number = 0,
     .min = 0},
    {.name = "resolution",
     .help = "bisect until unstable over stable step is this",
     .number = 1.05,
     .min = 1.0001},
    {.name = "scenes", .help = "scene files instead of our scenes", .text = true},
    {.name = "horizon_s",
     .help =
         "time that a run simulates (s), of a scene file (at most the scene's) and of "
         "study nodal; 0: 0.5, of study nodal 1, with --quick 0.25, explicit methods "
         "0.02",
     .number = 0,
     .min = 0,
     .max = 1e3},
    {.name = "strands",
     .help = "of a scene file whose strands do not touch: so many typical ones",
     .number = 8,
     .min = 1,
     .max = 1e4,
     .whole = true},
    {.name = "row_work",
     .help = "work of the search for one row (max_work), 0: 2e7, with --quick 3e6, "
             "with --full 1e8; of study tolerance 1e8, with --quick 3e7, with --full "
             "3e8; of study nodal 1e9, with --quick 1.5e8",
     .number = 0,
     .min = 0},
};

// EI/gamma is the relaxation rate; gamma damps modes beyond 2 EI/gamma over-critically.
// The "seed" gamma does so from 120 rad/s on, the third bending mode of a hair of 10 cm;
// a hundredth of it from 12 000 rad/s on, the highest bending mode of 20 elements: it
// leaves the motion unchanged and only damps artefacts of the grid.
constexpr Damping dampings[] = {undamped, {"light", "1e-12"}, {"seed", "1e-10"}};

struct Variation {
  std::string_view model, integrator, solver, tangent;
};

/// Against the number of elements: the semi-implicit step with the stiff tangent on every
/// solver, our reconstruction of the published recursion, the exact tangent, and the
/// serial chain.
constexpr Variation methods[] = {
    {"super_helix", "semi_implicit_euler", "recursive", "stiff"},
    {"super_helix", "semi_implicit_euler", "composite", "stiff"},
    {"super_helix", "semi_implicit_euler", "recursive", "less_implicit"},
    {"super_helix", "semi_implicit_euler", "recursive", "exact"},
    {"super_helix", "backward_euler", "recursive", "exact"},
    {"articulated_chain", "semi_implicit_euler", "recursive", "stiff"},
};

/// Every other strand model with its first solver, by the usual step and by full Newton
/// steps.
std::vector<Variation> methods_of(const ModelEntry& model) {
  const std::string_view solver = first_word(model, "solver");
  return {{model.id, "semi_implicit_euler", solver, usual_tangent(model)},
          {model.id, "backward_euler", solver, first_word(model, "tangent")}};
}

bool of_the_seed(std::string_view model) {
  return std::ranges::find(methods, model, &Variation::model) != std::end(methods);
}

/// Only where methods are compared with each other.
constexpr Variation further_methods[] = {
    {"super_helix", "semi_implicit_euler", "sparse", "stiff"},
    {"super_helix", "semi_implicit_euler", "composite", "exact"},
    {"super_helix", "semi_implicit_euler", "sparse", "exact"},
    {"articulated_chain", "semi_implicit_euler", "composite", "stiff"},
    {"articulated_chain", "semi_implicit_euler", "recursive", "exact"},
    {"articulated_chain", "backward_euler", "recursive", "exact"},
};

/// For --quick, one method of each kind that a user is likely to consider: explicit, of
/// order 1, symplectic, with one solve a step, and two that damp fast modes. The others
/// add nothing about stability.
constexpr std::string_view quick_integrators[] = {"rk4",
                                                  "semi_implicit_euler",
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

/// `others`: also every other fixed-step integrator, by the linear-time solver with the
/// exact tangent.
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
       {std::pair{"solver", c.solver}, {"tangent", c.tangent}}) {
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
  row.set("solver", solver).set("tangent", tangent).set("modes", modes);
  row.set("elements", elements).set("damping", damping.name);
  return row;
}

bool StabilityCase::selected(const CommandLine& line, const Parameters& rows) const {
  for (const auto& [key, word] : {std::pair{"scene", scene->name},
                                  {"damping", damping.name},
                                  {"solver", solver},
                                  {"tangent", tangent}}) {
    if (rows.word(key) != "all" && rows.word(key) != word) return false;
  }
  return wanted(line.models, model->id) && wanted(line.integrators, integrator);
}

Parameters StabilityCase::parameters(const Settings& settings) const {
  Parameters p = settings.parameters(*model);
  for (const auto& [key, value] : scene->settings) p.set(key, value);
  p.set("elements", std::to_string(elements));
  p.set("internal_friction_kg_m3_s", damping.internal_friction);
  set_known(p, {{"solver", solver}, {"tangent", tangent}, {"modes", modes}});
  return p;
}

std::span<const Parameter> stability_settings() { return settings_of_rows; }

double set_or(const Parameters& rows, std::string_view key, double usual) {
  return rows.number(key) > 0 ? rows.number(key) : usual;
}

StepSearch step_search(const Parameters& rows, double finest, double depth) {
  return {.coarsest = rows.number("cap_s"),
          .finest = set_or(rows, "floor_s", finest),
          .resolution = rows.number("resolution"),
          .depth = std::max(set_or(rows, "depth", depth), 1.0)};
}

bool considered(const CommandLine& line, const IntegratorEntry& entry) {
  if (entry.adaptive) return false;
  if (!line.integrators.empty()) return wanted(line.integrators, entry.id);
  return !line.quick || contains(quick_integrators, entry.id);
}

bool by_tolerance(const CommandLine& line, const IntegratorEntry& entry) {
  if (!entry.error_controlled) return false;
  if (!line.integrators.empty()) return wanted(line.integrators, entry.id);
  return !line.quick || entry.id == "tr_bdf2";
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
          const StabilityCase c{&scene,    &find_model(m.model), m.integrator, m.solver,
                                m.tangent, rows.word("modes"),   elements,     damping};
          if (!c.selected(line, rows) || !(chosen || usual(line, c))) continue;
          if (possible(c, settings)) all.push_back(c);
        }
      }
    }
  }
  return all;
}

}  // namespace tress::experiments::stability_limit
