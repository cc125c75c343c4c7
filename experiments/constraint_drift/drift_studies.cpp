#include <algorithm>
#include <cmath>

#include "experiments/constraint_drift/constraint_drift.h"
#include "experiments/problems/formulations.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "integrators/integrator_options.h"

namespace tress::experiments::constraint_drift {
namespace {

struct Scene {
  std::string_view name;
  const ModelEntry* model;
  Parameters parameters;
};

/// The user's --set, overridden by the settings that define the scene.
Scene scene(std::string_view name, std::string_view model, const Settings& user,
            const ModelSettings& fixed) {
  const ModelEntry& entry = find_model(model);
  Scene made{name, &entry, user.parameters(entry)};
  for (const auto& [key, value] : fixed) made.parameters.set(key, value);
  return made;
}

Scene circle_bead(const Settings& user) {
  return scene("circle bead", "bead_on_wire", user,
               {{"curve", "circle"}, {"form", "implicit"}});
}

std::vector<Scene> scenes(const Settings& user) {
  return {circle_bead(user),
          scene("parametric bead", "bead_on_wire", user,
                {{"curve", "circle"}, {"form", "parametric"}}),
          scene("chain of 10", "inextensible_chain", user, {{"links", "10"}}),
          scene("truss", "tinkertoys", user, {{"structure", "truss"}, {"size", "1"}})};
}

constexpr double quick_work = 4e6;  // per run

// Baumgarte's gains for the table: a slow and a fast critically damped pair.
constexpr double feedback_rates[] = {10, 100};  // omega, 1/s

void add_formulations(const CommandLine& line, const Settings& user,
                      std::vector<DriftStudy>& studies) {
  const Options base = user.options();
  const std::vector<double> steps =
      line.full ? std::vector<double>{4e-3, 2e-3, 1e-3, 5e-4} : std::vector<double>{1e-3};
  const std::vector<double> tolerances =
      line.full ? std::vector<double>{1e-4, 1e-6, 1e-8} : std::vector<double>{1e-6};
  for (const Scene& scene : scenes(user)) {
    const auto system = scene.model->make(scene.parameters);
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      for (const auto& [formulation, order] : entry.formulations) {
        if (!refusal(entry, *system, formulation).empty()) continue;
        // Redundant constraints are analysed anew at every factorisation: a tenth of the
        // time suffices. For all methods on the chain 10 s take a minute.
        const auto shorter = [&line](double whole, double quick) {
          return line.quick ? quick : whole;
        };
        const double t_end = scene.name == "truss"         ? shorter(1, 0.5)
                             : scene.name == "chain of 10" ? shorter(10, 2)
                                                           : 10;
        DriftStudy study{"formulation", scene.name, scene.model, scene.parameters,
                         entry.id,      base,       t_end};
        study.options.formulation = formulation;
        // IDA becomes very slow when its multipliers are in the error test; enough steps
        // to measure by how much, then the row reports it.
        study.options.max_steps =
            std::min(base.max_steps, line.quick ? 20'000L : 200'000L);
        if (line.quick && base.max_work == 0) study.options.max_work = quick_work;
        const auto add_steps = [&] {
          for (const double value : entry.adaptive ? tolerances : steps) {
            (entry.adaptive ? study.options.rtol : study.options.step) = value;
            study.options.atol = study.options.rtol;
            studies.push_back(study);
          }
        };
        if (formulation == Formulation::baumgarte) {
          for (const double omega : feedback_rates) {
            study.options.alpha = omega * omega;
            study.options.beta = 2 * omega;
            add_steps();
          }
        } else {
          add_steps();
        }
        if (entry.id == "ida" && formulation == Formulation::index2_ggl) {
          // Multipliers held to the tolerance of the coordinates: harmless outside the
          // error test, ruinous in it.
          apply(study.options, "multiplier_atol", "1", "ida");
          add_steps();
          apply(study.options, "suppress_algebraic", "false", "ida");
          add_steps();
        }
      }
    }
  }
}

/// from, from * ratio, ... up to `to`
std::vector<double> geometric(double from, double to, double ratio) {
  std::vector<double> values;
  for (double x = from; x <= to * 1.0001; x *= ratio) values.push_back(x);
  return values;
}

void add_grid(const CommandLine& line, const Settings& user,
              std::vector<DriftStudy>& studies) {
  const double ratio = line.full ? std::pow(10, 0.25) : std::sqrt(10);
  const Scene scene = circle_bead(user);
  for (const std::string_view id :
       {"explicit_euler", "symplectic_euler", "velocity_verlet", "rk4"}) {
    DriftStudy study{"grid", scene.name,     scene.model, scene.parameters,
                     id,     user.options(), 10};
    study.options.formulation = Formulation::acceleration;
    studies.push_back(study);
    study.options.formulation = Formulation::baumgarte;
    for (const double alpha : geometric(1, 1e7, ratio)) {
      for (const double beta : geometric(1, 1e4, ratio)) {
        study.options.alpha = alpha;
        study.options.beta = beta;
        studies.push_back(study);
      }
    }
  }
}

void add_recovery(const Settings& user, std::vector<DriftStudy>& studies) {
  const Scene scene = circle_bead(user);
  const Options base = user.options();
  // RK4 at a tenth of the table's step: its own drift stays below a millionth of the
  // violation, so that only the feedback is observed.
  for (const double omega : {20.0, 100.0}) {
    for (const double ratio : {0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 4.0, 10.0}) {
      DriftStudy study{"recovery", scene.name, scene.model, scene.parameters, "rk4",
                       base,       5};
      study.options.formulation = Formulation::baumgarte;
      study.options.step = base.step / 10;
      study.options.alpha = omega * omega;
      study.options.beta = 2 * omega * std::sqrt(ratio);
      study.violation = 0.01;
      studies.push_back(study);
    }
  }
  for (const std::string_view id : {"rattle", "rk4", "generalized_alpha"}) {
    DriftStudy study{"recovery", scene.name, scene.model, scene.parameters, id, base, 5};
    study.options.formulation = id == "rattle" ? Formulation::rattle
                                : id == "rk4"  ? Formulation::projection
                                               : Formulation::index3;
    study.violation = 0.01;
    studies.push_back(study);
  }
}

/// The common methods for a strand of stiff springs or rigid links.
constexpr std::string_view usual[] = {"linearly_implicit_euler", "backward_euler",
                                      "generalized_alpha",       "rattle",
                                      "predictor_corrector",     "xpbd"};

/// Lengths of a shaken strand by every model that provides them, at half a frame per step
/// and at a short step.
void add_strands(const CommandLine& line, const Settings& user,
                 std::vector<DriftStudy>& studies) {
  const StrandScene& scene = find_strand_scene("shake");
  for (const ModelVariant& variant : length_variants()) {
    Parameters parameters = user.parameters(*variant.model);
    set_known(parameters, scene.settings);
    if (!user.chosen("elements")) parameters.set("elements", "20");
    set_known(parameters, variant.settings);
    const auto system = variant.model->make(parameters);
    for (const std::string_view id : usual) {
      const IntegratorEntry& entry = find_integrator(id);
      for (const Formulation formulation : usable_formulations(entry, *system)) {
        for (const double step : {1 / 120.0, 1e-3}) {
          DriftStudy study{"strands",
                           variant.model->id,
                           variant.model,
                           parameters,
                           id,
                           user.options(),
                           scene.t_end * (line.full    ? 10
                                          : line.quick ? 0.5
                                                       : 1)};
          study.variant = variant.words;
          study.options.formulation = formulation;
          study.options.step = step;
          studies.push_back(study);
        }
      }
    }
  }
}

}  // namespace

std::vector<DriftStudy> drift_studies(const CommandLine& line, const Settings& user) {
  std::vector<DriftStudy> studies;
  add_formulations(line, user, studies);
  add_grid(line, user, studies);
  add_recovery(user, studies);
  add_strands(line, user, studies);
  return studies;
}

}  // namespace tress::experiments::constraint_drift
