#include "models/contact/segment_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tress::models {
namespace {

constexpr int leaf = 4;      // segments
constexpr int deepest = 64;  // more than the halvings of any int

/// Squared distance from x to a box.
double square(const Vec& x, const Box& box) {
  const auto beyond = [](double at, double least, double most) {
    return std::max({least - at, at - most, 0.0});
  };
  const Vec gap{beyond(x.x, box.least.x, box.most.x),
                beyond(x.y, box.least.y, box.most.y),
                beyond(x.z, box.least.z, box.most.z)};
  return dot(gap, gap);
}

}  // namespace

SegmentTree::SegmentTree(const StrandPartners& strands) : strands_(strands) {
  const SegmentCells& all = strands.segments();
  middles_.resize(all.points());
  for (int i = 0; i < static_cast<int>(all.points()); ++i) {
    if (all.last(i)) continue;
    const StraightPiece piece = strands.piece(i);
    if (!is_finite(piece.start) || !is_finite(piece.edge)) continue;
    middles_[static_cast<std::size_t>(i)] = piece.at(0.5);
    segments_.push_back(i);
  }
  nodes_.reserve(segments_.size());
  if (!segments_.empty()) divide(0, static_cast<int>(segments_.size()));
}

void SegmentTree::divide(int begin, int end) {
  const std::size_t node = nodes_.size();
  Box box = Box::none(), middles = box;
  for (int i = begin; i < end; ++i) {
    const int segment = segments_[static_cast<std::size_t>(i)];
    const StraightPiece piece = strands_.piece(segment);
    box.include(piece.start);
    box.include(piece.at(1));
    middles.include(middles_[static_cast<std::size_t>(segment)]);
  }
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= leaf) return;
  const Vec size = middles.most - middles.least;
  double Vec::*const axis = size.x >= size.y && size.x >= size.z ? &Vec::x
                            : size.y >= size.z                   ? &Vec::y
                                                                 : &Vec::z;
  const int half = begin + (end - begin) / 2;
  std::nth_element(segments_.begin() + begin, segments_.begin() + half,
                   segments_.begin() + end, [&](int i, int j) {
                     const double a = middles_[static_cast<std::size_t>(i)].*axis,
                                  b = middles_[static_cast<std::size_t>(j)].*axis;
                     return a < b || (a == b && i < j);
                   });
  divide(begin, half);
  nodes_[node].next = static_cast<int>(nodes_.size());
  divide(half, end);
}

double SegmentTree::square(const Vec& x, int segment) const {
  const StraightPiece piece = strands_.piece(segment);
  const Vec gap = x - piece.at(piece.nearest(x));
  return dot(gap, gap);
}

double SegmentTree::distance(const Vec& x, int but, int& nearest) const {
  double least =
      nearest >= 0 ? square(x, nearest) : std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return std::sqrt(least);
  std::array<int, deepest> open{};
  std::size_t count = 1;
  while (count > 0) {
    const auto at = static_cast<std::size_t>(open[--count]);
    const Node& node = nodes_[at];
    if (!(models::square(x, node.box) < least)) continue;
    if (node.next == 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const int segment = segments_[static_cast<std::size_t>(i)];
        if (strands_.segments().polyline(segment) == but) continue;
        const double one = square(x, segment);
        if (!(one < least)) continue;
        least = one;
        nearest = segment;
      }
      continue;
    }
    // The nearer half is taken first.
    const int first = static_cast<int>(at) + 1, second = node.next;
    const bool swap = models::square(x, nodes_[static_cast<std::size_t>(second)].box) <
                      models::square(x, nodes_[static_cast<std::size_t>(first)].box);
    open[count++] = swap ? first : second;
    open[count++] = swap ? second : first;
  }
  return std::sqrt(least);
}

}  // namespace tress::models
