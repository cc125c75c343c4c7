// What does accuracy cost in time, per integrator? Error against the wall time of a run,
// from loose to tight, on problems with exact, published or doubly computed references;
// the maximum order of BDF on the Beam; the tip of strands, in time error alone and
// against the continuous rod, where other simulators were also measured; and any scene.
#include <fmt/format.h>

#include <iterator>
#include <string>
#include <vector>

#include "experiments/problems/scene_files.h"
#include "experiments/run/advised.h"
#include "experiments/run/experiment.h"
#include "experiments/work_precision/work_precision.h"
#include "simulation/files/parse.h"

namespace tress::experiments::work_precision {
namespace {

constexpr Column columns[] = {
    {"scene", "the problem, the strand, or the scene file"},
    {"model", "catalogue id"},
    {"modes", "unknowns per element of a strand, where the model has a choice"},
    {"jacobian",
     "terms of S (Jacobian approximation), where the model has a choice and the "
     "method uses S"},
    {"integrator", "method"},
    {"formulation", "constraint formulation"},
    {"max_order", "highest order it may use, where that was chosen"},
    {"newton_tolerance", "largest correction over the model's scale, where chosen"},
    {"refresh", "when S is rebuilt, where chosen"},
    {"dt_s", "fixed step"},
    {"rtol", "relative tolerance, adaptive methods"},
    {"position_tol_rel",
     "tolerance of the estimated error of a point in a step, over the length; steps "
     "follow from it"},
    {"elements", "coordinates of the problem; for a strand, its elements"},
    {"grading", "last element's length over the first's, for a strand"},
    {"solver", "linear solver in use; for a strand, the model's own"},
    {"error_kind",
     "time: against the same equations integrated to convergence; total: against the "
     "continuous body"},
    {"error_rel",
     "largest error of the compared positions over their scale. Of a strand: root mean "
     "square over the run of the tip's distance from the reference, over the length"},
    {"scd", "significant correct digits, -log10 of the largest relative error"},
    {"error_over_tolerance",
     "largest time error at the compared instants over the tolerance. Of a strand it is "
     "that of the tip, over its length. Of a problem's body it is that of the points, "
     "over its length, or of its coordinates over their scales where it has none"},
    {"reference_gap", "disagreement of the two references, same norm"},
    {"below_reference", "error below ten times that gap: not to be trusted"},
    {"wall_s", "median wall time of the run, setting up a strand aside", true},
    {"wall_s_per_sim_s", "median wall time per simulated second", true},
    {"steps", "accepted steps"},
    {"rejected", "rejected steps"},
    {"rejected_by_error", "rejected steps with too large an error"},
    {"rejected_by_newton", "rejected steps in which Newton's method found no solution"},
    {"smallest_step_s", "the shortest step that error control chose"},
    {"residuals", "residual or acceleration evaluations"},
    {"linearizations", "matrices built and factored"},
    {"solves", "linear solves"},
    {"order_fit",
     "slope of log error over the finest points: against log step; total errors at the "
     "finest step against log element length"},
    {"pareto",
     "no other run of the scene and kind of error, of time alone at this number of "
     "elements, is both faster and more accurate"},
};

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, row_settings());
  const std::string_view files = settings.experiment().word("scenes");
  if (!files.empty()) return scene_runs(line, settings, listed_files(files, "scenes"));
  std::vector<Case> all = problem_runs(line, settings);
  std::vector<Case> strands = strand_runs(line, settings);
  all.insert(all.end(), std::make_move_iterator(strands.begin()),
             std::make_move_iterator(strands.end()));
  return all;
}

/// "over the first 0.5 s of 2 s"
std::string time_compared(const Scene& scene, double horizon) {
  return horizon < scene.duration
             ? fmt::format("over the first {:.3g} s of {:.3g} s", horizon, scene.duration)
             : fmt::format("over {:.3g} s", scene.duration);
}

/// The cheapest run of each scene file within 1 and 0.1 %.
void answer(const CommandLine& line, const std::vector<Row>& rows) {
  const Settings settings(line, row_settings());
  const Parameters& own = settings.experiment();
  if (own.word("scenes").empty()) return;
  const auto files = read_strand_scenes(listed_files(own.word("scenes"), "scenes"));
  std::vector<std::string> lines;
  for (const SceneFile& file : files) {
    const std::string& scene = file.name;
    const std::string over = time_compared(file.scene, own.number("horizon_s"));
    for (const double target : {1e-2, 1e-3}) {
      const Row* best = nullptr;
      for (const Row& row : rows) {
        if (row.text("scene") != scene || !(row.number("error_rel") <= target)) continue;
        const bool cheaper = best == nullptr || row.number("wall_s_per_sim_s") <
                                                    best->number("wall_s_per_sim_s");
        if (row.ok() && cheaper) best = &row;
      }
      if (best == nullptr) {
        lines.push_back(fmt::format("{}: no run within {:.3g} %", scene, 1e2 * target));
        continue;
      }
      const std::string steps =
          best->has("dt_s")
              ? fmt::format("dt {:.3g} ms", 1e3 * best->number("dt_s"))
              : fmt::format("tolerance {:.2g}", best->number(best->has("position_tol_rel")
                                                                 ? "position_tol_rel"
                                                                 : "rtol"));
      lines.push_back(fmt::format(
          "{}: within {:.3g} % ({}, {}): {}, {}, {}: {:.2g} % in {:.3g} ms "
          "per simulated second",
          scene, 1e2 * target, best->text("error_kind"), over, best->text("model"),
          best->text("integrator"), steps, 1e2 * best->number("error_rel"),
          1e3 * best->number("wall_s_per_sim_s")));
    }
  }
  print_answer(line, lines);
}

/// A step or tolerance too loose for the method is the end of its curve, not an error.
bool finding(const Row&) { return true; }

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene (several: a.toml,b.toml) instead of the built-in ones", true},
};

constexpr Unused unused[] = {not_random};

}  // namespace
}  // namespace tress::experiments::work_precision

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::work_precision;
  const Experiment experiment{
      .name = "work_precision",
      .question = "what does accuracy cost in time, per integrator?",
      .example = "--integrators implicit_midpoint --set scene=swing",
      .sizes = {"2681 rows, 5 min", "6773 rows, hours"},
      .columns = columns,
      .settings = row_settings(),
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .derive = add_series_columns,
      .checks = check_claims,
      .finding = finding,
      .conclude = answer};
  return run_experiment(experiment, argc, argv);
}
