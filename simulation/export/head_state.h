#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/head/head.h"
#include "simulation/files/run_key.h"

namespace tress::simulation {

/// A strand that stays where it is from this time on.
struct LostStrand {
  std::size_t strand;
  double t;           // s
  bool fast = false;  // it was faster than physics allows; else: not finite
};

/// How far the run of a head has come.
struct HeadProgress {
  std::vector<std::uint64_t> sums;  // checksums of the frames that are written
  std::size_t step = 0;             // taken towards the next one
  std::vector<LostStrand> lost;     // in the order in which they were
  double speed = 0;                 // m/s, what HeadGuard has gathered
};

/// Writes the state of all strands beside the file, with its checksum, block after block,
/// then renames it over the file.
void save_head(const std::string& file, const RunKey& key, const models::Head& head,
               const HeadProgress& progress);

/// Sets the state of a head of the same strands. Throws InputError when the file is
/// damaged, or of another run.
HeadProgress load_head(const std::string& file, const RunKey& key, models::Head& head);

}  // namespace tress::simulation
