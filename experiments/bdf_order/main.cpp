// Which maximum order should a BDF code have on a rod? The Beam problem (stiff, undamped,
// eigenvalues near +-6400 i) with CVODE's BDF of maximum order 1 to 5, beside methods
// that are stable on the imaginary axis (ESDIRK, generalized-alpha, midpoint) and Adams.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/problems/problems.h"
#include "experiments/run/experiment.h"
#include "simulation/run/simulation.h"

namespace tress {
namespace {

constexpr Column columns[] = {
    {"scene", "the problem"},
    {"integrator", "method"},
    {"label", "method, with the maximum order of BDF"},
    {"max_order", "maximum order of a multistep method"},
    {"rtol", "relative tolerance, adaptive methods"},
    {"dt_s", "fixed step"},
    {"error_rel", "largest error of the angles over their scale"},
    {"scd", "significant correct digits of the angles"},
    {"steps", "accepted steps"},
    {"rejected", "rejected steps"},
    {"linearizations", "Newton matrices"},
    {"wall_s", "wall time", true},
};

const Problem& beam() {
  const auto all = problems();
  return *std::find_if(all.begin(), all.end(),
                       [](const Problem& p) { return p.name == "beam"; });
}

void measure(std::string_view integrator, const Options& options, Row& row) {
  const auto begin = std::chrono::steady_clock::now();
  const ProblemRun run = run_problem(beam(), integrator, options);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  const Stats& stats = run.end.stats;
  row.set("steps", stats.steps).set("rejected", stats.rejected);
  row.set("linearizations", stats.linearizations).set("wall_s", wall.count());
  if (run.end.status != Status::ok) {
    row.failed("solver_error", run.end.failure);
    return;
  }
  row.set("error_rel", run.error.relative).set("scd", run.error.scd);
}

void add(std::vector<Case>& all, std::string_view integrator, const std::string& label,
         const Options& options, bool adaptive) {
  Row identity;
  identity.set("scene", "beam").set("integrator", integrator).set("label", label);
  if (options.max_order > 0) identity.set("max_order", options.max_order);
  if (adaptive) {
    identity.set("rtol", options.rtol);
  } else {
    identity.set("dt_s", options.step);
  }
  all.push_back({identity, [integrator, options](Row& row, const auto&) {
                   measure(integrator, options, row);
                 }});
}

std::vector<Case> cases(const CommandLine& line) {
  (void)beam();  // made here once, so that no row pays for it
  std::vector<Case> all;
  const int points = line.full ? 11 : 7;
  for (int level = 0; level < points; ++level) {  // two per decade from 1e-3
    Options options;
    options.rtol = options.atol = std::pow(10, -3 - 0.5 * level);
    for (int order = 1; order <= 5; ++order) {
      options.max_order = order;
      add(all, "cvode_bdf", "cvode_bdf <= " + std::to_string(order), options, true);
    }
    options.max_order = 0;
    add(all, "arkode_dirk", "arkode_dirk", options, true);
    add(all, "cvode_adams", "cvode_adams", options, true);
  }
  for (int level = 0; level < (line.full ? 9 : 7); ++level) {
    Options options;
    options.step = 0.02 / std::pow(2, level);
    for (const std::string_view id : {"generalized_alpha", "implicit_midpoint", "bdf2"}) {
      add(all, id, std::string(id), options, false);
    }
  }
  return all;
}

double steps_of(const std::vector<Row>& rows, int order, double rtol) {
  for (const Row& row : rows) {
    if (row.text("integrator") == "cvode_bdf" && row.number("max_order") == order &&
        std::abs(row.number("rtol") / rtol - 1) < 1e-6) {
      return row.number("steps");
    }
  }
  return std::nan("");
}

void check(const std::vector<Row>& rows, Verdicts& verdicts) {
  // At 1e-3 the outcome hangs on how far Newton's iteration goes: 100 steps or 10 000.
  const double second = steps_of(rows, 2, 1e-4);
  const double fifth = steps_of(rows, 5, 1e-4);
  const std::string claim =
      "BDF up to order 5 needs over ten times the steps of order 2 at rtol 1e-4";
  if (rows.empty()) {
    verdicts.not_judged(claim);
  } else {
    verdicts.check(claim, fifth > 10 * second, fifth / second);
  }
}

/// A run that does not finish is the point: high orders crawl.
bool finding(const Row&) { return true; }

constexpr Unused unused[] = {
    {"models", "it is about the Beam"},
    {"integrators", "the methods that it compares are its question"},
    {"elements", "the Beam has its own"},
    not_repeated,
    not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "bdf_order",
      .question = "which maximum order should a BDF code have on a rod?",
      .example = "--full --timeout 5m",
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .checks = check,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
