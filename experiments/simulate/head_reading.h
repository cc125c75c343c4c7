#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "simulation/export/head_frames.h"
#include "simulation/head/head_run.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// Data of a head that go to the first rank during the run: strands come by the
/// thousand, so that it need not hold what all ranks have.
class HeadReading {
 public:
  /// `shown`: strands of pictures.
  HeadReading(std::vector<std::size_t> shown, int threads)
      : shown_(std::move(shown)),
        at_once_(HeadFrames::at_once(static_cast<std::size_t>(threads))) {}

  const std::vector<std::size_t>& shown() const { return shown_; }
  std::size_t at_once() const { return at_once_; }  // strands
  /// Calls use(strands) for all strands, chunk by chunk.
  void by_chunks(const HeadRun& run,
                 const std::function<void(HeadRun::Numbers)>& use) const {
    run.by_chunks(at_once_, use);
  }

  /// A row of head_series() at t; on the first rank.
  std::vector<double> series(HeadRun& run, double t);
  /// Positions at t into `frame`, null on other ranks; of all strands, or shown ones
  /// alone.
  void frame(HeadRun& run, double t, bool all, HeadFrames* frame) const;

 private:
  std::vector<std::size_t> shown_;
  std::size_t at_once_;  // strands
  std::vector<models::HeadEnergy> energies_;
  std::vector<double> potentials_;
};

}  // namespace tress::experiments::scene_runs
