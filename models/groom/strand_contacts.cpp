#include "models/groom/strand_contacts.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

constexpr double margin = 0.5;  // of the reach: pairs may come so much nearer

}  // namespace

StrandContacts::StrandContacts(const ContactLaw& law, std::vector<int> points, In x)
    : law_(law), grid_(points, (1 + margin) * law.reach()) {
  grid_.update(x);
  for (int i = 0; i < static_cast<int>(grid_.segments()); ++i) {
    const Vec edge = grid_.piece(i).edge;
    const double length = norm(edge);
    const int count = std::max(1, static_cast<int>(std::ceil(2 * length / law.inner())));
    samples_.push_back({count, length / count});
  }
  renew(x);
}

bool StrandContacts::update(In x) {
  const double most = margin / 4 * law_.reach();
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const Vec moved = load3(&x[i]) - load3(&made_at_[i]);
    if (!(dot(moved, moved) <= most * most)) return renew(x);
  }
  return false;
}

bool StrandContacts::renew(In x) {
  made_at_.assign(x.begin(), x.end());
  grid_.update(x);
  const double wide = (1 + margin) * law_.reach();
  std::vector<int> start{0}, partner;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto segment = static_cast<int>(i);
    const StraightPiece& piece = grid_.piece(segment);
    const auto first = static_cast<std::ptrdiff_t>(partner.size());
    for (int k = 0; k < samples_[i].count; ++k) {
      const Vec sample = piece.at((k + 0.5) / samples_[i].count);
      for (const SegmentGrid::Entry& entry : grid_.near(sample)) {
        if (entry.polyline == grid_.polyline(segment)) continue;
        const StraightPiece& other = grid_.piece(entry.segment);
        const Vec gap = sample - other.at(other.nearest(sample));
        if (dot(gap, gap) <= wide * wide) partner.push_back(entry.segment);
      }
    }
    std::sort(partner.begin() + first, partner.end());
    partner.erase(std::unique(partner.begin() + first, partner.end()), partner.end());
    start.push_back(static_cast<int>(partner.size()));
  }
  if (start == start_ && partner == partner_) return false;
  start_.swap(start);
  partner_.swap(partner);
  return true;
}

}  // namespace tress::models
