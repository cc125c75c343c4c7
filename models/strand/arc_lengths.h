#pragma once

#include <vector>

#include "models/strand/strand.h"

namespace tress::models {

/// Returns the rest lengths (m) from the root to the ends of the segments of a strand
/// without branches, 0 first.
inline std::vector<double> arc_lengths(const Strand& strand) {
  std::vector<double> all{0};
  for (const Segment& segment : strand.segments) {
    all.push_back(all.back() + segment.length);
  }
  return all;
}

}  // namespace tress::models
