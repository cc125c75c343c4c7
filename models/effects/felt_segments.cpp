#include "models/effects/felt_segments.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

constexpr double more = 1.1;  // longest segment that lists allow for, over that of now
constexpr std::size_t strands_together = 64;  // in one piece of work

}  // namespace

FeltSegments::FeltSegments(const StrandPartners& partners, double bulge)
    : partners_(partners), bulge_(bulge) {
  for (std::size_t k = 0; k < partners.segments().polylines(); ++k) {
    strands_.push_back({{partners, static_cast<int>(k), bulge}, 0});
  }
}

void FeltSegments::find(In x, std::span<unsigned char> felt, const Loop& loop) {
  std::ranges::fill(felt, static_cast<unsigned char>(0));
  if (!partners_.updated()) return;
  const SegmentCells& all = partners_.segments();
  const std::size_t parts = (strands_.size() + strands_together - 1) / strands_together;
  loop(parts, [&](std::size_t part) {
    std::vector<double> samples, length;
    const std::size_t end = std::min(strands_.size(), (part + 1) * strands_together);
    for (std::size_t k = part * strands_together; k < end; ++k) {
      const auto first = static_cast<std::size_t>(all.first(k)),
                 last = static_cast<std::size_t>(all.first(k + 1)) - 1;
      samples.clear();
      double longest = 0;
      for (std::size_t i = first; i < last; ++i) {
        const StraightPiece piece(load3(&x[3 * i]), load3(&x[3 * i + 3]));
        if (std::isfinite(norm(piece.edge)))
          longest = std::max(longest, norm(piece.edge));
        for (int s = 0; s < Pack::lanes; ++s) {
          const Vec at = piece.at(s / (Pack::lanes - 1.0));
          samples.insert(samples.end(), {at.x, at.y, at.z});
        }
      }
      Strand& strand = strands_[k];
      // Samples are a third of the segment apart.
      if (longest / 6 > strand.between) {
        strand.between = more * longest / 6;
        strand.samples = {partners_, static_cast<int>(k), bulge_ + strand.between};
      }
      const double radius = partners_.reach() + bulge_ + longest / 6;
      length.assign(samples.size() / 3, 1.0);
      strand.samples.ready(samples, length, 0);
      for (std::size_t i = first; i < last; ++i) {
        felt[i] = strand.samples.touched(i - first, radius, 0) ? 1 : 0;
      }
    }
  });
}

std::size_t FeltSegments::bytes() const {
  std::size_t sum = strands_.capacity() * sizeof(Strand);
  for (const Strand& strand : strands_) sum += strand.samples.bytes();
  return sum;
}

}  // namespace tress::models
