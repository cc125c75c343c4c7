#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/files/checksum.h"
#include "simulation/files/files.h"
#include "simulation/files/locked_file.h"
#include "simulation/files/run_key.h"
#include "simulation/run/readout.h"

namespace tress::simulation {

/// Records a run to disk as it proceeds: every frame (<stem>.frames), the time series
/// (<stem>.csv) and the last saved state (<stem>.state). The state file holds its own
/// checksum and that of the frames up to it. A killed run has all frames but the current
/// one; the next run continues at the saved state.
class Recording {
 public:
  /// Starts a new recording, or with `resume` continues an existing one. Throws
  /// InputError when a file cannot be written, another process records here, or the
  /// existing files are damaged or have another key.
  Recording(std::string stem, const RunKey& key, const Readout& readout, bool resume);
  /// The state to continue from; frames() then ends with the frame of that state.
  const std::optional<Snapshot>& saved() const { return saved_; }
  /// Returns the frames so far, including those of earlier runs.
  const std::vector<Frame3d>& frames() const { return frames_; }

  /// Adds a frame and its line of the time series.
  void add(Frame3d frame);
  /// Replaces the saved state.
  void save(const Snapshot& snapshot);
  /// The run is complete: removes the files that only a resumed run needs.
  void close();

 private:
  void resume(const RunKey& key);
  std::string header() const;
  std::string series_line(const Frame3d& frame) const;
  static std::string record(const Frame3d& frame);

  std::string stem_, key_;
  LockedFile binary_;
  Checksum sum_;  // of the frames
  std::vector<Reading> columns_;
  std::size_t points_, channels_;
  std::optional<Snapshot> saved_;
  std::vector<Frame3d> frames_;
  std::optional<File> csv_;
};

}  // namespace tress::simulation
