#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "simulation/head/ranks.h"
#include "simulation/run/lost_strand.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// <stem>.lost.csv of these.
std::string lost_table(const std::vector<LostStrand>& lost);

/// The strands of a head that ranks lose, until all of them know.
class LostStrands {
 public:
  explicit LostStrands(Ranks& ranks) : ranks_(ranks) {}

  /// One of this rank's own.
  void lose(const LostStrand& strand) { own_.push_back(strand); }
  /// Returns the strands of all ranks that have failed since the last call, by time and
  /// then by strand.
  std::vector<LostStrand> gathered();

 private:
  Ranks& ranks_;
  std::vector<LostStrand> own_;  // since the last call
};

}  // namespace tress::experiments::scene_runs
