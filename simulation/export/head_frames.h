#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "simulation/export/hdf5_file.h"
#include "simulation/scene/scene.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {

/// Numbers of strands and points of a head.
struct StrandCount {
  std::size_t strands, points;  // points: of a strand
};

/// Data stored for every frame of a head.
struct StoredFrames {
  int bits = 32;                     // of a coordinate: 64, 32; 0: none of all strands
  std::vector<std::size_t> shown;    // strands for pictures, ascending
  std::vector<std::string> columns;  // of the series, the first of which is the time
};

/// Frames of a batch on disk, <stem>.h5:
///
///     positions/000000 ... (strands points, 3), m, one for each frame
///     connectivity (strands, points)   series (frames, columns)
///     shown/positions (frames, shown points, 3), shown/strands
///
/// and their description for ParaView as polylines, <stem>.xdmf. ParaView's readers of
/// XDMF 2 and 3 agree on whole datasets only, so each frame is one dataset. A crew
/// shuffles and compresses the strands, one or two thousand per chunk. A frame is in the
/// file once written. Memory: one compressed frame. A killed run leaves the frames before
/// the one that it was writing. If it was killed while HDF5 wrote metadata, the frames
/// can be read once the run was resumed.
class HeadFrames {
 public:
  /// A new file.
  HeadFrames(const std::string& stem, const Scene& scene, StrandCount head,
             StoredFrames stored);
  /// The file of an interrupted run as it was in that state, when its frames had these
  /// checksums. Throws InputError if they are damaged, or of another head.
  HeadFrames(const std::string& stem, StrandCount head, StoredFrames stored,
             std::vector<std::uint64_t> sums, const FileState& state);

  /// Returns the number of strands that this number of workers processes at a time.
  static std::size_t at_once(std::size_t workers);
  /// Compresses the root and tips (m) of strands from `first` on, a multiple of
  /// at_once(); not called where frames have no bits.
  void take(Crew& crew, std::size_t first, std::span<const double> x);
  /// Takes the positions of the strands for pictures.
  void take_shown(std::span<const double> x);
  /// Adds what was taken, and its series.
  void write(std::span<const double> series);
  /// All frames so far are on disk, and the .xdmf with them.
  void sync();
  /// Returns the state of the file after the last sync().
  FileState state();

  /// Returns the number of frames.
  std::size_t size() const { return sums_.size(); }
  /// Returns the checksum of each frame.
  const std::vector<std::uint64_t>& sums() const { return sums_; }
  /// Returns the time series' numbers of a frame.
  std::vector<double> series(std::size_t frame) const;
  /// (3 points) of the shown strands.
  std::vector<float> shown(std::size_t frame) const;

  /// Returns the name of the dataset of the positions of all strands.
  static std::string dataset(std::size_t frame);

 private:
  /// Buffers of a worker.
  struct Own {
    std::vector<char> raw, shuffled;
  };
  HeadFrames(const std::string& stem, StrandCount head, StoredFrames stored,
             Hdf5File::Mode mode);
  void take_chunk(std::size_t chunk, std::span<const double> x, Own& own);
  std::vector<std::size_t> place_of(std::size_t chunk) const;
  std::uint64_t sum(std::span<const double> series) const;
  std::string xdmf() const;

  std::string stem_;
  StoredFrames stored_;
  std::size_t strands_, points_;  // of a strand
  std::size_t each_;              // strands of a chunk
  Hdf5File file_;
  std::vector<std::uint64_t> sums_;  // of frames
  std::vector<FileRange> written_;   // chunks that stay as they are,
  std::size_t placed_ = 0;           // of so many frames
  // The frame that was taken.
  std::vector<std::vector<char>> chunks_;
  std::vector<std::size_t> sizes_;         // used bytes of chunks
  std::vector<std::uint64_t> chunk_sums_;  // of these
  std::vector<float> shown_;
  std::vector<Own> own_;
};

}  // namespace tress::simulation
