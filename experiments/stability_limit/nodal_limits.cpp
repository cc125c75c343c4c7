#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/numerics/amplification.h"
#include "experiments/numerics/fit.h"
#include "experiments/stability_limit/stability_limit.h"
#include "models/catalogue.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments::stability_limit {
namespace {

constexpr double claimed_step = 1e-5;  // s
constexpr int claimed_nodes = 200;

struct NodalMethod {
  std::string_view integrator, jacobian, start;
};
/// Stiff: implicit only in the terms of highest order, as in the paper.
constexpr NodalMethod nodal_methods[] = {
    {"linearly_implicit_midpoint", "elastic", "space"},
    {"linearly_implicit_midpoint", "elastic", "plane"},
    {"linearly_implicit_euler", "elastic", "space"},
    {"velocity_verlet", "exact", "space"},
    {"rk4", "exact", "space"},
    {"backward_euler", "exact", "space"},
};

struct NodalCase {
  StabilityCase which;
  std::string_view start;
  Parameters parameters;
  Options options;
  double t_end;  // s
  double most_work;
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

/// Straight, with small velocities; in the plane of gravity without twist or curvature
/// about e2.
State start_of(std::string_view start, System& system) {
  State state = perturbed_start(system);
  if (start == "plane") {
    for (std::size_t i = 0; i < state.v.size(); ++i) {
      if (i % 3 != 1) state.v[i] = 0;
    }
  }
  return state;
}

void measure(const NodalCase& c, Row& row) {
  const auto system = c.which.model->make(c.parameters);
  const StabilityBounds bounds = stability_bounds(*c.which.scene, c.parameters, *system);
  const State start = start_of(c.start, *system);
  const auto runs = [&] {
    return StabilityRuns(c.which.integrator, *system, c.options, start, c.t_end, bounds,
                         c.most_work);
  };
  row.set("t_end_s", c.t_end).set("energy_bound_j", bounds.energy);
  const auto of_explicit = largest_stable_omega_h(c.which.integrator, 0);
  if (of_explicit) {
    const auto [bending, twist] = highest(c.parameters);
    row.set("dt_theory_s", *of_explicit / std::max(bending, twist));
    row.set("dt_bending_s", *of_explicit / bending);
  }
  // Newton's steps with dense Jacobians are outside the claim, and 1e5 of them too many.
  if (of_explicit || c.which.jacobian == "elastic") {
    if (const auto run = runs().judge(claimed_step)) {
      row.set("at_claim", name(run->broken)).set("t_claim_s", run->t);
      row.set("energy_gain_claim_j", run->energy_gain);
    }
  }
  StabilityRuns tried = runs();
  static_cast<void>(find_limit(
      c.search, [&](double dt) { return tried.judge(dt); }, row));
}

void check_claimed_step(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto at_claim = [&](std::string_view integrator, bool stable,
                            const Claim& claim) {
    const Claim whole("straight hair, 200 nodes, 1e-5 s: " + claim.words, claim.key);
    for (const Row& row : rows) {
      if (row.text("study") != "nodal" || row.text("integrator") != integrator ||
          row.text("start") != "space" || row.number("elements") != claimed_nodes) {
        continue;
      }
      const bool held =
          row.has("at_claim") && (row.text("at_claim") == "nothing") == stable;
      return verdicts.check(whole, held, row.number("t_claim_s"));
    }
    verdicts.not_judged(whole);
  };
  at_claim(
      "linearly_implicit_midpoint", false,
      {"the splitting of Hou et al. at order 2 is unstable", "nodal_order_2_unstable"});
  at_claim("linearly_implicit_euler", true,
           {"the same splitting at order 1, which damps fast modes, is stable",
            "nodal_order_1_stable"});
  at_claim("velocity_verlet", false, "explicit steps are unstable");
  at_claim("rk4", false, "explicit steps of order 4 are unstable");
}

void check_planar_limit(const std::vector<Row>& rows, Verdicts& verdicts) {
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
}

void check_explicit_limits(const std::vector<Row>& rows, Verdicts& verdicts) {
  double ratio = 1;
  for (const Row& row : rows) {
    if (!row.ok() || !row.has("dt_theory_s")) continue;
    const double found = row.number("dt_max_s") / row.number("dt_theory_s");
    ratio = std::max({ratio, found, 1 / found});
  }
  // The clamp lowers the highest frequency by (pi/2N)^2/2, 0.3 % at N = 20, and the
  // search resolves 5 %.
  const std::string theory =
      "explicit methods: the largest step is that of the grid's twist within 6 %";
  if (ratio > 1) {
    verdicts.check(theory, ratio < 1.06, ratio);
  } else {
    verdicts.not_judged(theory);
  }
}

}  // namespace

std::vector<Case> nodal_cases(const CommandLine& line, const Settings& settings) {
  const Parameters& rows = settings.experiment();
  std::vector<Case> all;
  if (rows.word("study") != "all" && rows.word("study") != "nodal") return all;
  const std::vector<int> counts = line.elements.empty()
                                      ? std::vector<int>{20, 50, 100, claimed_nodes}
                                      : line.elements;
  const double work = set_or(rows, "row_work", line.quick ? 1.5e8 : 1e9);
  for (const int elements : counts) {
    for (const NodalMethod& m : nodal_methods) {
      const StabilityCase which{&find_strand_scene("release"),
                                &find_model("kirchhoff_nodal"),
                                m.integrator,
                                "",
                                m.jacobian,
                                "",
                                elements,
                                undamped};
      if (!which.selected(line, rows)) continue;
      // Waves amplified by an explicit step are visible after a few tens of steps.
      const double t_end = largest_stable_omega_h(m.integrator, 0) ? 0.02
                           : line.quick                            ? 0.25
                                                                   : 1;
      const NodalCase c{which,
                        m.start,
                        which.parameters(settings),
                        settings.options(),
                        set_or(rows, "horizon_s", t_end),
                        work,
                        step_search(rows, 1e-7, 1)};
      Row row = which.identity();
      row.set("study", "nodal").set("start", m.start);
      all.push_back({row, [c](Row& of_case, const Deadline&) { measure(c, of_case); }});
    }
  }
  return all;
}

void check_nodal_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  check_claimed_step(rows, verdicts);
  check_planar_limit(rows, verdicts);
  check_explicit_limits(rows, verdicts);
}

}  // namespace tress::experiments::stability_limit
