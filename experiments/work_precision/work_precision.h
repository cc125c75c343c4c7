#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/integrator.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/run/command_line.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "experiments/run/verdicts.h"
#include "models/catalogue.h"
#include "simulation/files/row.h"

namespace tress::experiments::work_precision {

/// --set keys that select rows.
std::span<const Parameter> row_settings();

/// Whether the user's choice for this key includes this value.
bool keeps(const Settings& settings, std::string_view key, std::string_view word);

/// Sets the counters of a run.
void set_counts(const Stats& stats, Row& row);
/// Sets the largest error of a point over the body, over the requested tolerance, where
/// steps are adaptive. Options::tolerance is of the time error of a point over the
/// length, so the reference has the same elements. Of a strand the tip stands for all
/// points. In twelve runs (tr_bdf2 at 1e-3, three models, four scenes of scenes/accuracy)
/// the tip's largest error was that of all points, or 0.6 % below it.
void set_achieved(double largest, const Options& options, Row& row);
/// Sets the distance from the reference, whose two sides are `gap` apart.
void set_error(double relative, double gap, Row& row);
/// Sets the wall times (s).
void set_time(double wall, double simulated, Row& row);

/// Options::tolerance from loose to tight, for methods that control their error.
std::span<const double> tolerances(const CommandLine& line);

/// Sets the column that drives a row's steps: tolerance, rtol or dt_s.
void set_drive(const Options& options, bool adaptive, Row& row);

/// A strand whose tip is followed: its name in the column `scene`, the strand scene it
/// runs, and the sampling of the tip comparison.
struct FollowedStrand {
  std::string_view name, scene;
  TipSampling sampling;
};

/// The strand on which other simulators were measured, sampled every 20 ms as theirs.
inline constexpr FollowedStrand swing{"swing", "swing", {2, 100, 0.2}};
/// A hair released horizontally, for the first quarter of a second of its fall.
inline constexpr FollowedStrand strand_release{
    "strand_release", "release", {0.25, 5, 0.1}};

/// Elements at which other simulators were measured, with their time error.
constexpr int simulator_elements = 20;

/// One row about a strand: the method, and the kind of error.
struct StrandCase {
  const FollowedStrand* strand;
  std::string_view error_kind;  // time or total
  const ModelEntry* model;
  std::string_view modes, solver;  // empty: the model has no such option
  std::string_view jacobian;       // empty: not used by the integrator
  std::string_view integrator;
  bool adaptive, newton;  // whether it is driven by rtol, and iterates with `options`
  Options options;
  int elements;
  double grading;

  Row identity() const;
  Parameters parameters(const Settings& settings) const;
};

/// Parameters of a row's strand, or of a reference's: defaults, then the user's and the
/// scene's, bending only, since nothing twists these strands and explicit methods take
/// part.
Parameters strand_parameters_of(const FollowedStrand& strand, const Settings& settings,
                                const ModelEntry& model, int elements);

/// Returns the rows that the command line and its settings select, without those whose
/// model the integrator refuses. They are the swing and the released hair by every
/// integrator, and every strand model on the released hair against the continuous rod.
std::vector<StrandCase> strand_cases(const CommandLine& line, const Settings& settings);

/// The rows of strand_cases(): error of the tip, root mean square over the run, against
/// wall time. References are computed here, once for all rows that share one.
std::vector<Case> strand_runs(const CommandLine& line, const Settings& settings);

/// The rows for problems with a known end state (problems()): every integrator from loose
/// to tight tolerances. The Beam by cvode_bdf has every maximum order, including the
/// default.
std::vector<Case> problem_runs(const CommandLine& line, const Settings& settings);

/// Returns rows for scene files: the tips' error against wall time, root mean square over
/// the run and over the length, by every selected strand model and integrator. A fixed
/// step starts at one frame and is halved until several steps succeeded or the next one
/// would exceed the work limit of a run. Of the coarser ones that failed only the finest
/// is kept.
///
/// time: against the same model at a much finer step; total: against the continuous rod,
/// where strands do not touch each other. References are computed here. Throws InputError
/// on scenes without strands and on two of one name.
std::vector<Case> scene_runs(const CommandLine& line, const Settings& settings,
                             const std::vector<std::string>& files);

/// Fills `pareto` of every ok row: true if no other ok row of its group has both less
/// wall_s and less of the column `error`.
void add_pareto(std::vector<Row>& rows, std::string_view error,
                const std::function<std::string(const Row&)>& group);

/// Fills the columns that depend on the whole table. `order_fit` of every fixed-step
/// series is the least-squares slope over its finest trusted points (same scene,
/// integrator, formulation and solver, over steps). For total errors it is over element
/// lengths, with the same model at its finest step; none for the swing. `pareto` of every
/// row: no run of its scene and kind of error, for time errors also of its number of
/// elements, is both faster and more accurate.
void add_series_columns(std::vector<Row>& rows);

/// Checks the claims about the table. They concern the digits reached on published
/// problems, the order of total errors in element length, and the cost of a high BDF
/// order on a rod. Others are those about the swing.
void check_claims(const std::vector<Row>& rows, Verdicts& verdicts);

/// The claims that a time error is proportional to the tolerance.
void check_tolerances(const std::vector<Row>& rows, Verdicts& verdicts);

/// Checks the claims about the rows of the swing. Runs with a time error of 1 % and of
/// 0.1 % at the other simulators' number of elements and with a total error of 1 %, whose
/// times are figures. Twist does not matter. The references agree.
void check_swing_claims(const std::vector<Row>& all, Verdicts& verdicts);

}  // namespace tress::experiments::work_precision
