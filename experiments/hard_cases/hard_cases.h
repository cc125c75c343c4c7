#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/hard_cases/scene_gauge.h"
#include "experiments/hard_cases/survival.h"
#include "experiments/run/command_line.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::hard_cases {

/// One row: an attempt, and the reference it is compared with.
struct Cell {
  Attempt attempt;
  Subject compared;       // owner of the reference: the subject with its exact Jacobian
  std::size_t reference;  // index among the references of all cells

  Row identity() const;
};

struct Grid {
  std::vector<Cell> cells;
  std::size_t references = 0;
};

/// --set keys that select rows.
std::span<const Parameter> hard_case_settings();

// The values that the command line selects from those of hard_grid().
std::vector<std::string_view> tried_integrators(const CommandLine& line);
std::vector<Pace> tried_paces(const CommandLine& line, std::string_view integrator);
/// The longest step with a tolerance, s.
inline constexpr double longest_step = 1.0 / 30;
/// Whether --set dt_s and tolerance leave these rows.
bool selected(const Parameters& own, const Pace& pace);
/// Returns the Jacobians tried for this model and integrator; one empty string: the
/// model has no such option.
std::vector<std::string_view> tried_jacobians(const CommandLine& line,
                                              const ModelEntry& model,
                                              std::string_view integrator);

/// Returns every case on every strand model, and on the particle systems that it names,
/// with every integrator and every step that the command line selects. Impossible
/// combinations are cells too.
///
/// With --quick, models have their default options. The integrators are
/// linearly_implicit_euler, backward_euler and implicit_midpoint at 1/300 and 1/30 s,
/// bdf2 at 1 ms and tr_bdf2 at a tolerance of 1e-3. A normal run has more integrators,
/// models with every way of keeping lengths, all three steps, and tolerances of 1e-2 and
/// 1e-4 too. With --full, every integrator runs with fixed steps, those with error
/// control included, and with both Jacobians. The integrator linearly_implicit_euler has
/// the elastic Jacobian where available.
Grid hard_grid(const CommandLine& line, const Settings& settings);

/// With the violated criterion, or the one nearest to its limit; it has a name and a
/// limit if it is one of SceneCriteria.
struct SceneSurvival : Survival {
  std::string_view measured;
  double limit = std::numeric_limits<double>::quiet_NaN();
  std::string_view criterion;
};

/// A scene as a hard case: runs it at this pace until t_end (s), or until a criterion
/// is violated. Stable if every step has a solution, the guard finds nothing and the
/// criteria are met; there is no reference for accuracy. With a tolerance the criteria
/// are evaluated after every longest step, the guard still after each. `limit`:
/// World::work().
SceneSurvival survive(const Scene& scene, const Pace& pace, const SceneCriteria& criteria,
                      double t_end, const WorkLimit& limit);

/// Returns rows for scene files: every strand model and integrator that the command line
/// selects, at the scene's step or tolerance and at the standard ones. A scene without
/// strands runs with its own model. The scene's model keeps the scene's options, others
/// have their defaults, with the Jacobians of hard_grid(). Of many strands that do not
/// touch each other, typical ones are run. Throws InputError on settings that a scene
/// defines itself.
std::vector<Case> scene_cells(const CommandLine& line, const Settings& settings);

/// Checks the claims about the table of hard_cases. Every cell has an outcome.
/// super_helix with backward_euler and the exact Jacobian passes every case at 1/30 s
/// that it does not refuse, except for known limits. Adaptive runs that pass are
/// accurate, and tr_bdf2 is accurate at 1e-3 in the two cases where backward_euler finds
/// no solution.
void check_hard_cases(const std::vector<Row>& rows, Verdicts& verdicts);

/// Returns the answer about scene files, a line for each model, the most stable first:
/// how many runs stayed stable, and the methods of which every run did.
std::vector<std::string> hard_answer(const std::vector<Row>& rows);

}  // namespace tress::experiments::hard_cases
