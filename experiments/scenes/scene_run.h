#pragma once

#include <csignal>
#include <functional>
#include <string>

#include "experiments/harness/command_line.h"
#include "experiments/scenes/scene.h"

namespace tress {

struct SceneRunOptions {
  std::string stem;  // of all files: <stem>.csv, <stem>.json ...
  int threads = 1;
  bool resume = false;
  std::size_t hairs = 0;  // between the strands, in .json and .usda
  bool vtk = false;       // <stem>_vtk/: .vtp for every frame and .pvd
  bool usd = false;       // <stem>.usda
  ProgressMode progress = ProgressMode::automatic;
};

struct SceneRun {
  enum class End { complete, failed, interrupted };
  End end;
  std::string reason;  // of a failure
  std::size_t frames;
  double wall_s, simulated_s;
};

/// Runs a scene and writes what it does: series, pictures, and while it goes on what a
/// later run continues from (see Recording). `key` names the run among others. Once
/// `stop` is set it ends after the frame at hand with valid files.
///
/// At every saved state the scene is built anew from it, in a run that goes through as in
/// one that continues: both give the same numbers, bit by bit.
SceneRun run_scene(const Scene& scene, const std::string& key,
                   const SceneRunOptions& options,
                   const volatile std::sig_atomic_t& stop);

}  // namespace tress
