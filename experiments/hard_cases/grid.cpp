#include <algorithm>
#include <map>
#include <string>

#include "contract/input_error.h"
#include "experiments/hard_cases/hard_cases.h"
#include "experiments/problems/strand_models.h"
#include "integrators/catalogue.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr Parameter settings_of_rows[] = {
    {.name = "case",
     .help = "rows of one case; all: of every one",
     .text = true,
     .fallback = "all"},
    {.name = "dt_s", .help = "rows of one step (s), 0: all", .number = 0, .min = 0},
    {.name = "position_tol_rel",
     .help = "rows of one tolerance (error over the length), 0: all",
     .number = 0,
     .min = 0,
     .max = 1},
    {.name = "scenes", .help = "scene files instead of our cases", .text = true},
    {.name = "horizon_s",
     .help = "simulated time of a scene file, at most the scene's (s). 0: the scene's",
     .number = 0,
     .min = 0,
     .max = 1e3},
    {.name = "strands",
     .help = "number of typical strands of a scene file whose strands do not touch",
     .number = 8,
     .min = 1,
     .max = 1e4,
     .whole = true},
    {.name = "row_work",
     .help = "work of a row of a scene file (max_work), 0: 2e7, with --quick 4e6, with "
             "--full 1e8",
     .number = 0,
     .min = 0},
    {.name = "most_stretch",
     .help =
         "largest accepted change of an element's length over that length, scene files",
     .number = 0.5,
     .min = 0,
     .max = 0.5},
    {.name = "most_depth_m",
     .help =
         "largest accepted depth in a body beyond the initial one, scene files (m); 0: "
         "the radius and 0.07 of the last element. In a soft regularised body, the depth "
         "that a fall by the length of the strand reaches, if that is more",
     .number = 0,
     .min = 0},
    {.name = "most_energy_gain_j",
     .help =
         "largest accepted gain of energy since the start, scene files (J); 0: what the "
         "guard allows",
     .number = 0,
     .min = 0},
};

constexpr double film = 1.0 / 30, substep = 1.0 / 300, fine = 1e-3;  // s
constexpr double usual_tolerance = 1e-3;

constexpr std::string_view usual[] = {"linearly_implicit_euler",
                                      "backward_euler",
                                      "implicit_midpoint",
                                      "bdf2",
                                      "tr_bdf2",
                                      "guarded",
                                      "esdirk43",
                                      "generalized_alpha",
                                      "xpbd",
                                      "rattle",
                                      "rk4"};
constexpr std::size_t usual_quick = 6;  // the first of them

/// Integrators with error control that are tried at fixed steps, and at tolerances where
/// they are chosen: their steps are compared with those of methods without.
constexpr std::string_view usually_by_step[] = {"bdf2", "generalized_alpha"};

/// Whether the integrator is tried at fixed steps.
bool by_step(const CommandLine& line, const IntegratorEntry& entry) {
  return line.full || !entry.error_controlled ||
         std::ranges::count(usually_by_step, entry.id) > 0;
}

/// Whether the integrator is tried at tolerances.
bool by_tolerance(const CommandLine& line, const IntegratorEntry& entry) {
  return entry.error_controlled && (line.full || !line.integrators.empty() ||
                                    std::ranges::count(usually_by_step, entry.id) == 0);
}

std::vector<Pace> paces_of(const CommandLine& line, const Parameters& own,
                           const HardCase& hard, std::string_view integrator) {
  std::vector<Pace> all = tried_paces(line, integrator);
  if (!line.quick && hard.further_step > 0 &&
      by_step(line, find_integrator(integrator))) {
    all.push_back({hard.further_step});
  }
  std::erase_if(all, [&](const Pace& pace) { return !selected(own, pace); });
  return all;
}

std::string words(const ModelSettings& settings) {
  std::string all;
  for (const auto& [key, value] : settings) {
    all += (all.empty() ? "" : " ") + key + "=" + value;
  }
  return all;
}

std::vector<Subject> subjects_of(const CommandLine& line, const HardCase& hard) {
  std::vector<Subject> all;
  for (const ModelVariant& variant : length_variants()) {
    if (line.quick && !variant.settings.empty()) continue;
    if (!wanted(line.models, variant.model->id)) continue;
    all.push_back({variant.model, variant.settings, variant.words});
  }
  for (const auto& [model, settings] : hard.particles) {
    if (!wanted(line.models, model)) continue;
    all.push_back({&find_model(model), settings, words(settings)});
  }
  return all;
}

}  // namespace

std::span<const Parameter> hard_case_settings() { return settings_of_rows; }

std::vector<std::string_view> tried_integrators(const CommandLine& line) {
  std::vector<std::string_view> all;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.adaptive) continue;  // has no step
    const auto place = std::ranges::find(usual, entry.id) - std::begin(usual);
    const bool is_usual =
        place < static_cast<std::ptrdiff_t>(line.quick ? usual_quick : std::size(usual));
    const bool chosen = !line.integrators.empty();
    if (chosen ? wanted(line.integrators, entry.id) : line.full || is_usual) {
      all.push_back(entry.id);
    }
  }
  return all;
}

std::vector<Pace> tried_paces(const CommandLine& line, std::string_view integrator) {
  const IntegratorEntry& entry = find_integrator(integrator);
  std::vector<Pace> all;
  if (by_step(line, entry)) {
    // That of order 2 damps long steps as that of order 1 does: its step is the short
    // one.
    const bool short_only = line.quick && integrator == "bdf2";
    if (!short_only) all = {{film}, {substep}};
    if (short_only || !line.quick) all.push_back({fine});
  }
  if (!by_tolerance(line, entry)) return all;
  for (const double tolerance : {1e-2, usual_tolerance, 1e-4}) {
    if (line.quick && tolerance != usual_tolerance) continue;
    all.push_back({longest_step, tolerance});
  }
  return all;
}

bool selected(const Parameters& own, const Pace& pace) {
  const double step = own.number("dt_s"), tolerance = own.number("position_tol_rel");
  return (step == 0 || step == pace.step) &&
         (tolerance == 0 || tolerance == pace.tolerance);
}

std::vector<std::string_view> tried_jacobians(const CommandLine& line,
                                              const ModelEntry& model,
                                              std::string_view integrator) {
  const std::string_view whole = first_word(model, "jacobian");
  const std::string_view seed = usual_tangent(model);
  if (whole == seed) return {whole};
  if (line.full) return {whole, seed};
  if (integrator != "linearly_implicit_euler") return {whole};
  if (line.quick) return {seed};
  return {seed, whole};
}

Row Cell::identity() const {
  Row row;
  row.set("case", attempt.hard->name).set("model", attempt.subject.model->id);
  row.set("variant", attempt.subject.words).set("integrator", attempt.integrator);
  attempt.pace.identify(row);
  return row;
}

Grid hard_grid(const CommandLine& line, const Settings& settings) {
  const Parameters& selection = settings.experiment();
  const std::string_view only = selection.word("case");
  constexpr double quick_part = 0.005;  // of a million steps
  Grid grid;
  std::vector<std::string_view> names;
  for (const HardCase& hard : hard_case_catalogue()) {
    names.push_back(hard.name);
    if (only != "all" && only != hard.name) continue;
    for (const Subject& subject : subjects_of(line, hard)) {
      const std::size_t reference = grid.references++;
      for (const std::string_view integrator : tried_integrators(line)) {
        for (const std::string_view jacobian :
             tried_jacobians(line, *subject.model, integrator)) {
          Subject own = subject;
          if (!jacobian.empty()) {
            own.settings.emplace_back("jacobian", jacobian);
            own.words +=
                (own.words.empty() ? "jacobian=" : " jacobian=") + std::string(jacobian);
          }
          for (const Pace& pace : paces_of(line, selection, hard, integrator)) {
            Attempt attempt{&hard,      own,  settings.parameters(*own.model),
                            integrator, pace, settings.options()};
            if (line.quick) attempt.shorter = quick_part;
            grid.cells.push_back({std::move(attempt), subject, reference});
          }
        }
      }
    }
  }
  if (only != "all" && std::ranges::find(names, only) == names.end()) {
    throw InputError("unknown case '" + std::string(only) + "'", "--set case",
                     suggestion(only, names, "use one of experiments/hard_cases"));
  }
  return grid;
}

}  // namespace tress::experiments::hard_cases
