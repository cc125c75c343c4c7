#pragma once

#include <span>
#include <vector>

#include "models/contact/point_groups.h"

namespace tress::models {

/// Which segments of many strands may feel another strand at all, so that kernels that
/// take blocks of strands can leave out the rest. Conservative: a segment whose points
/// are up to `bulge` (m) away from its chord is told of whatever comes within the
/// partners' reach of one of them. Lists are kept as those of PointGroups; some 250 bytes
/// a segment and 4 a candidate.
class FeltSegments {
 public:
  /// `partners` must outlive it.
  FeltSegments(const StrandPartners& partners, double bulge);

  /// After an update of the partners: felt[i], for every point, is 1 if the segment that
  /// begins there may feel something, of all points at x (3 each). The same whoever runs
  /// the loop.
  void find(In x, std::span<unsigned char> felt, const Loop& loop = in_turn);

  std::size_t bytes() const;

 private:
  struct Strand {
    PointGroups samples;  // four of each segment
    double between;       // longest distance from a chord's point to a sample, m
  };

  const StrandPartners& partners_;
  double bulge_;
  std::vector<Strand> strands_;
};

}  // namespace tress::models
