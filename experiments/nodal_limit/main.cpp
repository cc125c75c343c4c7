// Is a nodal scheme of Kirchhoff's equations with the stiffness of curvature removed
// unstable for a hair of 200 nodes at steps of 1e-5 s, and which steps does it need?
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "experiments/numerics/amplification.h"
#include "experiments/numerics/fit.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/strand/strand_parameters.h"

namespace tress {
namespace {

constexpr Column columns[] = {
    {"integrator", "method"},
    {"tangent", "stiff: implicit in the terms of highest order only, as in the paper"},
    {"start",
     "space: shaken in all directions by 1e-3 of its rates; plane: not out of it"},
    {"elements", "number of nodes"},
    {"at_claim", "what broke at steps of 1e-5 s; nothing: stable"},
    {"t_claim_s", "when it ended"},
    {"energy_gain_claim_j", "largest gain of energy until then"},
    {"dt_max_s", "largest step found stable"},
    {"dt_first_unstable_s", "smallest unstable step tested"},
    {"limited_by", "what broke there; cap: no larger step was tried"},
    {"dt_theory_s", "explicit methods: limit over the highest frequency of the grid"},
    {"dt_bending_s", "the same of bending alone"},
    {"runs", "steps tested"},
    {"t_end_s", "time simulated by a run"},
    {"energy_bound_j", "gain of energy that is unstable"},
};

constexpr Parameter settings_of_rows[] = {
    {.name = "t_end_s",
     .help = "time simulated (s), 0: 1, with --quick 0.25, explicit methods 0.02",
     .number = 0,
     .min = 0},
    {.name = "cap_s", .help = "largest step tried (s)", .number = 0.1, .min = 1e-9},
    {.name = "floor_s", .help = "smallest step tried (s)", .number = 1e-7, .min = 1e-12},
    {.name = "row_work",
     .help = "work of the search for one row (max_work), 0: 1e9, with --quick 1.5e8",
     .number = 0,
     .min = 0},
};

constexpr std::string_view model = "kirchhoff_nodal";
constexpr double claimed_step = 1e-5;  // s
constexpr int claimed_nodes = 200;

struct Method {
  std::string_view integrator, tangent, start;
  enum Kind { splitting, explicit_steps, newton } kind;
};
constexpr Method methods[] = {
    {"linearly_implicit_midpoint", "stiff", "space", Method::splitting},
    {"linearly_implicit_midpoint", "stiff", "plane", Method::splitting},
    {"semi_implicit_euler", "stiff", "space", Method::splitting},
    {"velocity_verlet", "exact", "space", Method::explicit_steps},
    {"rk4", "exact", "space", Method::explicit_steps},
    {"backward_euler", "exact", "space", Method::newton},
};

struct Work {
  Method method;
  int elements;
  Parameters parameters;
  Options options;
  double t_end;  // s
  double claim_work, search_work;
  StepSearch search;
};

/// Highest frequencies (rad/s) of a grid of n equal edges: of bending, 4 sqrt(EI/(rho
/// S))/h^2, and of twist, 2 sqrt(GJ/(rho (I1 + I2)))/h.
struct Frequencies {
  double bending, twist;
};
Frequencies highest(const Parameters& parameters) {
  const Strand made = strand(parameters);
  const Segment& segment = made.segments.front();
  const CrossSection& section = segment.section;
  const Vec moduli = stiffness(made.material, section);
  const double rho = made.material.density, h = segment.length;
  return {4 * std::sqrt(std::max(moduli.y, moduli.z) / (rho * section.area())) / (h * h),
          2 * std::sqrt(moduli.x / (rho * section.polar())) / h};
}

/// Straight, with small velocities; in the plane of gravity none of twist and of
/// curvature about e2.
State start_of(const Method& method, System& system) {
  State start = perturbed_start(system);
  if (method.start == "plane") {
    for (std::size_t i = 0; i < start.v.size(); ++i) {
      if (i % 3 != 1) start.v[i] = 0;
    }
  }
  return start;
}

void measure(const Work& work, Row& row) {
  const StrandScene& scene = find_strand_scene("release");
  const auto system = find_model(model).make(work.parameters);
  const StabilityBounds bounds = stability_bounds(scene, work.parameters, *system);
  const State start = start_of(work.method, *system);
  const auto runs = [&](double most_work) {
    return StabilityRuns(work.method.integrator, *system, work.options, start, work.t_end,
                         bounds, most_work);
  };
  row.set("t_end_s", work.t_end).set("energy_bound_j", bounds.energy);
  if (const auto limit = stability_limit(work.method.integrator, 0)) {
    const auto [bending, twist] = highest(work.parameters);
    row.set("dt_theory_s", *limit / std::max(bending, twist));
    row.set("dt_bending_s", *limit / bending);
  }
  // Newton's steps with dense tangents are not the claim's, and 1e5 of them too many.
  if (work.method.kind != Method::newton) {
    if (const auto run = runs(work.claim_work).judge(claimed_step)) {
      row.set("at_claim", name(run->broken)).set("t_claim_s", run->t);
      row.set("energy_gain_claim_j", run->energy_gain);
    }
  }

  StabilityRuns tried = runs(work.search_work);
  const StepLimit limit =
      find_step_limit(work.search, [&](double dt) -> std::optional<Broken> {
        const auto run = tried.judge(dt);
        if (!run) return {};
        return run->broken;
      });
  row.set("dt_max_s", limit.stable).set("dt_first_unstable_s", limit.unstable);
  row.set("runs", limit.runs);
  if (!std::isnan(limit.unstable)) row.set("limited_by", name(limit.limited_by));
  if (limit.stable >= work.search.coarsest) row.set("limited_by", "cap");
  if (!limit.resolved && !limit.complete) {
    row.failed("gave_up", "the work of a row was used up before the limit was found");
  } else if (std::isnan(limit.stable)) {
    row.failed("unstable", "no stable step down to " + std::to_string(limit.finest) +
                               " s: " + std::string(name(limit.limited_by)));
  }
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, settings_of_rows);
  const Parameters& rows = settings.experiment();
  const auto chosen = [&rows](std::string_view key, double otherwise) {
    return rows.number(key) > 0 ? rows.number(key) : otherwise;
  };
  const std::vector<int> counts = line.elements.empty()
                                      ? std::vector<int>{20, 50, 100, claimed_nodes}
                                      : line.elements;
  std::vector<Case> all;
  if (!wanted(line.models, model)) return all;
  for (const int elements : counts) {
    for (const Method& method : methods) {
      if (!wanted(line.integrators, method.integrator)) continue;
      Parameters p = settings.parameters(find_model(model));
      for (const auto& [key, value] : find_strand_scene("release").settings) {
        p.set(key, value);
      }
      p.set("elements", std::to_string(elements));
      p.set("tangent", method.tangent);
      Row identity;
      identity.set("integrator", method.integrator).set("tangent", method.tangent);
      identity.set("start", method.start).set("elements", elements);
      // Waves that an explicit step makes grow are seen after a few tens of steps.
      const double t_end = method.kind == Method::explicit_steps ? 0.02
                           : line.quick                          ? 0.25
                                                                 : 1;
      const Work work{method,
                      elements,
                      p,
                      settings.options(),
                      chosen("t_end_s", t_end),
                      line.quick ? 1.5e8 : 1e9,
                      chosen("row_work", line.quick ? 1.5e8 : 1e9),
                      {.coarsest = rows.number("cap_s"),
                       .finest = rows.number("floor_s"),
                       .depth = 1}};
      all.push_back(
          {identity, [work](Row& row, const Deadline&) { measure(work, row); }});
    }
  }
  return all;
}

const Row* claimed(const std::vector<Row>& rows, std::string_view integrator) {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.text("integrator") == integrator && row.text("start") == "space" &&
           row.text("elements") == std::to_string(claimed_nodes);
  });
  return found == rows.end() ? nullptr : &*found;
}

void check_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto at_claim = [&](std::string_view integrator, bool stable,
                            const std::string& claim) {
    const Row* row = claimed(rows, integrator);
    const std::string whole = "straight hair, 200 nodes, 1e-5 s: " + claim;
    if (row == nullptr) {
      verdicts.not_judged(whole);
      return;
    }
    verdicts.check(whole,
                   row->has("at_claim") && (row->text("at_claim") == "nothing") == stable,
                   row->number("t_claim_s"));
  };
  at_claim("linearly_implicit_midpoint", false,
           "the splitting of Hou et al. at order 2 is unstable");
  at_claim("semi_implicit_euler", true,
           "at order 1, which damps fast modes, it is stable");
  at_claim("velocity_verlet", false, "explicit steps are unstable");
  at_claim("rk4", false, "explicit steps of order 4 are unstable");
  std::vector<double> counts, limits;
  int planar = 0;
  for (const Row& row : rows) {
    if (row.text("start") != "plane") continue;
    ++planar;
    if (!row.ok()) continue;
    counts.push_back(row.number("elements"));
    limits.push_back(row.number("dt_max_s"));
  }
  const std::string falls =
      "in a plane the largest step of the splitting at order 2 falls as 1/N^2";
  if (planar < 3) {
    verdicts.not_judged(falls);
  } else {
    const double slope = counts.size() < 3 ? std::nan("") : log_log_slope(counts, limits);
    verdicts.check(falls, std::abs(slope + 2) < 0.2, slope);
  }
  double ratio = 1;
  for (const Row& row : rows) {
    if (!row.ok() || !row.has("dt_theory_s")) continue;
    const double found = row.number("dt_max_s") / row.number("dt_theory_s");
    ratio = std::max({ratio, found, 1 / found});
  }
  // The clamp lowers the highest frequency by (pi/2N)^2/2, 0.3 % at N = 20, and the
  // search leaves 5 %.
  const std::string theory = "explicit limits are those of the grid's twist to 6 %";
  if (ratio > 1) {
    verdicts.check(theory, ratio < 1.06, ratio);
  } else {
    verdicts.not_judged(theory);
  }
}

/// A limit, or that nobody waits for it, is what is looked for.
bool finding(const Row& row) {
  return row.status() == "unstable" || row.status() == "gave_up";
}

constexpr Unused unused[] = {not_repeated, not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "nodal_limit",
      .question = "is the nodal scheme unstable with 200 nodes at steps of 1e-5 s?",
      .example = "--elements 20,200 --integrators linearly_implicit_midpoint",
      .timed = false,
      .columns = columns,
      .settings = settings_of_rows,
      .unused = unused,
      .cases = cases,
      .checks = check_claims,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
