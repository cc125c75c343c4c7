#pragma once

#include <vector>

#include "models/contact/strand_partners.h"

namespace tress::models {

/// Boxes about the segments of many strands, halved at the median again and again: how
/// far the nearest one is. Building is O(segments log segments), a search O(log segments)
/// where strands are not all at the same distance.
class SegmentTree {
 public:
  /// Builds the boxes of the strands' segments.
  explicit SegmentTree(const StrandPartners& strands);

  /// Returns the distance from x to the nearest segment of another strand than `but`, m;
  /// infinite if there is none. `nearest`: a guess, -1 for none, becomes that segment.
  double distance(const Vec& x, int but, int& nearest) const;

 private:
  struct Node {
    Box box;
    int begin, end;  // of segments_
    int next;        // the second half; the first one follows its node; 0: a leaf
  };
  void divide(int begin, int end);
  double square(const Vec& x, int segment) const;

  const StrandPartners& strands_;
  std::vector<int> segments_;
  std::vector<Vec> middles_;  // by segment
  std::vector<Node> nodes_;
};

}  // namespace tress::models
