#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/simulate/scene_run.h"

namespace tress::experiments::scene_runs {

/// The options of simulate.
struct Arguments {
  std::vector<std::string> scenes, exports, plugins;
  std::string out = "results/scenes";
  int threads = 1;
  std::size_t hairs = 0;
  double save_every = 60;
  bool resume = false, vtk = false, usd = false, hair = false, print_defaults = false,
       print_schema = false, no_guard = false, verify = false, quick = false,
       full = false, error_bars = false, check = false, gradient = false,
       frames_given = false, live = false;
  std::string progress = "auto", as = "auto", frames = "32", device = "cpu";
  int bits = 64, lanes = 0;
};

void declare(CLI::App& app, Arguments& a);
std::string help_text(const CLI::App& app);

models::HeadPack pack_of(const Arguments& a);

/// Returns the options of a run of the scene.
SceneRunOptions options_of(const std::string& scene, const Arguments& a);

/// Throws InputError if a file that the run writes, of a head or of strands, could not be
/// written.
void check_outputs(const std::string& scene, bool head, const Arguments& a);

}  // namespace tress::experiments::scene_runs
