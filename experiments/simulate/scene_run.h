#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/command_line.h"
#include "experiments/run/interruption.h"
#include "experiments/run/progress.h"
#include "models/head/head.h"
#include "simulation/files/run_key.h"
#include "simulation/head/head_device.h"
#include "simulation/head/ranks.h"
#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

/// A channel that is not read from the run itself.
struct FurtherChannel {
  Reading reading;
  std::vector<std::vector<float>> frames;  // of each the material points
};

struct SceneRunOptions {
  std::string stem;  // of all files: <stem>.csv, <stem>.json ...
  int threads = 1;
  bool resume = false;
  double save_every = 60;  // s of the clock, without checkpoint_s
  std::size_t hairs = 0;   // drawn between the strands, in .json and .usda
  bool vtk = false;        // <stem>_vtk/: .vtp for every frame and .pvd
  bool usd = false;        // <stem>.usda
  bool hair = false;       // <stem>_hair/: .hair for every frame
  bool gltf = false;       // <stem>.glb
  ProgressMode progress = ProgressMode::automatic;
  Heartbeat* heartbeat = nullptr;
  /// Asked once the run has come to its end, before pictures are written.
  std::function<std::vector<FurtherChannel>()> further;
  // Of a head.
  models::HeadPack pack = {};
  DeviceChoice device = DeviceChoice::cpu;
  Ranks* ranks = nullptr;  // that share it
  int frame_bits = 32;  // of a coordinate in <stem>.h5; 0: frames only of shown strands
};

inline int bits_of(const models::HeadPack& pack) {
  return pack.number == models::HeadNumber::float64 ? 64 : 32;
}

/// Outcome of a run of a head.
struct HeadOutcome {
  models::HeadPack pack;
  std::string engine;          // lanes or replicated: what steps the strands
  std::string device = "cpu";  // that took its steps, or the name of another one
  int ranks = 1;
  // Of the rank that has most: strands, memory at its largest.
  std::size_t rank_strands = 0;
  double peak_memory_mb = 0, ghosts_per_step = 0, sent_per_step = 0, claims_per_step = 0;
  // Of a step, s, the same.
  double claim_s = 0, exchange_s = 0, meet_s = 0;
  std::size_t strands, lost;
  std::size_t shown_strands, shown_frames;  // of pictures
  double bytes_per_strand;
  std::string state;  // checksum of all strands' states at the end
  // Wall time of the parts, s.
  double build_s = 0, step_s = 0, read_s = 0, write_s = 0;
};

struct SceneRun {
  enum class End { complete, failed };
  End end;
  std::string reason;  // of a failure
  std::size_t frames;
  long rejected;  // steps repeated with shorter ones
  double wall_s, simulated_s;
  double indicator = 0;  // largest World::error_indicator
  Stats work = {};       // since this run began or was resumed
  bool resumed = false;
  Exchanges exchanges = {};
  std::optional<MethodDissipation> dissipation = {};  // World::dissipation() at the end
  Excess excess = {};                                 // energy that no work explains
  std::string no_dissipation = {};                    // why it is empty
  std::string not_smooth = {};               // World::not_smooth(), first that was seen
  std::optional<StrandPassage> passed = {};  // World::passed(), first that was seen
  std::size_t lost = 0;                      // strands that failed and stay
  std::optional<HeadOutcome> head = {};
  std::vector<NamedLoad> supports = {};  // their loads in the last frame
  double support_force = 0;              // N, largest in a frame
};

/// Runs a scene and writes series, pictures, and during the run the states from which a
/// later run can continue (see Recording). `key` identifies the run. Pictures of all
/// frames are written at the end.
///
/// A scene with checkpoint_s is rebuilt from every state that it saves, in
/// uninterrupted and in resumed runs: both give bitwise equal numbers. Without
/// checkpoint_s the state of the last frame is saved by the clock, and by
/// `interruption`; multistep integrators restart there, so that both agree within their
/// accuracy.
SceneRun run_scene(const Scene& scene, const RunKey& key, const SceneRunOptions& options,
                   Interruption& interruption);

}  // namespace tress::experiments::scene_runs
