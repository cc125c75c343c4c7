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

/// A run on disk while it goes on: every frame (<stem>.frames), the time series
/// (<stem>.csv) and the last saved state (<stem>.state), which holds the checksum of the
/// frames up to it and its own. A run that was killed has all frames but the one that it
/// was at; the next one continues at the saved state.
class Recording {
 public:
  /// Starts afresh, or with `resume` continues what is there. Throws InputError when a
  /// file cannot be written, another process records here, or what is there is damaged or
  /// of a run with another key.
  Recording(std::string stem, const RunKey& key, const Readout& readout, bool resume);
  /// What to continue from; frames() then ends with the frame of that state.
  const std::optional<Snapshot>& saved() const { return saved_; }
  const std::vector<Frame3d>& frames() const { return frames_; }

  void add(Frame3d frame);
  void save(const Snapshot& snapshot);
  /// The run is complete: removes what only a resumed one needs.
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
