#include "models/contact/crowding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "models/contact/segment_tree.h"

namespace tress::models {
namespace {

constexpr double most_samples = 64;          // of a segment
constexpr std::size_t strands_at_once = 64;  // that are one piece of work

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Calls act(chunk, strand) for all strands.
void each_strand(const StrandPartners& strands, const Loop& loop,
                 const std::function<void(std::size_t, std::size_t)>& act) {
  const std::size_t count = strands.segments().polylines();
  loop((count + strands_at_once - 1) / strands_at_once, [&](std::size_t part) {
    const std::size_t end = std::min(count, (part + 1) * strands_at_once);
    for (std::size_t k = part * strands_at_once; k < end; ++k) act(part, k);
  });
}

std::size_t parts(const StrandPartners& strands) {
  return strands.segments().polylines() / strands_at_once + 1;
}

/// Calls act(place) for samples of a piece and returns the length of each.
template <class F>
double each_sample(const StraightPiece& piece, double apart, F act) {
  const double length = std::sqrt(dot(piece.edge, piece.edge));
  const double samples = std::clamp(std::ceil(length / apart), 1.0, most_samples);
  for (double k = 0.5; k < samples; ++k) act(piece.at(k / samples));
  return length / samples;
}

}  // namespace

long touching_pairs(const StrandPartners& strands, double apart, const Loop& loop) {
  const SegmentCells& segments = strands.segments();
  std::vector<std::vector<std::pair<int, int>>> touching(parts(strands));
  std::vector<std::vector<int>> found(parts(strands));
  each_strand(strands, loop, [&](std::size_t part, std::size_t k) {
    const int strand = static_cast<int>(k);
    std::vector<std::pair<int, int>>& pairs = touching[part];
    for (int i = segments.first(k); i + 1 < segments.first(k + 1); ++i) {
      const StraightPiece piece = strands.piece(i);
      strands.near({strands.at_epoch(piece.start), strands.at_epoch(piece.at(1))}, apart,
                   strand, found[part]);
      for (const int j : found[part]) {
        const std::pair<int, int> pair = std::minmax(strand, segments.polyline(j));
        if (!pairs.empty() && pairs.back() == pair) continue;
        const StraightPiece other = strands.piece(j);
        bool touches = false;
        each_sample(piece, apart, [&](const Vec& x) {
          const Vec gap = x - other.at(other.nearest(x));
          touches = touches || dot(gap, gap) < apart * apart;
        });
        if (touches) pairs.emplace_back(pair);
      }
    }
  });
  std::vector<std::pair<int, int>> all;
  for (const auto& pairs : touching) all.insert(all.end(), pairs.begin(), pairs.end());
  std::ranges::sort(all);
  return std::unique(all.begin(), all.end()) - all.begin();
}

double mean_distance(const StrandPartners& strands, double apart, const Loop& loop) {
  const SegmentCells& segments = strands.segments();
  if (segments.polylines() < 2) return infinity;
  const SegmentTree tree(strands);
  struct Sums {
    double lengths = 0, distances = 0;
  };
  std::vector<Sums> sums(parts(strands));
  each_strand(strands, loop, [&](std::size_t part, std::size_t k) {
    int nearest = -1;  // of the last sample, not far from the next one's
    for (int i = segments.first(k); i + 1 < segments.first(k + 1); ++i) {
      double distances = 0;
      int samples = 0;
      const double each = each_sample(strands.piece(i), apart, [&](const Vec& x) {
        distances += tree.distance(x, static_cast<int>(k), nearest);
        ++samples;
      });
      sums[part].lengths += each * samples;
      sums[part].distances += each * distances;
    }
  });
  Sums all;
  for (const Sums& one : sums) {
    all.lengths += one.lengths;
    all.distances += one.distances;
  }
  const double mean = all.distances / all.lengths;
  return std::isfinite(mean) ? mean : std::nan("");
}

}  // namespace tress::models
