// Would elements that are divided anew while a strand moves need fewer of them?
#include <algorithm>
#include <cmath>
#include <memory>

#include "contract/input_error.h"
#include "experiments/adaptive_mesh/adaptive_mesh.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "simulation/files/parse.h"

namespace tress::experiments::adaptive_mesh {
namespace {

constexpr Column columns[] = {
    {"part",
     "errors (for given elements), elements (for a distance), limit (of the "
     "gain), in_motion (tolerance_m, rest mesh), pilot (tolerance_m, pilot "
     "runs), points (of quadrature)"},
    {"scene", "name of the scene"},
    {"model", "model of the reference"},
    {"fine_elements", "number of elements of the reference"},
    {"instants", "number of instants at which shapes are compared"},
    {"elements", "number of helices"},
    {"mesh",
     "equal, start (shape at rest or t = 0), mean or largest (of |kappa'|^(2/3) "
     "over the run), `anew` (remeshed at every shape)"},
    {"misfit_rms_rel",
     "distance of the nearest chain of helices, rms over strand and instants, over the "
     "length"},
    {"misfit_largest_rel",
     "largest distance of the nearest chain of helices over the instants, rms "
     "over the strand, over the length"},
    {"target_rel", "target misfit_rms_rel"},
    {"elements_fixed", "elements that the best fixed mesh needs for the target"},
    {"fixed_mesh", "best fixed mesh"},
    {"elements_remeshed",
     "elements that remeshing needs for the target, the same number at every "
     "instant"},
    {"elements_following",
     "elements that remeshing needs with the target met at each instant: mean "
     "over the instants"},
    {"tolerance_rel", "tolerance_m of mesh = \"rest\", over the length"},
    {"tip_error_rel",
     "rms distance of the tips from those of a finer mesh in the first half "
     "second, over the length; points: from those of 96 elements"},
    {"largest_error_rel",
     "largest distance of any joint in the worst frame, over the length"},
    {"estimate_rel", "pilot: the pilot's estimate of largest_error_rel"},
    {"work_rel",
     "pilot: elements of all pilot runs over those of one run with the elements "
     "found"},
    {"points_error_rel", "distance of tips from those with 32 quadrature points"},
    {"turning_rad", "largest angle by which the tangent turns along the strand"},
    {"gain", "elements_fixed over elements_remeshed"},
    {"gain_following", "elements_fixed over elements_following"},
    {"gain_always", "gain with misfit_largest_rel as the target"},
    {"gain_following_always", "gain_following with misfit_largest_rel as the target"},
};

constexpr std::string_view shipped =
    "experiments/adaptive_mesh/edge.toml,experiments/adaptive_mesh/long_curl.toml,"
    "scenes/accuracy/fall_on_sphere.toml,scenes/accuracy/release.toml,"
    "scenes/accuracy/shaken_friction.toml,scenes/accuracy/side_wind.toml,"
    "scenes/accuracy/swing.toml,scenes/accuracy/whip.toml,scenes/knot_tightened.toml,"
    "scenes/plectoneme.toml";

constexpr Parameter own_settings[] = {
    {.name = "scenes",
     .help = "scene files of one strand, as in scenes/a.toml,scenes/b.toml",
     .text = true,
     .fallback = shipped},
};

constexpr OwnOption command_options[] = {
    {"scene", "scenes",
     "your own scene (several: a.toml,b.toml) instead of the built-in ones", true},
};

constexpr double targets[] = {1e-2, 1e-3};
constexpr int least_fine = 144;  // a whole number of joints for each of the cells

struct Work {
  simulation::Scene scene;
  int fine, instants;
  std::vector<int> elements;
};

std::vector<Row> measure(const Work& work, const Row& identity) {
  std::vector<Row> rows;
  try {
    const Shapes shapes = shapes_of(work.scene, work.fine, work.instants);
    const Limit limit = limit_of(shapes);
    Row most = identity;
    most.set("part", "limit").set("turning_rad", turning_of(shapes));
    most.set("gain", limit.remeshed).set("gain_following", limit.following);
    rows.push_back(most);
    // Helices that wind by more are not found by the fit.
    if (turning_of(shapes) > work.elements.back()) return rows;
    const std::vector<Misfit> all =
        misfits(shapes, density_at_rest(work.scene, shapes), work.elements);
    for (const double target : targets) {
      const Needed found = needed(all, target, root_mean_square);
      Row row = identity;
      row.set("part", "elements").set("target_rel", target);
      row.set("elements_fixed", found.fixed).set("fixed_mesh", name(found.best));
      row.set("elements_remeshed", found.remeshed);
      row.set("elements_following", found.following);
      row.set("gain", found.fixed / found.remeshed);
      row.set("gain_following", found.fixed / found.following);
      const Needed always = needed(all, target, largest);
      row.set("gain_always", always.fixed / always.remeshed);
      row.set("gain_following_always", always.fixed / always.following);
      rows.push_back(row);
    }
    for (const Misfit& one : all) {
      Row row = identity;
      row.set("part", "errors").set("elements", one.elements).set("mesh", name(one.cuts));
      row.set("misfit_rms_rel", root_mean_square(one.at));
      row.set("misfit_largest_rel", largest(one.at));
      rows.push_back(row);
    }
  } catch (const InputError& refused) {
    rows.assign(1, identity);
    rows.front().failed("refused", refused.what());
  } catch (const std::runtime_error& failure) {
    rows.assign(1, identity);
    rows.front().failed("diverged", failure.what());
  }
  return rows;
}

void set_error(const MotionError& error, Row& row) {
  row.set("elements", error.elements).set("tip_error_rel", error.tip);
  row.set("largest_error_rel", error.largest);
}

void add_in_motion(std::vector<Case>& all) {
  for (const LooseHair& hair : loose_hairs()) {
    for (const double tolerance : {judged_tolerance, judged_tolerance / 2}) {
      Row identity;
      identity.set("part", "in_motion").set("scene", hair.name);
      identity.set("model", "super_helix").set("tolerance_rel", tolerance);
      all.push_back({identity, [hair, tolerance](Row& row, const Deadline&) {
                       const MotionError error = motion_error(hair, tolerance);
                       set_error(error, row);
                     }});
    }
    Row identity;
    identity.set("part", "pilot").set("scene", hair.name);
    identity.set("model", "super_helix").set("tolerance_rel", judged_tolerance);
    all.push_back({identity, [hair](Row& row, const Deadline&) {
                     const PilotError error = pilot_error(hair, judged_tolerance);
                     set_error(error.found, row);
                     row.set("estimate_rel", error.estimate);
                     row.set("work_rel", error.work);
                   }});
  }
}

void add_points(std::vector<Case>& all, const simulation::Scene& scene) {
  for (const int elements : {4, 8}) {
    Row identity;
    identity.set("part", "points").set("scene", scene.name);
    identity.set("model", scene.model->id).set("elements", elements);
    all.push_back({identity, [scene, elements](Row& row, const Deadline&) {
                     const PointsError error = points_error(scene, elements);
                     row.set("points_error_rel", error.points);
                     row.set("tip_error_rel", error.elements);
                   }});
  }
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  std::vector<Case> all;
  if (settings.experiment().word("scenes") == shipped) add_in_motion(all);
  for (const simulation::Scene& scene : simulation::read_scenes(
           listed_files(settings.experiment().word("scenes"), "scenes"))) {
    if (scene.strands.size() != 1) {
      throw InputError("not one strand but " + std::to_string(scene.strands.size()),
                       "scene " + scene.name, "give scenes of one strand");
    }
    const int given = static_cast<int>(scene.strands.front().segments.size());
    Work work{scene, std::max(least_fine, given), line.quick ? 10 : 48, {}};
    work.elements = line.quick ? std::vector{1, 2, 3, 4, 6, 8, 12, 16, 24, 32}
                               : std::vector{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
    Row identity;
    identity.set("scene", scene.name).set("model", scene.model->id);
    identity.set("fine_elements", work.fine).set("instants", work.instants + 1);
    if (scene.model->id == "super_helix") add_points(all, scene);
    all.push_back({identity, {}, [work](const Row& own, const Deadline&) {
                     return measure(work, own);
                   }});
  }
  return all;
}

constexpr Unused unused[] = {{"models", "the scene files set them"},
                             {"integrators", "the scene files set them"},
                             {"elements", "the study tries many"},
                             not_random,
                             not_repeated};

}  // namespace
}  // namespace tress::experiments::adaptive_mesh

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::adaptive_mesh;
  const Experiment experiment{
      .name = "adaptive_mesh",
      .question =
          "would elements that are divided anew while a strand moves need fewer of them?",
      .example = "--set scenes=scenes/accuracy/whip.toml --quick",
      .sizes = {"134 rows, fewer elements, 1.4 min", "134 rows, up to 48 elements"},
      .timed = false,
      .columns = columns,
      .settings = own_settings,
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .checks = judge};
  return run_experiment(experiment, argc, argv);
}
