#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments {

/// The hardware and system on which a timing depends. No host name: tables are published.
struct Machine {
  std::string cpu;      // model name
  int cpus = 0;         // hardware threads
  std::string caches;   // "L1d 32K, L2 512K, L3 16384K" of the first CPU
  std::string simd;     // widest of sse2, avx, avx2, avx512f
  std::string kernels;  // math/instructions.h: by which those in packs run
  std::string kernel;   // system and release
};
Machine machine();

/// Load averages over 1, 5 and 15 minutes.
std::array<double, 3> load_average();

/// "times are uncertain: ..." where more runs than the machine has processors; empty
/// where a timing can be trusted.
std::optional<std::string> timing_doubt();

/// Resources that this process and those that it has waited for have used so far.
struct Spent {
  double processor_s = 0;
  double largest_mb = 0;  // memory of the largest of them (MB)
};
Spent spent_so_far();

/// Processors that other programs use.
class OtherLoad {
 public:
  OtherLoad();
  /// Since the last call of processors(), or since this was made.
  double seconds() const;
  /// On average over that time, after which the next begins; 0 where the system does not
  /// say. Children of this process count as others until they were waited for.
  double processors();

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_;
  double busy_s_, own_s_;  // of all programs, and of this one, at the beginning
};

using Versions = std::vector<std::pair<std::string, std::string>>;
Versions library_versions();

}  // namespace tress::experiments
