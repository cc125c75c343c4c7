#include "experiments/simulate/arguments.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "contract/input_error.h"
#include "simulation/files/files.h"

namespace tress::experiments::scene_runs {
namespace {

constexpr const char* help_end =
    "\nExample:\n  simulate scenes/hair_under_wind.toml --vtk\n\n"
    "Writes <out>/<scene>.csv (time series), .meta.json (how it was made) and .json (for "
    "the\nreport page), with --error-bars .errors.csv (errors over time),\nwith "
    "--gradient .gradient.csv (derivatives); of a "
    "scene with rest = \"inverse\" .rest.csv\n(how each strand is held); of a batch .h5 "
    "and .xdmf\n(all frames, for ParaView and others) and .failed.csv (strands that "
    "could "
    "not be computed).\nExit codes: 0 done, 1 internal error, 2 usage or input error, 3 "
    "a "
    "scene did not run to\nits end, or failed strands, 130 interrupted (--resume "
    "continues)\n\nmpirun -n 4 simulate ... --as batch: four processes share the "
    "batch; the results are the same\n";

/// Endings of the files that a run writes in its folder, or may write.
std::vector<std::string> endings(bool head, const SceneRunOptions& options) {
  std::vector<std::string> all{".csv", ".meta.json", ".json", ".state"};
  if (head) {
    all.insert(all.end(), {".h5", ".xdmf", ".failed.csv", ".rest.csv"});
  } else {
    all.push_back(".failed.csv");
    all.insert(all.end(), {".errors.csv", ".gradient.csv", ".rest.csv", ".fit.csv"});
  }
  if (options.usd) all.push_back(".usda");
  if (options.gltf) all.push_back(".glb");
  return all;
}

}  // namespace

void declare(CLI::App& app, Arguments& a) {
  app.add_option("scenes", a.scenes, "scene files; none: all of scenes/");
  app.add_option("--out", a.out, "folder for the results (default results/scenes)");
  app.add_option("--plugin", a.plugins,
                 "shared library of further models, integrators, effects "
                 "(docs/plugins.md); repeatable")
      ->allow_extra_args(false);
  app.add_option("--threads", a.threads, "threads that share the strands (default 1)")
      ->check(CLI::Range(1, 1024));
  app.add_option("--hairs", a.hairs,
                 "hairs drawn between the strands of a groom (default 0)")
      ->check(CLI::Range(0, 100'000));
  app.add_flag("--vtk", a.vtk, ".vtp and .pvd files for ParaView, as --export vtk");
  app.add_flag("--usd", a.usd, ".usda file for Blender and Houdini, as --export usd");
  app.add_flag("--hair", a.hair, ".hair files for renderers, as --export hair");
  app.add_option(
         "--export", a.exports,
         "formats to write by name: vtk, usd, hair, or gltf (a .glb file for viewers). "
         "Of single strands they have every strand and frame. Of a batch they have at "
         "most 1000 strands and 50 frames: use its .h5, or --as strands")
      ->delimiter(',')
      ->check(CLI::IsMember({"vtk", "usd", "hair", "gltf"}));
  app.add_option("--as", a.as,
                 "way to run the strands (default auto). `strands` runs each by itself. "
                 "`batch` runs all in one, up to a "
                 "million, in SIMD lanes or as replicated systems. `auto` takes "
                 "`batch` from 1000 strands on if the model has lanes, and above "
                 "10000 strands. `cost_of_accuracy --list` prints which models have "
                 "lanes")
      ->check(CLI::IsMember({"auto", "strands", "batch"}));
  app.add_option("--precision", a.bits,
                 "floating-point precision of a batch in bits: 64 or 32 (default 64)")
      ->check(CLI::IsMember({64, 32}));
  app.add_option(
         "--simd-width", a.lanes,
         "strands per SIMD pack of a batch: 1, 4 or 8 with --precision 64, 8 or "
         "16 with --precision 32. The default is the largest: 8 and 16. The first "
         "build of ./tress simulate has 4 with --precision 64 only, and a build of "
         "./tress test has 1, 4 and 8. Results are bitwise identical")
      ->check(CLI::IsMember({1, 4, 8, 16}));
  app.add_option("--device", a.device,
                 "device for the time steps of a batch: cpu, gpu or auto (default "
                 "cpu). `auto` takes gpu if there is one and the scene has gravity "
                 "and drag only")
      ->check(CLI::IsMember({"cpu", "gpu", "auto"}));
  app.add_option("--frames", a.frames,
                 "bits of a coordinate in a batch's .h5: 32, 64, or none (default 32)")
      ->check(CLI::IsMember({"32", "64", "none"}))
      ->each([&a](const std::string& word) { a.frames_given = word != "none"; });
  app.add_flag("--resume", a.resume, "continue an interrupted run");
  app.add_option(
         "--save-every", a.save_every,
         "seconds of the clock after which a scene without checkpoint_s saves its "
         "state (default 60)")
      ->check(CLI::Range(0.0, 86400.0))
      ->check([](const std::string& text) {
        return std::isnan(std::strtod(text.c_str(), nullptr))
                   ? text + " is not a number: give seconds, as 60"
                   : std::string();
      });
  app.add_flag("--no-guard", a.no_guard,
               "continue after the guard reports an unphysical state (as guard = false)");
  app.add_flag("--error-bars", a.error_bars,
               "estimate time and space errors from runs with finer steps and twice the "
               "elements. The bounds held in 90 % of calibration runs of six clamped "
               "hairs");
  app.add_flag("--gradient", a.gradient,
               "derivatives of the motion by the numbers that the scene's [gradient] "
               "names (.gradient.csv)");
  app.add_flag("--verify", a.verify, "error in time alone, with a tolerance");
  app.add_option("--progress", a.progress, "auto, none or json (default auto)")
      ->check(CLI::IsMember({"auto", "none", "json"}));
  app.add_flag("--print-defaults", a.print_defaults,
               "print a short scene to start from (scenes/README.md: every key)");
  app.add_flag("--print-schema", a.print_schema, "print the page scenes/README.md");
  app.add_flag("--live", a.live,
               "step one scene under commands from standard input, one JSON object a "
               "line, and answer each with a picture (./tress play); writes no files");
  app.add_flag("--check", a.check, "check scenes and outputs; run nothing");
  for (auto& [option, flag] : {std::pair<const char*, bool*>{"--quick", &a.quick},
                               std::pair<const char*, bool*>{"--full", &a.full}}) {
    app.add_flag(option, *flag, "accepted for ./tress run, without effect")->group("");
  }
}

std::string help_text(const CLI::App& app) {
  std::string help = app.help();
  help.erase(help.find_last_not_of('\n') + 1);
  return help + '\n' + help_end;
}

models::HeadPack pack_of(const Arguments& a) {
  models::HeadPack pack = models::longest_pack(
      a.bits == 64 ? models::HeadNumber::float64 : models::HeadNumber::float32);
  if (a.lanes != 0) pack.lanes = a.lanes;
  return pack;
}

SceneRunOptions options_of(const std::string& scene, const Arguments& a) {
  SceneRunOptions options;
  options.stem = a.out + "/" + scene;
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
  options.pack = pack_of(a);
  options.device = device_choice(a.device);
  options.frame_bits = a.frames == "none" ? 0 : std::stoi(a.frames);
  return options;
}

void check_outputs(const std::string& scene, bool head, const Arguments& a) {
  const SceneRunOptions options = options_of(scene, a);
  for (const std::string& ending : endings(head, options)) {
    check_output(options.stem + ending);
  }
  for (const auto& [wanted, ending] :
       {std::pair{options.vtk, "_vtk"}, std::pair{options.hair, "_hair"}}) {
    const std::string folder = options.stem + ending;
    std::error_code ignored;
    refuse_if(wanted && std::filesystem::exists(folder, ignored) &&
                  !std::filesystem::is_directory(folder, ignored),
              "the output is not a folder", "--out " + folder,
              "move it away, or give another --out");
  }
}

}  // namespace tress::experiments::scene_runs
