#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "experiments/block_descent/block_descent.h"
#include "experiments/numerics/tip_track.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_reference.h"
#include "experiments/problems/strand_scenes.h"
#include "experiments/run/message.h"
#include "integrators/integrator_options.h"
#include "models/strand/strand_parameters.h"
#include "simulation/run/timing.h"

namespace tress::experiments::block_descent {
namespace {

constexpr double t_end = 2;  // s
constexpr int samples = 200;
constexpr double fine_step = 2.5e-4;  // s, of the cantilever's reference
constexpr double long_run = 0.2;      // s, of wall time
constexpr double apart = 10;          // lengths from the direct step: unstable

/// Rod of the published example [Hsu et al. 2025, their code's cantilever], clamped
/// horizontally and damped. It has EI = 4 N m^2, EA = k GA = 100 N, 1 kg/m and 1 m of 10
/// edges. EA is that of a softened section of 2 mm, so that the rotary inertia of
/// sections is negligible.
const ModelSettings cantilever{{"length_m", "1"},
                               {"radius_m", "0.002"},
                               {"youngs_modulus_pa", "3.183098861837907e11"},
                               {"density_kg_m3", "79577.47154594767"},
                               {"poisson_ratio", "0"},
                               {"stretch_factor", "2.5e-5"},
                               {"shear_factor", "5e-5"},
                               {"gravity_m_s2", "9.8"},
                               {"mass_damping_per_s", "3"},
                               {"root_tangent", "x"},
                               {"motion", "fixed"}};

Parameters parameters_of(const Trial& trial, const Settings& settings,
                         const ModelEntry& model, int elements) {
  Parameters p = settings.parameters(model);
  set_known(p, trial.scene == "swing" ? find_strand_scene("swing").settings : cantilever);
  for (const auto& [key, value] : trial.model_settings) {
    if (p.knows(key)) p.set(key, value);
  }
  set_known(p, {{"modes", "bend"}});
  p.set("elements", std::to_string(elements));
  return p;
}

/// Tips and energies of a run.
struct Course {
  Simulation run{};
  std::vector<double> tips;
  std::vector<double> energies;  // J, after every step
};

Course course_of(System& system, std::string_view integrator, const Options& options) {
  const State start = initial_state(system);
  Energetics& energetics = *system.energetics();
  TipSamples seen(system, t_end, samples, 1.5);
  seen.start(start.q, start.v);
  Course course;
  course.run =
      simulate(integrator, system, options, start, t_end, [&](double t, In q, In v) {
        seen.step_to(t, q, v);
        course.energies.push_back(energetics.energy(t, q, v).total());
        return std::isfinite(course.energies.back());
      });
  course.tips = std::move(seen.tips);
  return course;
}

Options options_of(const Trial& trial, const Settings& settings) {
  Options options = settings.options();
  options.step = trial.dt;
  for (const auto& [key, value] : trial.options) {
    integrators::apply(options, key, value, "block_descent");
  }
  return options;
}

/// Of the whole strand at once: backward Euler's step, but for forces that sweeps take
/// from its start.
Options direct_options(const Trial& trial) {
  Options options;
  options.step = trial.dt;
  integrators::apply(options, "block", "0", "block_descent");
  integrators::apply(options, "sweeps", "30", "block_descent");
  return options;
}

/// What rows are compared with, computed before any of them runs.
class References {
 public:
  References(const std::vector<Trial>& trials, const Settings& settings) {
    for (const Trial& trial : trials) {
      if (const auto [at, fresh] = direct_.try_emplace(key(trial)); fresh) {
        tell("{}: direct step of {} s\n", trial.scene, number_text(trial.dt));
        const ModelEntry& model = find_model(trial.model);
        const auto system =
            model.make(parameters_of(trial, settings, model, trial.elements));
        at->second = course_of(*system, "vbd", direct_options(trial));
      }
      if (const auto [at, fresh] = rods_.try_emplace(trial.scene); fresh) {
        at->second = converged(trial, settings);
      }
    }
  }

  const Course& direct(const Trial& trial) const { return direct_.at(key(trial)); }
  const TipReference& rod(const Trial& trial) const { return rods_.at(trial.scene); }

 private:
  using Key = std::tuple<std::string, std::string, std::string, double>;
  static Key key(const Trial& trial) {
    std::string settings;
    for (const auto& [name, value] : trial.model_settings) settings += name + value + " ";
    return {trial.scene, trial.model, settings, trial.dt};
  }

  static TipReference converged(const Trial& trial, const Settings& settings) {
    tell("{}: reference\n", trial.scene);
    Trial plain = trial;
    plain.model_settings.clear();
    const MakeStrand make = [&](std::string_view id, int elements) {
      const ModelEntry& model = find_model(id);
      return model.make(parameters_of(plain, settings, model, elements));
    };
    const Parameters p =
        parameters_of(plain, settings, find_model(trial.model), trial.elements);
    const TipSampling sampling{t_end, samples, p.number("length_m")};
    if (trial.scene == "swing") return converged_rod(make, sampling);
    return extrapolated_model(make, trial.model, trial.elements, sampling, fine_step);
  }

  std::map<Key, Course> direct_;
  std::map<std::string, TipReference> rods_;
};

double largest_apart(In x, In y) {
  double most = 0;
  for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, std::abs(x[i] - y[i]));
  return most;
}

/// A trial with all that it needs.
struct Work {
  Trial trial;
  Parameters parameters;
  Options options;
  int repeat;
};

void measure(const Work& work, const References& references, Row& row) {
  const auto& [trial, p, options, repeat] = work;
  const auto system = find_model(trial.model).make(p);
  const double length = p.number("length_m");
  Course now;
  const double wall =
      seconds_of([&] { now = course_of(*system, trial.integrator, options); });
  row.set("steps", now.run.stats.steps);
  if (now.run.status != Status::ok) {
    row.failed("diverged", now.run.failure);
    return;
  }
  const Course& direct = references.direct(trial);
  const TipReference& rod = references.rod(trial);
  const double error = tip_error(now.tips, rod.tip, length);
  row.set("error_rel", error).set("reference_gap_rel", rod.gap);
  row.set("within_1_percent", error <= wanted_error);
  if (!(error <= apart)) {
    row.failed("unstable", "the tip is beyond ten lengths");
    return;
  }
  if (direct.run.status == Status::ok) {
    const double scale = strand(p).mass() * p.number("gravity_m_s2") * length;
    row.set("direct_distance_rel", tip_error(now.tips, direct.tips, length));
    row.set("direct_error_rel", tip_error(direct.tips, rod.tip, length));
    row.set("energy_distance_rel", largest_apart(now.energies, direct.energies) / scale);
  }
  // In a long run reading tips and energies takes no time beside the sweeps.
  const State start = initial_state(*system);
  const auto run = [&] { simulate(trial.integrator, *system, options, start, t_end); };
  row.set("wall_s_per_sim_s", (wall > long_run ? wall : time_run(repeat, run)) / t_end);
}

/// EA L^2/(E I), softened as the model is.
double stretch_over_bending(const Parameters& p) {
  const double factor = p.knows("stretch_factor") ? p.number("stretch_factor") : 1;
  const double slender = p.number("length_m") / p.number("radius_m");
  return 4 * factor * slender * slender;
}

Row identity(const Work& work) {
  const Trial& trial = work.trial;
  Row row;
  row.set("part", trial.part).set("scene", trial.scene).set("model", trial.model);
  row.set("integrator", trial.integrator).set("elements", trial.elements);
  row.set("dt_s", trial.dt)
      .set("stretch_over_bending", stretch_over_bending(work.parameters));
  for (const Parameter& option : find_integrator(trial.integrator).parameters) {
    for (const char* column : {"sweeps", "block", "chebyshev", "anderson",
                               "penalty_per_s2", "primal_sweeps"}) {
      if (option.name != column) continue;
      row.set(column, integrators::text_of(work.options, column));
    }
  }
  return row;
}

}  // namespace

std::vector<Case> cases_of(const std::vector<Trial>& trials, const CommandLine& line) {
  const Settings settings(line, {});
  const auto references =
      line.dry_run ? nullptr : std::make_shared<const References>(trials, settings);
  std::vector<Case> all;
  for (const Trial& trial : trials) {
    const Work work{
        trial, parameters_of(trial, settings, find_model(trial.model), trial.elements),
        options_of(trial, settings), line.repeat};
    all.push_back({identity(work), [work, references](Row& row, const Deadline&) {
                     measure(work, *references, row);
                   }});
  }
  return all;
}

}  // namespace tress::experiments::block_descent
