#pragma once

#include <span>
#include <vector>

#include "models/head/head.h"
#include "simulation/run/readout.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// The columns of the time series of a head of this scene.
std::vector<Reading> head_series(const Scene& scene);

/// A row of them, from the energies of all strands, which are summed in the order of the
/// strands, without those that are lost.
class HeadSeriesRow {
 public:
  /// The next strand, with the potentials of effects that have a column (J); `lost`:
  /// whether it is.
  void add(const models::HeadEnergy& one, std::span<const double> potentials, bool lost);
  /// Returns the values over all strands so far, at t.
  std::vector<double> at(double t) const;

 private:
  std::size_t strands_ = 0, lost_ = 0;
  Vec tip_;
  double kinetic_ = 0, elastic_ = 0, gravity_ = 0, most_kinetic_ = 0, most_elastic_ = 0,
         fastest_ = 0;
  std::vector<double> effects_;
};

}  // namespace tress::experiments::scene_runs
