// Runs scenes and writes the results, for people and for other programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "contract/input_error.h"
#include "contract/shipped_file.h"
#include "experiments/run/command_line.h"
#include "experiments/run/exit_code.h"
#include "experiments/run/manifest.h"
#include "experiments/run/message.h"
#include "experiments/simulate/arguments.h"
#include "experiments/simulate/gradient_report.h"
#include "experiments/simulate/head_room.h"
#include "experiments/simulate/head_scene_run.h"
#include "experiments/simulate/held_report.h"
#include "experiments/simulate/live/live_run.h"
#include "experiments/simulate/outcome.h"
#include "experiments/simulate/rank_failures.h"
#include "experiments/simulate/scene_run.h"
#include "experiments/simulate/warnings.h"
#include "integrators/error_indicator.h"
#include "models/effects/body.h"
#include "simulation/errors/error_bars.h"
#include "simulation/files/build_facts.h"
#include "simulation/files/files.h"
#include "simulation/gradient/scene_gradient.h"
#include "simulation/groom/fitted_groom.h"
#include "simulation/head/head_classes.h"
#include "simulation/head/ranks.h"
#include "simulation/head/scene_head.h"
#include "simulation/plugin/load_plugin.h"
#include "simulation/run/world.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_text/schema.h"

namespace tress::experiments::scene_runs {
namespace {

std::vector<std::string> all_scenes() {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator(shipped_file("scenes"), error)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  }
  std::ranges::sort(files);
  if (files.empty()) {
    throw InputError("no scene to run", "command line",
                     "name scene files, or run where a folder scenes/ is");
  }
  return files;
}

const Experiment experiment{.name = "simulate",
                            .question = "What does a scene do?",
                            .example = "scenes/hair_under_wind.toml --vtk",
                            .columns = outcome_columns(),
                            .cases = {}};

/// What was asked for of the errors of a run.
struct Errors {
  std::optional<ErrorBar> time, space;

  /// Also as channels for pictures, where there is an estimate.
  std::vector<FurtherChannel> estimate(const Scene& scene, const Arguments& a) {
    time = time_error(scene, a.threads);
    if (a.error_bars) space = space_error(scene, a.threads);
    std::vector<FurtherChannel> channels;
    for (const auto& [part, bar] :
         {std::pair{"time", &time}, std::pair{"space", &space}}) {
      if (!*bar || (*bar)->points.empty()) continue;
      channels.push_back(
          {{fmt::format("error in {}", part), "of the length"}, (*bar)->points});
    }
    return channels;
  }

  /// Tells them and writes those over time; false: a run did not come to its end.
  bool report(const Scene& scene, const std::string& stem, Row& row) const {
    bool finished = true;
    for (const auto& [part, bar] :
         {std::pair{"time", &time}, std::pair{"space", &space}}) {
      if (!*bar) continue;
      tell("simulate: {}: {}\n", scene.name, in_words(part, **bar, scene));
      set_errors(part, **bar, row);
      finished = finished && !(*bar)->unfinished;
    }
    if (space) replace_file(stem + ".errors.csv", errors_csv(scene, *time, *space));
    return finished;
  }
};

/// One scene and what it runs as.
struct Job {
  std::string file;
  SceneOutline outline;  // unless it is a head, the whole scene
  bool head = false;
  int elements = 0;  // of a head that is one of several of the scene
};

/// Returns the reason against a head: the scene, or an option.
std::optional<NoHead> no_head(const SceneOutline& outline, const Arguments& a) {
  const char* option = a.hairs > 0    ? "--hairs"
                       : a.verify     ? "--verify"
                       : a.error_bars ? "--error-bars"
                       : a.gradient   ? "--gradient"
                                      : nullptr;
  if (option != nullptr) {
    return NoHead{std::string(option) + " cannot be combined with --as batch",
                  "leave it out, or give --as strands with fewer strands"};
  }
  if (has_classes(outline)) {
    if (auto no = no_classes(outline)) return no;
  }
  return simulation::no_head(outline, pack_of(a).number);
}

/// One batch for each number of elements, said on standard error.
std::vector<Job> heads_of(const Job& job, const Arguments& a) {
  if (!job.head || !has_classes(job.outline)) return {job};
  std::vector<Job> jobs;
  std::string list;
  for (HeadClass& one : head_classes(job.outline, a.threads)) {
    list += fmt::format("{}{} of {} elements", list.empty() ? "" : ", ",
                        one.outline.series->size(), one.elements);
    jobs.push_back({job.file, std::move(one.outline), true, one.elements});
  }
  tell("simulate: {}: batches of equal elements: strands {}\n", job.outline.scene.name,
       list);
  return jobs;
}

/// Throws InputError if the scene cannot run as asked for.
Job job_of(const std::string& file, const Arguments& a, const Ranks& ranks) {
  constexpr std::size_t many = 1000;
  Job job{file, read_outline(file)};
  const std::size_t strands =
      job.outline.series == nullptr ? 0 : job.outline.series->size();
  const std::optional<NoHead> no = no_head(job.outline, a);
  // Strands one by one are as fast as replicated systems, and say more.
  const bool faster =
      strands > held_at_once.strands ||
      (strands >= many && !no_lanes(job.outline.scene, pack_of(a).number));
  job.head = a.as == "batch" || (a.as == "auto" && faster && !no);
  if (a.as == "batch" && no)
    throw InputError(no->reason, place_of(*no, file), no->remedy);
  if (a.as == "auto" && no && strands > held_at_once.strands) {
    throw InputError(
        fmt::format("{} strands are too many to run one by one (at most {}), "
                    "and not as a batch: {}",
                    strands, held_at_once.strands, no->reason),
        place_of(*no, file), no->remedy);
  }
  if (!job.head && a.device == "gpu") {
    throw InputError("--device gpu requires --as batch", file,
                     "give --as batch, or --device cpu");
  }
  if (!job.head && a.bits != 64) {
    throw InputError("single precision is for batches, and this runs strand by strand" +
                         (no ? ": " + no->reason : std::string()),
                     no ? place_of(*no, file) : file,
                     no ? no->remedy : "give --as batch, or --precision 64");
  }
  if (!job.head && a.frames_given) {
    throw InputError(
        "--frames is for the .h5 of a batch, and this runs strand by strand" +
            (no ? ": " + no->reason : std::string()),
        no ? place_of(*no, file) : file,
        no ? no->remedy : "give --as batch, or leave out --frames");
  }
  if (!job.head && ranks.size() > 1) {
    throw InputError("strands that run one by one are not shared by ranks", file,
                     "leave out mpirun, or give --as batch");
  }
  if (job.head) return job;
  job.outline.scene = read_scene(file);
  if (a.verify) check_verifiable(job.outline.scene);
  if (a.error_bars) check_error_bars(job.outline.scene);
  if (a.gradient) {
    check_gradient(job.outline.scene);
    check_gradient_table(job.outline.scene);
  }
  return job;
}

/// Prints the notes on strands that come from files, and writes the table of their
/// distances.
void tell_fits(const Scene& scene, const std::string& stem) {
  if (scene.fitted.empty()) return;
  for (const auto& groom : scene.fitted) {
    for (const std::string& note : groom->notes) {
      tell("simulate: {}: {}: {}\n", scene.name,
           std::filesystem::path(groom->file).filename().string(), note);
    }
  }
  replace_file(stem + ".fit.csv", fit_csv(scene.fitted));
}

/// Prints how far the grids of meshes are true to them.
void tell_surfaces(const Scene& scene) {
  const std::vector<std::string> names = effect_names(scene);
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    const Parameters& given = scene.effects[i].parameters;
    if (!given.knows("mesh_file")) continue;
    const std::string words = models::surface_in_words(given);
    if (words.empty()) continue;
    tell("simulate: {}: {}: {}\n", scene.name, names[i], words);
  }
}

/// False: the scene did not run to its end.
bool run_job(const Job& job, const Arguments& a, const CommandLine& line, Ranks& ranks,
             Interruption& interruption, Heartbeat& heartbeat) {
  const std::string& file = job.file;
  SceneOutline outline = job.outline;
  Scene& scene = outline.scene;
  if (a.no_guard) scene.guard = false;
  SceneRunOptions options = options_of(scene.name, a);
  options.progress = line.progress;
  options.ranks = &ranks;
  options.heartbeat = &heartbeat;
  heartbeat.doing(scene.name + ": preparing its run");
  std::error_code ignored;
  const bool goes_on =
      a.resume && std::filesystem::exists(options.stem + ".state", ignored);
  // What a run before has left would only mislead; a saved one is checked first.
  for (const char* ending :
       {".errors.csv", ".gradient.csv", ".h5", ".xdmf", ".failed.csv", ".rest.csv"}) {
    const std::string_view what = ending;
    const bool of_strands = what == ".errors.csv" || what == ".gradient.csv";
    if (job.head && !of_strands && what != ".rest.csv") continue;
    if (!ranks.first() || goes_on) continue;
    std::filesystem::remove(options.stem + ending, ignored);
  }
  std::optional<Pilot> tried;
  if (!job.head) {
    if (wants_pilot(scene)) {
      tried = pilot(scene, a.threads);
      scene = tried->scene;
      tell("simulate: {}: {}\n", scene.name, in_words(*tried));
    }
    scene = without_falling(std::move(scene), options.stem + ".rest.csv", a.threads);
  }
  Errors errors;
  if (a.verify || a.error_bars) {
    options.further = [&] {
      heartbeat.doing(scene.name + ": running it again for its errors");
      return errors.estimate(scene, a);
    };
  }
  RunKey key;
  key.add("scene", contents_checksum({file}));
  key.add("way to run", job.head ? "batch" : "strands");
  key.add("guard", scene.guard ? "on" : "off");
  key.add("plug-ins", plugins_text());
  if (job.elements > 0) key.add("elements", std::to_string(job.elements));
  if (job.head) check_room(job.outline, options);
  if (ranks.first()) tell_fits(scene, options.stem);
  if (ranks.first()) tell_surfaces(scene);
  Manifest manifest(experiment, line);
  manifest.add_input(file, read_file(file));
  const SceneRun run = job.head ? run_head(outline, key, options, interruption)
                                : run_scene(scene, key, options, interruption);
  Row row = outcome(scene, run);
  if (tried) set_pilot(*tried, row);
  bool complete = run.end != SceneRun::End::failed;
  if (!ranks.first()) return complete;
  const bool came_to_its_end = complete;
  if (complete) complete = errors.report(scene, options.stem, row);
  if (came_to_its_end && a.gradient) {
    heartbeat.doing(scene.name + ": running it again for its gradient");
    complete = report_gradient(scene, options.stem + ".gradient.csv") && complete;
  }
  manifest.set_outcome(row);
  replace_file(options.stem + ".meta.json", manifest.finished({row}, {}, 0));
  // Last: all that it says is done is on the disk.
  tell("simulate: {}: {} frame{}, {:.3g} s simulated in {:.3g} s{}{}{}{} -> {}.csv\n",
       scene.name, run.frames, run.frames == 1 ? "" : "s", run.simulated_s, run.wall_s,
       control_in_words(scene, run), pictures_in_words(run), came_to_its_end ? "" : "; ",
       run.reason, options.stem);
  if (!run.supports.empty()) {
    tell("simulate: {}: forces and moments of {} at {:.9g} s: {}\n", scene.name,
         !simulation::SceneJoints(scene).any() ? "supports on their strands"
         : simulation::SceneSupports(scene).any()
             ? "supports on their strands and joints on their ends b"
             : "joints on their ends b",
         scene.time_of(run.frames - 1), supports_in_words(run));
  }
  for (const std::string& warning : warnings(scene, run)) {
    tell("simulate: warning: {}: {}\n", scene.name, warning);
  }
  if (run.indicator > unresolved) {
    tell(
        "simulate: warning: {}: {} did not resolve the motion (one step was wrong by "
        "{:.2g} of an unknown's scale, by its own indicator): take a shorter dt_s, or "
        "an integrator that iterates such as implicit_midpoint\n",
        scene.name, scene.integrator, run.indicator);
  }
  return complete;
}

/// Refuses what only the strands at t = 0 show, such as joints whose points are apart.
void check_start(const Job& job) {
  if (!job.head) static_cast<void>(simulation::World(job.outline.scene));
}

int run_scenes(const Arguments& a, const CommandLine& line, Ranks& ranks,
               Interruption& interruption) {
  const std::vector<std::string> files = a.scenes.empty() ? all_scenes() : a.scenes;
  static_cast<void>(simulation::helix_head({}, pack_of(a)));  // refuses other lanes
  Heartbeat heartbeat(ranks.first() ? line.progress : ProgressMode::none, "simulate");
  std::vector<Job> jobs;
  std::set<std::string> names;
  for (const std::string& file : files) {
    heartbeat.doing("reading " + file);
    jobs.push_back(job_of(file, a, ranks));
    if (names.insert(jobs.back().outline.scene.name).second) continue;
    throw InputError("two scenes of one name", file,
                     "rename one of them, or run it with another --out");
  }
  const ReadyFolder folder(a.out, "--out " + a.out);
  for (const Job& job : jobs) check_outputs(job.outline.scene.name, job.head, a);
  if (a.check) {
    for (const Job& job : jobs) check_start(job);
    return done;
  }
  bool complete = true;
  for (const Job& whole : jobs) {
    for (const Job& job : heads_of(whole, a)) {
      complete = run_job(job, a, line, ranks, interruption, heartbeat) && complete;
    }
  }
  return complete ? done : rows_failed;
}

int run(const Arguments& a, CommandLine line) {
  if (a.print_defaults || a.print_schema) {
    write_all(1, a.print_defaults ? scene_defaults() : scene_schema(), "standard output");
    return done;
  }
  if (a.live) {
    refuse_if(a.scenes.size() != 1, "--live is for one scene", "command line",
              "name one scene file");
    return run_live(a.scenes.front(), a.threads, !a.no_guard);
  }
  line.progress = a.progress == "none"   ? ProgressMode::none
                  : a.progress == "json" ? ProgressMode::json
                                         : ProgressMode::automatic;
  // Before the threads of MPI, and of anything else.
  Interruption interruption("simulate");
  const std::unique_ptr<Ranks> ranks = ranks_of_job();
  return exit_code_of_ranks(*ranks, interruption,
                            [&] { return run_scenes(a, line, *ranks, interruption); });
}

int answer(int argc, char** argv) {
  CLI::App app{"simulate: what does a scene do?", "simulate"};
  Arguments a;
  declare(app, a);
  app.set_version_flag("--version", build_facts().described("simulate"));
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    throw Answer(help_text(app));
  } catch (const CLI::CallForVersion& version) {
    throw Answer(version.what());
  } catch (const CLI::ParseError& error) {
    refuse_arguments(app, "simulate", argc, argv, error);
  }
  CommandLine line;
  line.argv.assign(argv, argv + argc);
  for (const std::string& plugin : a.plugins) load_plugin(plugin);
  return run(a, std::move(line));
}

}  // namespace
}  // namespace tress::experiments::scene_runs

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::scene_runs;
  return exit_code("simulate", [&] { return answer(argc, argv); });
}
