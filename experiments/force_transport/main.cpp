// What is the cost of letting the rest of the strand move rigidly? The published
// comparisons of "force transport" with CORDE, on hairs of that stiffness and of ours.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "experiments/force_transport/transport_claims.h"
#include "experiments/numerics/equilibrium.h"
#include "experiments/numerics/tip_track.h"
#include "experiments/problems/problems.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments::force_transport {
namespace {

constexpr Column columns[] = {
    {"comparison",
     "dynamics, statics, stiffness, modes, transient, step (the seed's, for long) or "
     "cost"},
    {"scene",
     "straight or curly, clamped horizontally and released; weightless, hanging"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"elements", "number of elements"},
    {"youngs_modulus_pa", "Young's modulus"},
    {"mass_damping_per_s", "damping in proportion to mass"},
    {"dt_s", "fixed step"},
    {"t_s", "time since the release"},
    {"tip_x_m", "position of the tip at t_s, along the clamp"},
    {"tip_y_m", "position of the tip at t_s, sideways"},
    {"tip_z_m", "position of the tip at t_s, upwards"},
    {"corde_difference_rel", "distance from corde's tip, same elements, over the length"},
    {"rod_difference_rel", "distance from the tip of 80 elements of super_helix"},
    {"deflection_error_rel",
     "error of height over width of the strand at rest against the rod's"},
    {"lowest_t_s", "time at which the tip is lowest for the first time"},
    {"lowest_rel", "lowest height of the tip, over the length"},
    {"lowest_t_ratio", "lowest_t_s of corde over this model's"},
    {"chord_rel", "least distance of tip and root until then, over the length"},
    {"slowest_rad_s", "slowest small oscillation in the plane about the straight strand"},
    {"slowest_ratio", "slowest_rad_s over articulated_chain's"},
    {"growth_per_s", "rate at which small oscillations grow, 0: none does"},
    {"complex_modes", "number of modes whose omega^2 is not real"},
    {"energy_growth", "largest energy over that of a random small start, weightless"},
    {"energy_gain_rel", "largest mechanical energy above the start's, over m g L"},
    {"cost_per_element_step_s", "wall time of a step over the number of elements", true},
    {"cost_ratio", "cost_per_element_step_s of corde over this model's", true},
};

using namespace transport;

constexpr int rod_elements = 80;
constexpr double stiff_hair = 3e9;       // Pa
constexpr double seed_step = 3e-3;       // s, published
constexpr double fine_step = 1e-3;       // s, where models are compared, not steps
constexpr double transient_step = 1e-4;  // s, below the periods of most bending modes

struct Work {
  const ModelEntry* model;
  std::string_view integrator;
  Parameters parameters;
  double step;
  double t_end;

  std::unique_ptr<System> make() const { return model->make(parameters); }
  Options options() const {
    Options options;
    options.step = step;
    return options;
  }
  double length() const { return parameters.number("length_m"); }
  double weight() const {
    return strand(parameters).mass() * parameters.number("gravity_m_s2");
  }
};

/// Height over width of a rod clamped horizontally, of gravito-bending parameter 10:
/// Kirchhoff's boundary-value problem on two meshes that agree to 1e-12.
constexpr double master_gamma = 10;
constexpr double master_ratio = 0.7001997155143134 / 0.6563537612385990;

/// Young's modulus for which rho g S L^3/(E I) = 4 rho g L^3/(E r^2) is the master
/// curve's.
double master_modulus(const Parameters& p) {
  const double r = p.number("radius_m"), l = p.number("length_m");
  return 4 * p.number("density_kg_m3") * p.number("gravity_m_s2") * l * l * l /
         (master_gamma * r * r);
}

using Three = std::array<double, 3>;
Three tip_of(const std::vector<double>& x) {
  return {x[x.size() - 3], x[x.size() - 2], x[x.size() - 1]};
}

/// A run that stops when its energy indicates divergence.
struct Watched {
  Simulation run;
  double energy_gain = 0;  // over m g L
  bool apart = false;
};

constexpr double apart_gain = 10;

Watched watched(const Work& work, System& system, const Observer& each_step = {}) {
  const State start = initial_state(system);
  Energetics& energetics = *system.energetics();
  const double before = energetics.energy(0, start.q, start.v).total();
  const double scale = work.weight() * work.length();
  Watched seen;
  seen.run = simulate(work.integrator, system, work.options(), start, work.t_end,
                      [&](double t, In q, In v) {
                        const double now = energetics.energy(t, q, v).total();
                        seen.energy_gain =
                            std::max(seen.energy_gain, (now - before) / scale);
                        seen.apart = !(now - before <= apart_gain * scale);
                        return !seen.apart && (!each_step || each_step(t, q, v));
                      });
  return seen;
}

/// False: the row has the reason.
bool usable(const Watched& seen, Row& row) {
  row.set("energy_gain_rel", seen.energy_gain);
  if (seen.apart) {
    row.failed("unstable", "energy beyond ten times m g L above the start's at " +
                               std::to_string(seen.run.t) + " s");
    return false;
  }
  if (seen.run.status != Status::ok) {
    row.failed("solver_error", seen.run.failure);
    return false;
  }
  return true;
}

void dynamics(const Work& work, Row& row) {
  const auto system = work.make();
  const Watched seen = watched(work, *system);
  if (!usable(seen, row)) return;
  const Three tip = tip_of(points(*system, seen.run.state));
  row.set("tip_x_m", tip[0]).set("tip_y_m", tip[1]).set("tip_z_m", tip[2]);
}

void statics(const Work& work, Row& row) {
  const AtRest rest = at_rest(*work.model, work.parameters);
  const Three tip = tip_of(points(*rest.system, {rest.q, rest.q}));
  row.set("deflection_error_rel", std::abs(-tip[2] / tip[0] / master_ratio - 1));
}

/// The first lowest point of the tip, by the parabola through three steps.
void stiffness(const Work& work, Row& row) {
  const auto system = work.make();
  MaterialPoints& at = *system->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(at.count()));
  std::array<double, 3> z{};  // at t - 2 h, t - h, t
  double lowest_t = 0, lowest = 0, chord = work.length();
  const Watched seen = watched(work, *system, [&](double t, In q, In) {
    at.positions(t, q, x);
    z = {z[1], z[2], x.back()};
    const Three tip = tip_of(x);
    chord = std::min(chord, std::hypot(tip[0], tip[1], tip[2]));
    if (t < 3.5 * work.step || z[1] > z[0] || z[1] > z[2]) return true;
    const double bend = z[0] - 2 * z[1] + z[2], slope = (z[2] - z[0]) / 2;
    lowest_t = t - work.step - work.step * slope / bend;
    lowest = z[1] - slope * slope / (2 * bend);
    return false;
  });
  if (lowest_t == 0) {
    if (usable(seen, row)) row.failed("not_met", "the tip is not lowest before the end");
    return;
  }
  row.set("energy_gain_rel", seen.energy_gain);
  row.set("lowest_t_s", lowest_t).set("lowest_rel", -lowest / work.length());
  row.set("chord_rel", chord / work.length());
}

void modes(const Work& work, Row& row) {
  const auto system = work.make();
  const State rest = initial_state(*system);
  const LinearModes found = linear_modes(*system, rest.q);
  row.set("slowest_rad_s", found.slowest_rad_s).set("growth_per_s", found.growth_per_s);
  row.set("complex_modes", found.complex_modes);
}

/// From small random rates: motions in which all modes take part.
void transient(const Work& work, Row& row) {
  constexpr double enough = 1e6;
  const auto system = work.make();
  const State start = perturbed_start(*system);
  Energetics& energetics = *system->energetics();
  const double before = energetics.energy(0, start.q, start.v).total();
  double growth = 1;
  const Simulation run =
      simulate(work.integrator, *system, work.options(), start, work.t_end,
               [&](double t, In q, In v) {
                 growth = std::max(growth, energetics.energy(t, q, v).total() / before);
                 return growth < enough;
               });
  if (run.status != Status::ok && growth < enough) {
    row.failed("solver_error", run.failure);
    return;
  }
  row.set("energy_growth", growth);
}

void cost(const Work& work, Row& row) {
  constexpr int repeats = 5;
  const auto system = work.make();
  const TipRun run =
      run_tip(work.integrator, *system, work.options(), work.t_end, 1, repeats);
  if (run.status != Status::ok) {
    row.failed("solver_error", run.failure);
    return;
  }
  row.set("cost_per_element_step_s", run.wall_s / static_cast<double>(run.stats.steps) /
                                         work.parameters.number("elements"));
}

/// Common settings of the rows of several models and numbers of elements.
struct Setup {
  std::string_view comparison, scene;
  void (*measure)(const Work&, Row&);
  double modulus;
  std::string_view integrator = "";
  double step = 0, t_end = 0, damping = 0;
};

bool planar(const Setup& setup) {
  return setup.comparison == "modes" || setup.comparison == "transient";
}

std::string text(double x) {
  Row row;  // writes all digits
  return std::string(row.set("x", x).text("x"));
}

Parameters parameters(const Setup& setup, Parameters p, int elements) {
  p.set("elements", std::to_string(elements));
  p.set("youngs_modulus_pa", text(setup.modulus > 0 ? setup.modulus : master_modulus(p)));
  p.set("mass_damping_per_s", text(setup.damping));
  if (setup.scene == "curly") {
    p.set("natural_curvature_per_m", "100");
    p.set("natural_twist_per_m", "30");
  }
  if (setup.scene == "weightless") p.set("gravity_m_s2", "0");
  if (setup.scene == "hanging") p.set("root_tangent", "down");
  if (planar(setup)) p.set("modes", "bend_planar");
  if (setup.integrator == "linearly_implicit_euler")
    set_known(p, {{"jacobian", "elastic"}});
  return p;
}

std::vector<Case> cases(const CommandLine& line) {
  const std::vector<int> counts =
      line.elements.empty() ? std::vector<int>{5, 10, 20, 40} : line.elements;
  const Settings settings(line, {});
  std::vector<Case> all;
  const auto add = [&](const Setup& setup, std::string_view id, int elements) {
    if (!wanted(line.models, id) || !wanted(line.integrators, setup.integrator)) return;
    const ModelEntry& model = find_model(id);
    const Parameters p = parameters(setup, settings.parameters(model), elements);
    Row identity;
    identity.set("comparison", setup.comparison).set("scene", setup.scene);
    identity.set("model", id).set("integrator", setup.integrator);
    identity.set("elements", elements).set("mass_damping_per_s", setup.damping);
    identity.set("youngs_modulus_pa", p.number("youngs_modulus_pa"));
    if (setup.t_end > 0) identity.set("dt_s", setup.step).set("t_s", setup.t_end);
    const Work work{&model, setup.integrator, p, setup.step, setup.t_end};
    all.push_back({identity, [work, measure = setup.measure](Row& row, const auto&) {
                     measure(work, row);
                   }});
  };
  const auto add_models = [&](const Setup& setup) {
    for (const int elements : counts) {
      for (const std::string_view model : {ours, theirs, chain}) {
        // corde is not in equilibrium in its initial state, and stretches.
        if (model == theirs && planar(setup)) continue;
        add(setup, model, elements);
      }
    }
  };
  for (const std::string_view scene : {"straight", "curly"}) {
    for (const double t : {0.05, 0.1, 0.15, 0.2, 0.25, 0.3}) {
      const Setup setup{"dynamics",          scene,     dynamics, stiff_hair,
                        "implicit_midpoint", fine_step, t};
      add_models(setup);
      add(setup, rod, rod_elements);
    }
  }
  add_models({"statics", "straight", statics, 0});
  add_models({"modes", "weightless", modes, stiff_hair});
  add_models({"transient", "weightless", transient, stiff_hair, "implicit_midpoint",
              transient_step, 0.1});
  for (const double modulus : {seed_hair, stiff_hair}) {
    add_models({"modes", "hanging", modes, modulus});
    add_models(
        {"stiffness", "straight", stiffness, modulus, "implicit_midpoint", fine_step, 1});
  }
  for (const double damping : {0.0, 5.0}) {
    add_models({"step", "straight", dynamics, seed_hair, "linearly_implicit_euler",
                seed_step, 2, damping});
  }
  add_models(
      {"cost", "straight", cost, seed_hair, "linearly_implicit_euler", seed_step, 0.3});
  return all;
}

/// A strand that diverges, by its model or by the published step, is a result.
bool finding(const Row& row) { return row.status() == "unstable"; }

constexpr Unused unused[] = {{"repeat", "costs are medians of five runs"},
                             {"seed", "small starts are always the same"}};

}  // namespace
}  // namespace tress::experiments::force_transport

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::force_transport;
  const Experiment experiment{
      .name = "force_transport",
      .question = "what does it cost to let the rest of the strand move rigidly?",
      .example = "--models force_transport,corde --elements 10",
      .sizes = {"260 rows, 10 s", "the same rows"},
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .derive = compare_with_corde,
      .checks = check_transport_claims,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
