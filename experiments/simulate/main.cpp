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
#include "experiments/run/exit_code.h"
#include "experiments/run/manifest.h"
#include "experiments/run/message.h"
#include "experiments/simulate/head_room.h"
#include "experiments/simulate/head_scene_run.h"
#include "experiments/simulate/held_report.h"
#include "experiments/simulate/outcome.h"
#include "experiments/simulate/rank_failures.h"
#include "experiments/simulate/scene_run.h"
#include "integrators/error_indicator.h"
#include "simulation/errors/error_bars.h"
#include "simulation/files/files.h"
#include "simulation/groom/fitted_groom.h"
#include "simulation/head/head_classes.h"
#include "simulation/head/ranks.h"
#include "simulation/head/scene_head.h"
#include "simulation/plugin/load_plugin.h"
#include "simulation/scene/schema.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::scene_runs {
namespace {

struct Arguments {
  std::vector<std::string> scenes, exports, plugins;
  std::string out = "results/scenes";
  int threads = 1;
  std::size_t hairs = 0;
  double save_every = 60;
  bool resume = false, vtk = false, usd = false, hair = false, print_defaults = false,
       print_schema = false, no_guard = false, verify = false, quick = false,
       full = false, error_bars = false;
  std::string progress = "auto", as = "auto", frames = "32", device = "cpu";
  int bits = 64, lanes = 0;
};

constexpr const char* help_end =
    "\nExample:\n  simulate scenes/hair_under_wind.toml --vtk\n\n"
    "Writes <out>/<scene>.csv (time series), .meta.json (how it was made) and .json (for "
    "the\nreport page), with --error-bars .errors.csv (errors over time); of a "
    "scene with rest = \"inverse\" .rest.csv\n(how each strand is held); of a head .h5 "
    "and .xdmf\n(all frames, for ParaView and others) and .lost.csv (strands that could "
    "not be computed).\nExit codes: 0 done, 1 internal error, 2 usage or input error, 3 "
    "a "
    "scene did not run to\nits end, or lost strands, 130 interrupted (--resume "
    "continues)\n\nmpirun -n 4 simulate ... --as head: four processes share the "
    "head; the results are the same\n";

void declare(CLI::App& app, Arguments& a) {
  app.add_option("scenes", a.scenes, "scene files; none: all of scenes/");
  app.add_option("--out", a.out, "folder for the results (default results/scenes)");
  app.add_option("--plugin", a.plugins,
                 "shared library of further models, integrators, effects "
                 "(docs/plugins.md); again for another")
      ->allow_extra_args(false);
  app.add_option("--threads", a.threads, "threads that share the strands (default 1)")
      ->check(CLI::Range(1, 1024));
  app.add_option("--hairs", a.hairs,
                 "hairs drawn between the strands of a groom (default 0)")
      ->check(CLI::Range(0, 100'000));
  app.add_flag("--vtk", a.vtk, "also .vtp and .pvd files, for ParaView");
  app.add_flag("--usd", a.usd, "also a .usda file, for Blender and Houdini");
  app.add_flag("--hair", a.hair, "also .hair files, one a frame, for renderers");
  app.add_option("--export", a.exports,
                 "the same by name, or gltf, a .glb file for viewers: vtk,usd,hair,gltf")
      ->delimiter(',')
      ->check(CLI::IsMember({"vtk", "usd", "hair", "gltf"}));
  app.add_option("--as", a.as,
                 "strands: one by one; head: all side by side, up to a million; auto: a "
                 "head, where the scene can be one and has 1000 strands (default auto)")
      ->check(CLI::IsMember({"auto", "strands", "head"}));
  app.add_option("--bits", a.bits, "of a head's numbers: 64 or 32 (default 64)")
      ->check(CLI::IsMember({64, 32}));
  app.add_option("--lanes", a.lanes,
                 "strands of a head side by side: 1, 4, 8 of 64 bits, 8, 16 of 32 "
                 "(default 8, 16); results are the same bits")
      ->check(CLI::IsMember({1, 4, 8, 16}));
  app.add_option("--device", a.device,
                 "that takes a head's steps: cpu; gpu; auto: gpu where there is one and "
                 "the scene has gravity and drag only (default cpu)")
      ->check(CLI::IsMember({"cpu", "gpu", "auto"}));
  app.add_option("--frames", a.frames,
                 "bits of a coordinate in a head's .h5: 32, 64, or none (default 32)")
      ->check(CLI::IsMember({"32", "64", "none"}));
  app.add_flag("--resume", a.resume, "continue an interrupted run");
  app.add_option(
         "--save-every", a.save_every,
         "seconds of the clock after which a scene without checkpoint_s saves its "
         "state (default 60)")
      ->check(CLI::Range(0.0, 86400.0));
  app.add_flag("--no-guard", a.no_guard,
               "go on where a run does what physics rules out (as guard = false)");
  app.add_flag("--error-bars", a.error_bars,
               "also run finer in time and with twice the elements: the errors of both");
  app.add_flag("--verify", a.verify, "with a tolerance: the error in time alone");
  app.add_option("--progress", a.progress, "auto, none or json (default auto)")
      ->check(CLI::IsMember({"auto", "none", "json"}));
  app.add_flag("--print-defaults", a.print_defaults,
               "print a short scene to start from (scenes/README.md: every key)");
  app.add_flag("--print-schema", a.print_schema, "print the page scenes/README.md");
  app.add_flag("--quick", a.quick, "no difference here: scenes say how long they are");
  app.add_flag("--full", a.full, "the same");
}

std::vector<std::string> all_scenes() {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("scenes", error)) {
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

models::HeadPack pack_of(const Arguments& a) {
  const bool wide = a.bits == 64;
  return {wide ? models::HeadNumber::float64 : models::HeadNumber::float32, a.lanes != 0
                                                                                ? a.lanes
                                                                            : wide ? 8
                                                                                   : 16};
}

/// What speaks against a head: the scene, or what is asked for.
std::optional<NoHead> no_head(const SceneOutline& outline, const Arguments& a) {
  const char* option = a.hairs > 0    ? "--hairs"
                       : a.verify     ? "--verify"
                       : a.error_bars ? "--error-bars"
                                      : nullptr;
  if (option != nullptr) {
    return NoHead{std::string(option) + " is not for a head of hair",
                  "leave it out, or give --as strands with fewer strands"};
  }
  if (has_classes(outline)) {
    if (auto no = no_classes(outline)) return no;
  }
  return simulation::no_head(outline, pack_of(a).number);
}

/// One head for each number of elements, said on standard error.
std::vector<Job> heads_of(const Job& job, const Arguments& a) {
  if (!job.head || !has_classes(job.outline)) return {job};
  std::vector<Job> jobs;
  std::string list;
  for (HeadClass& one : head_classes(job.outline, a.threads)) {
    list += fmt::format("{}{} of {} elements", list.empty() ? "" : ", ",
                        one.outline.series->size(), one.elements);
    jobs.push_back({job.file, std::move(one.outline), true, one.elements});
  }
  tell("simulate: {}: heads of equal elements: strands {}\n", job.outline.scene.name,
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
  job.head = a.as == "head" || (a.as == "auto" && strands >= many && !no);
  if (a.as == "head" && no) throw InputError(no->reason, file, no->remedy);
  if (a.as == "auto" && no && strands > held_at_once.strands) {
    throw InputError(
        fmt::format("{} strands are too many to run one by one (at most {}), "
                    "and not a head: {}",
                    strands, held_at_once.strands, no->reason),
        file, no->remedy);
  }
  if (!job.head && a.device == "gpu") {
    throw InputError("a device steps heads of hair only, and this runs strand by strand",
                     file, "give --as head, or --device cpu");
  }
  if (!job.head && a.bits != 64) {
    throw InputError("32 bits are for heads of hair, and this runs strand by strand" +
                         (no ? ": " + no->reason : std::string()),
                     file, no ? no->remedy : "give --as head, or --bits 64");
  }
  if (!job.head && ranks.size() > 1) {
    throw InputError("strands that run one by one are not shared by ranks", file,
                     "leave out mpirun, or give --as head");
  }
  if (job.head) return job;
  job.outline.scene = read_scene(file);
  if (a.verify) check_verifiable(job.outline.scene);
  return job;
}

/// Says how near strands are to the files they come from, and writes that table.
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

/// False: the scene did not run to its end.
bool run_job(const Job& job, const Arguments& a, const CommandLine& line, Ranks& ranks,
             Interruption& interruption) {
  const std::string& file = job.file;
  SceneOutline outline = job.outline;
  Scene& scene = outline.scene;
  if (a.no_guard) scene.guard = false;
  SceneRunOptions options;
  options.stem = a.out + "/" + scene.name;
  options.threads = a.threads;
  options.resume = a.resume;
  options.save_every = a.save_every;
  options.hairs = a.hairs;
  const auto exports = [&a](bool flag, std::string_view name) {
    return flag || std::ranges::count(a.exports, name) > 0;
  };
  options.vtk = exports(a.vtk, "vtk");
  options.usd = exports(a.usd, "usd");
  options.hair = exports(a.hair, "hair");
  options.gltf = exports(false, "gltf");
  options.progress = line.progress;
  options.pack = pack_of(a);
  options.device = device_choice(a.device);
  options.frame_bits = a.frames == "none" ? 0 : std::stoi(a.frames);
  options.ranks = &ranks;
  std::error_code ignored;  // what a run before has left would only mislead
  for (const char* ending : {".errors.csv", ".h5", ".xdmf", ".lost.csv", ".rest.csv"}) {
    if (job.head && ending != std::string_view(".errors.csv")) continue;
    if (!ranks.first()) continue;
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
    options.further = [&] { return errors.estimate(scene, a); };
  }
  RunKey key;
  key.add("scene", contents_checksum({file}));
  key.add("plug-ins", plugins_text());
  if (job.elements > 0) key.add("elements", std::to_string(job.elements));
  if (job.head) check_room(job.outline, options);
  if (ranks.first()) tell_fits(scene, options.stem);
  Manifest manifest(experiment, line);
  manifest.add_input(file, read_file(file));
  const SceneRun run = job.head ? run_head(outline, key, options, interruption)
                                : run_scene(scene, key, options, interruption);
  Row row = outcome(scene, run);
  if (tried) set_pilot(*tried, row);
  bool complete = run.end != SceneRun::End::failed;
  if (!ranks.first()) return complete;
  tell("simulate: {}: {} frames, {:.3g} s simulated in {:.3g} s{}{}{} -> {}.csv\n",
       scene.name, run.frames, run.simulated_s, run.wall_s, control_in_words(scene, run),
       complete ? "" : "; ", run.reason, options.stem);
  if (complete) complete = errors.report(scene, options.stem, row);
  manifest.set_outcome(row);
  replace_file(options.stem + ".meta.json", manifest.finished({row}, {}, 0));
  if (run.indicator > unresolved) {
    tell(
        "simulate: warning: {}: {} did not resolve the motion (one step was wrong by "
        "{:.2g} of an unknown's scale, by its own indicator): take a shorter dt_s, or "
        "an integrator that iterates such as implicit_midpoint\n",
        scene.name, scene.integrator, run.indicator);
  }
  return complete;
}

int run_scenes(const Arguments& a, const CommandLine& line, Ranks& ranks,
               Interruption& interruption) {
  const std::vector<std::string> files = a.scenes.empty() ? all_scenes() : a.scenes;
  static_cast<void>(models::helix_head({}, pack_of(a)));  // refuses other lanes
  std::vector<Job> jobs;
  std::set<std::string> names;
  for (const std::string& file : files) {
    jobs.push_back(job_of(file, a, ranks));
    if (names.insert(jobs.back().outline.scene.name).second) continue;
    throw InputError("two scenes of one name", file,
                     "rename one of them, or run it with another --out");
  }
  ready_folder(a.out, "--out " + a.out);
  bool complete = true;
  for (const Job& whole : jobs) {
    for (const Job& job : heads_of(whole, a)) {
      complete = run_job(job, a, line, ranks, interruption) && complete;
    }
  }
  return complete ? done : rows_failed;
}

int run(const Arguments& a, CommandLine line) {
  if (a.print_defaults || a.print_schema) {
    write_all(1, a.print_defaults ? scene_defaults() : scene_schema(), "standard output");
    return done;
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
  CLI::App app{"simulate: What does a scene do?"};
  Arguments a;
  declare(app, a);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    throw Answer(app.help() + help_end);
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what(), "command line", "simulate --help shows the options");
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
