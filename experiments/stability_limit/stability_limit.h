#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/numerics/stability.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/command_line.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/run/verdicts.h"
#include "integrators/catalogue.h"
#include "simulation/files/row.h"

namespace tress::experiments::stability_limit {

/// Internal friction gamma (kg m^3/s) by name.
struct Damping {
  std::string_view name;
  std::string_view internal_friction;
};

inline constexpr Damping undamped{"none", "0"};

/// Number of elements where methods are compared.
inline constexpr int usual_elements = 20;

/// One row of stability_limit: the strand, its motion and the method.
struct StabilityCase {
  const StrandScene* scene;
  const ModelEntry* model;
  std::string_view integrator, solver, jacobian, modes;
  int elements;
  Damping damping;

  Row identity() const;
  /// Whether the command line and the settings select this row.
  bool selected(const CommandLine& line, const Parameters& rows) const;
  /// The model's: defaults, then the user's, the scene's, and this row's.
  Parameters parameters(const Settings& settings) const;
};

/// --set keys that select rows and control the search for steps.
std::span<const Parameter> stability_settings();

/// The user's value of this key; `usual` if it is 0.
double set_or(const Parameters& rows, std::string_view key, double usual);

/// Search parameters for steps; `finest` (s) and `depth` are defaults that the user may
/// override. Throws InputError if no step lies between `floor_s` and `cap_s`.
StepSearch step_search(const Parameters& rows, double finest, double depth);

/// The search without steps longer than this (s); of a shorter one than all of them, that
/// step alone.
StepSearch up_to(double coarsest, StepSearch search);

/// Whether a study of all integrators includes this one: it has a step, and is named, or
/// is one that --quick keeps.
bool considered(const CommandLine& line, const IntegratorEntry& entry);

/// Whether the study `tolerance` includes the method: --quick keeps tr_bdf2.
bool by_tolerance(const CommandLine& line, const IntegratorEntry& entry);

/// Whether the model has this solver and Jacobian, and the integrator takes it.
bool possible(const StabilityCase& c, const Settings& settings);

/// The rows that the command line and its settings select, without those whose model the
/// integrator refuses.
std::vector<StabilityCase> stability_cases(const CommandLine& line,
                                           const Settings& settings);

/// The largest stable step (s), and the run at it.
struct FoundLimit {
  double step;
  StabilityRun run;
};

/// Judges a step (s); empty: the work is used up.
using JudgeStep = std::function<std::optional<StabilityRun>(double dt)>;

/// The runs of a search by their steps (s).
struct SearchedSteps {
  std::map<double, StabilityRun> runs;
  bool complete;  // StepLimit
};

/// Searches for the largest step that `judge` finds stable.
SearchedSteps search_steps(const StepSearch& search, const JudgeStep& judge);
StepLimit step_limit(const SearchedSteps& searched, const StepSearch& search);

/// Fills the columns about the limit that these runs show. The row fails, and nothing is
/// returned, if no stable step exists or none was found within the work limit.
std::optional<FoundLimit> found_limit(const SearchedSteps& searched,
                                      const StepSearch& search, Row& row);

/// search_steps() and found_limit().
std::optional<FoundLimit> find_limit(const StepSearch& search, const JudgeStep& judge,
                                     Row& row);

/// Sets the columns about the run at the limit and the cost (s of wall time) of one of
/// its steps.
void set_cost(const FoundLimit& limit, double cost, Row& row);

/// Search parameters for the limits of scenes.
struct SceneLimits {
  StepSearch search;
  double most_work;  // per row, total_work()
  double horizon;    // s simulated per run, at most the scene's duration
  std::size_t strands;
  int repeat;
};

/// Returns rows for scene files. A row has the largest step of a method with which the
/// scene satisfies the simulation guard (Guard) and no step has to be repeated with
/// shorter ones. Of many strands that do not touch each other, typical ones are run.
/// Throws InputError on --models and --elements, which a scene defines itself.
std::vector<Case> scene_cases(const CommandLine& line,
                              const std::vector<std::string>& files,
                              const SceneLimits& how);

/// Tolerances from 1e-1 to 1e-5, from loose to tight until the work is used up. Results
/// are the loosest one such that it and all tighter ones tried were stable, the tightest
/// that was run, and the cost at 1e-3.
struct ToleranceRun {
  StabilityRun run;
  double work;  // total_work()
};
/// Fills the columns about them. `judge`: empty when the work is used up. The row fails
/// if the tightest one tried was unstable, or none was run.
void find_tolerances(
    const std::function<std::optional<ToleranceRun>(double tolerance)>& judge, Row& row);

/// The study `tolerance`, of our hair: error-controlled methods have no largest step, but
/// a loosest tolerance. super_helix on every scene, other models on two, undamped; with
/// --full on every scene. Steps are no longer than the longest that fixed ones are tried
/// at. Empty if the command line selects other rows.
std::vector<Case> tolerance_cases(const CommandLine& line, const Settings& settings,
                                  double most_work);

/// Returns the cases of the study `tolerance` for scene files; arguments as for
/// scene_cases().
std::vector<Case> scene_tolerance_cases(const CommandLine& line,
                                        const std::vector<std::string>& files,
                                        const SceneLimits& how);

/// Returns the study `nodal`. Is a nodal scheme of Kirchhoff's equations with the
/// stiffness of curvature removed unstable for a hair of 200 nodes at steps of 1e-5 s
/// [Bertails 2006]? Which steps does it need? Empty if the command line selects other
/// rows.
std::vector<Case> nodal_cases(const CommandLine& line, const Settings& settings);

/// Checks that claim, method by method; that in a plane the limit falls as 1/N^2; and
/// that the limits of explicit methods are those of the grid's highest frequency.
void check_nodal_claims(const std::vector<Row>& rows, Verdicts& verdicts);

/// Returns the answer about scene files, a line for each method, the largest step first.
/// A line has the largest stable step, the steps up to it that were tried, and the
/// failure beyond it. It ends with the time over which the step was judged, and the time
/// of a simulated second.
std::vector<std::string> stability_answer(const std::vector<Row>& rows);

/// Checks the claims about the table of stability_limit. Two limits are equal when the
/// brackets of their bisections, from dt_max_s to dt_first_unstable_s, have a step in
/// common. The deciding number is the ratio of the two dt_max_s of the worst pair.
void check_stability_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::stability_limit
