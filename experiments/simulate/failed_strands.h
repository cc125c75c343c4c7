#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulation/head/ranks.h"
#include "simulation/run/failed_strand.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// <stem>.failed.csv of these.
std::string failed_table(const std::vector<FailedStrand>& lost);

/// The strands of a head that ranks lose, until all of them know.
class FailuresOfRanks {
 public:
  explicit FailuresOfRanks(Ranks& ranks) : ranks_(ranks) {}

  /// One of this rank's own.
  void lose(const FailedStrand& strand) { own_.push_back(strand); }
  /// Returns the strands of all ranks that have failed since the last call, by time and
  /// then by strand.
  std::vector<FailedStrand> gathered();

 private:
  Ranks& ranks_;
  std::vector<FailedStrand> own_;  // since the last call
};

}  // namespace tress::experiments::scene_runs
