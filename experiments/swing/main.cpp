// What does a stated error cost on the strand on which other simulators were measured?
// Tip error against wall time of 2 simulated seconds, of time alone at their number of
// elements, and in all against the continuous rod from few elements on.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/numerics/pareto.h"
#include "experiments/numerics/tip_track.h"
#include "experiments/problems/reference.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/experiment.h"
#include "experiments/run/message.h"
#include "experiments/swing/swing_claims.h"
#include "experiments/swing/swing_grid.h"

namespace tress {
namespace {

constexpr Column columns[] = {
    {"error_kind",
     "time: against the same model's converged run; total: against the continuous rod"},
    {"model", "catalogue id"},
    {"modes", "unknowns per element"},
    {"solver", "how the model solves S x = b"},
    {"tangent", "which terms S has; empty: the integrator takes no S"},
    {"integrator", "method"},
    {"max_order", "highest order it may use, where that was chosen"},
    {"newton_tolerance", "largest correction over the model's scale, where we iterate"},
    {"refresh", "when S is rebuilt"},
    {"elements", "number of elements"},
    {"grading", "last element's length over the first's"},
    {"dt_s", "fixed step"},
    {"rtol", "relative and absolute tolerance, adaptive methods"},
    {"tip_error_rel",
     "root mean square over the run, every 20 ms, of the tip's distance from the "
     "reference, over the length"},
    {"reference_gap", "the same of the second reference from the first"},
    {"below_reference", "error below ten times that gap: not to be trusted"},
    {"wall_s", "median wall time of the run of 2 s, setting up aside", true},
    {"us_per_step", "the same per step", true},
    {"steps", "accepted steps"},
    {"rejected", "rejected steps"},
    {"residuals", "residual or acceleration evaluations"},
    {"linearizations", "matrices built and factored"},
    {"solves", "linear solves"},
    {"pareto",
     "no other run of this kind, at this number of elements if of time alone, "
     "is both faster and more accurate"},
};

constexpr double length = 0.2;  // m, of the scene
constexpr int samples = 100;    // every 20 ms, as the peers' error

/// What errors are measured against: made before any row runs, since rows run in
/// processes of their own.
class References {
 public:
  References(const Settings& settings, const std::vector<SwingCase>& cases) {
    const TipSampling sampling{find_strand_scene("swing").t_end, samples, length};
    const MakeStrand make = [&settings](std::string_view model, int elements) {
      const ModelEntry& entry = find_model(model);
      Parameters p = swing_parameters(settings, entry, elements);
      p.set("modes", "bend");
      p.set("tangent", "stiff");
      return entry.make(p);
    };
    for (const SwingCase& c : cases) {
      if (c.error_kind == "total") {
        if (!rod_.tip.empty()) continue;
        tell("swing: continuous rod\n");
        rod_ = converged_rod(make, sampling);
      } else if (TipReference& r = models_[{c.model->id, c.elements}]; r.tip.empty()) {
        tell("swing: converged {}, {} elements\n", c.model->id, c.elements);
        r = converged_model(make, c.model->id, c.elements, sampling);
      }
    }
  }

  const TipReference& of(const SwingCase& c) const {
    return c.error_kind == "total" ? rod_ : models_.at({c.model->id, c.elements});
  }

 private:
  TipReference rod_;
  std::map<std::pair<std::string_view, int>, TipReference> models_;
};

void measure(const SwingCase& c, const Parameters& parameters,
             const TipReference& reference, int repeat, Row& row) {
  const auto system = c.model->make(parameters);
  const double t_end = find_strand_scene("swing").t_end;
  Guard guard(*system, guarded_strands(*c.model, parameters));
  const TipRun run =
      run_tip(c.integrator, *system, c.options, t_end, samples, repeat, &guard);
  const Stats& stats = run.stats;
  row.set("steps", stats.steps).set("rejected", stats.rejected);
  row.set("residuals", stats.residuals).set("linearizations", stats.linearizations);
  row.set("solves", stats.solves).set("reference_gap", reference.gap);
  if (run.status != Status::ok) {
    row.failed("solver_error", run.failure);
    return;
  }
  const double error = tip_error(run.tip, reference.tip, length);
  if (!(error <= 0.5)) {
    row.failed("diverged", "error above half the length of the strand");
    return;
  }
  row.set("tip_error_rel", error);
  row.set("below_reference", error < ReferenceGap::margin * reference.gap);
  row.set("wall_s", run.wall_s);
  row.set("us_per_step", 1e6 * run.wall_s / static_cast<double>(stats.steps));
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, swing_settings());
  const std::vector<SwingCase> chosen = swing_cases(line, settings);
  const auto references =
      line.dry_run ? nullptr : std::make_shared<const References>(settings, chosen);
  std::vector<Case> all;
  all.reserve(chosen.size());
  for (const SwingCase& c : chosen) {
    all.push_back({c.identity(), [c, references, parameters = c.parameters(settings),
                                  repeat = line.repeat](Row& row, const Deadline&) {
                     measure(c, parameters, references->of(c), repeat, row);
                   }});
  }
  return all;
}

void derive(std::vector<Row>& rows) {
  // Total errors compete across numbers of elements, time errors do not.
  add_pareto(rows, "tip_error_rel", [](const Row& row) {
    const bool total = row.text("error_kind") == "total";
    return total ? "total" : "time/" + std::string(row.text("elements"));
  });
}

/// A step or tolerance too loose for the method is where its curve ends, not a mistake.
bool finding(const Row&) { return true; }

constexpr Unused unused[] = {not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "swing",
      .question =
          "what does a stated error cost on the strand that other simulators ran?",
      .example = "--integrators implicit_midpoint --set error=time",
      .columns = columns,
      .settings = swing_settings(),
      .unused = unused,
      .cases = cases,
      .derive = derive,
      .checks = check_swing_claims,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
