#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "simulation/export/head_frames.h"
#include "simulation/export/head_state.h"
#include "simulation/files/files.h"
#include "simulation/files/locked_file.h"
#include "simulation/head/head_run.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// Files that the run of a head writes as it proceeds: frames (HeadFrames), the time
/// series <stem>.csv, failed strands <stem>.failed.csv, and the last saved state
/// <stem>.state. Only one process at a time writes them.
class HeadRecording {
 public:
  /// A new recording, or with `resume` one that goes on at its saved state. Throws
  /// InputError where a file cannot be written, is damaged or belongs to another run.
  HeadRecording(std::string stem, RunKey key, const Scene& scene, const HeadRun& run,
                StoredFrames stored, bool resume);

  const HeadProgress& progress() const { return progress_; }
  const HeadFrames& frames() const { return *frames_; }
  /// Returns the state from which the run continues, to be read once.
  std::unique_ptr<HeadToResume> take_saved() { return std::move(saved_); }

  void lose(const FailedStrand& strand) { progress_.lost.push_back(strand); }
  /// Takes a frame; add() writes it, its series and the failed strands.
  HeadFrames& frame() { return *frames_; }
  void add(const std::vector<double>& series);
  /// For the state of all strands, `step` steps after the last frame.
  std::unique_ptr<SavedHead> saving(std::size_t step);
  /// The run is complete: removes what only a resumed run needs.
  void close();

 private:
  void open(const Scene& scene, StoredFrames stored, bool resume);
  void write_lost();

  std::string stem_;
  RunKey key_;
  std::vector<std::string> columns_;
  StrandCount head_;
  std::size_t kept_;  // numbers of a strand
  LockedFile lock_;
  HeadProgress progress_;
  std::unique_ptr<HeadToResume> saved_;
  std::optional<HeadFrames> frames_;
  std::optional<File> csv_;
  std::size_t lost_written_ = 0;
};

}  // namespace tress::experiments::scene_runs
