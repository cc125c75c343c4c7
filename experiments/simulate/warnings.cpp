#include "experiments/simulate/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "integrators/catalogue.h"
#include "simulation/run/dissipation_warning.h"
#include "simulation/run/remedy.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"

namespace tress::experiments::scene_runs {

namespace {

/// What reduces the energy that the method of a scene dissipates or creates.
std::string_view remedy_of_energy(const Scene& scene) {
  if (scene.chooses_steps()) return "take a smaller tolerance";
  const IntegratorEntry& method = find_integrator(scene.integrator);
  if (ends_after_sweeps(method)) {
    return "take more sweeps, or a method that solves its steps, such as tr_bdf2";
  }
  return *method.order(scene.options.formulation) > 1
             ? "take a shorter dt_s"
             : "take a shorter dt_s, or a method of order 2, such as tr_bdf2";
}

/// Returns the strands with a free root that begin at rest, and that nothing but gravity
/// and air acts on.
std::vector<std::size_t> falling(const Scene& scene) {
  constexpr std::string_view everywhere[] = {"gravity", "linear_drag", "quadratic_drag",
                                             "wind"};
  const auto acts = [&](std::string_view id) {
    return std::ranges::any_of(scene.effects, [id](const EffectChoice& choice) {
      return choice.entry->id == id;
    });
  };
  const bool alone = std::ranges::all_of(scene.effects, [&](const EffectChoice& choice) {
    return std::ranges::count(everywhere, choice.entry->id) > 0;
  });
  if (!alone || !acts("gravity")) return {};
  const simulation::SceneSupports supports(scene);
  const simulation::SceneJoints joints(scene);
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < scene.strands.size(); ++k) {
    const auto& root = scene.strands[k].free_root;
    if (!root || norm(root->velocity) > 0 || norm(root->spin) > 0) continue;
    if (!supports.change(k) && joints.of(k) == nullptr) all.push_back(k);
  }
  return all;
}

/// Part of the slack of the guard from which on a run prints what it used. A run that
/// used all of it ended, and said so.
constexpr double told_excess = 0.1;
constexpr double written = 1e-9;  // of a step that is written as a decimal number

}  // namespace

std::vector<std::string> warnings(const Scene& scene, const SceneRun& run) {
  std::vector<std::string> all;
  if (const auto fall = falling(scene); !fall.empty()) {
    all.push_back(fmt::format(
        "strand {}{} has a free root, begins at rest and falls, since nothing holds it: "
        "give it [[supports]], [[joints]] or a body, or a clamped root",
        fall.front(),
        fall.size() > 1 ? fmt::format(" (the first of {})", fall.size()) : ""));
  }
  if (run.dissipation && simulation::warns(*run.dissipation)) {
    const MethodDissipation& of = *run.dissipation;
    all.push_back(fmt::format(
        "{} {} {:.2g} J (within {:.2g} J), {:.3g} % of the energy of the motion: {}",
        scene.integrator, of.dissipated > 0 ? "dissipated" : "created",
        std::abs(of.dissipated), of.uncertain, 100 * std::abs(of.share()),
        remedy_of_energy(scene)));
  } else if (run.excess.share() > told_excess && run.excess.share() <= 1) {
    all.push_back(fmt::format(
        "a strand had {:.2g} J more energy than its start and its loads explain, "
        "{:.3g} % of the slack that the guard allows for coarse steps: {}",
        run.excess.gained, 100 * run.excess.share(), remedy_of_energy(scene)));
  }
  if (const double frame = 1 / scene.frame_rate;
      !scene.chooses_steps() && scene.options.step > (1 + written) * frame) {
    all.push_back(fmt::format(
        "dt_s = {:.9g} s is longer than the {:.9g} s between frames, at which "
        "steps end: give a shorter dt_s, or fewer frames_per_s",
        scene.options.step, frame));
  }
  if (!run.not_smooth.empty()) {
    all.push_back(fmt::format(
        "the motion is not smooth, and no dt_s or tolerance controls its error: {}; take "
        "a model with material frames, such as der or super_helix",
        run.not_smooth));
  }
  if (run.passed) {
    const MissedContact& missed = run.passed->contact;
    all.push_back(fmt::format(
        "strand {} (segment {}) passed through {} within the step to t = {:.9g} s, "
        "{:.2g} m deep: contact acts at the ends of steps and did not see it; take a {} "
        "below {:.2g}, and elements no longer than the body is thick, or a thicker body",
        run.passed->strand, missed.point == 0 ? 0 : missed.point - 1,
        simulation::effect_names(scene)[missed.body], missed.t, missed.depth,
        scene.chooses_steps() ? "max_step_s" : "dt_s", missed.needed));
  }
  return all;
}

}  // namespace tress::experiments::scene_runs
