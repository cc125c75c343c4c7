#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/files/checksum.h"
#include "simulation/files/file_state.h"
#include "simulation/files/files.h"
#include "simulation/files/run_key.h"
#include "simulation/run/failed_strand.h"

namespace tress::simulation {

/// Progress of the run of a head.
struct HeadProgress {
  std::vector<std::uint64_t> sums;  // checksums of the frames that are written
  std::size_t step = 0;             // taken towards the next one
  std::vector<FailedStrand> lost;   // in the order in which they were
  FileState frames;                 // of HeadFrames
};

/// The state of all strands on disk, with its checksum. It is written to a temporary
/// file in the same folder, which replaces the file at the end.
class SavedHead {
 public:
  /// Begins the file of a state: `kept` numbers for each of `strands` strands.
  SavedHead(const std::string& file, const RunKey& key, std::size_t strands,
            std::size_t kept, const HeadProgress& progress);
  /// Stores the data that the head keeps for the next strands.
  void put(const std::vector<double>& kept);
  /// After all strands.
  void finish();

 private:
  template <class T>
  void put_numbers(const std::vector<T>& x);
  void put_bytes(std::string_view bytes);
  std::string seal() const { return sum_.text() + ' '; }

  Replacement replacement_;
  Checksum sum_;
};

/// Reads it.
class HeadToResume {
 public:
  /// Throws InputError when the file is damaged, or of another run or other strands.
  HeadToResume(const std::string& file, const RunKey& key, std::size_t strands,
               std::size_t kept);

  /// Returns the progress of the run at that state.
  const HeadProgress& progress() const { return progress_; }
  /// Returns what the head stored for the next `strands` strands.
  std::vector<double> take(std::size_t strands);

 private:
  void parse(const RunKey& key, const std::string& file, std::size_t strands);
  template <class T>
  std::vector<T> numbers(std::size_t count);

  std::string text_;
  std::string_view rest_;
  std::size_t kept_;
  HeadProgress progress_;
};

}  // namespace tress::simulation
