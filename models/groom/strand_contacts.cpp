#include "models/groom/strand_contacts.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

constexpr double margin = 0.5;  // of the reach: pairs may come so much nearer

}  // namespace

StrandContacts::StrandContacts(const ContactLaw& law, std::vector<int> points, In x)
    : law_(law), cells_(points) {
  for (int i = 0; i < static_cast<int>(cells_.points()); ++i) {
    segment_.push_back(static_cast<int>(point_.size()));
    if (cells_.last(i)) continue;
    const auto at = static_cast<std::size_t>(i);
    const double length = norm(load3(&x[3 * at + 3]) - load3(&x[3 * at]));
    const int count = std::max(1, static_cast<int>(std::ceil(2 * length / law.inner())));
    point_.push_back(at);
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
  const double wide = (1 + margin) * law_.reach();
  cells_.fill(x, wide, in_turn);
  const auto piece = [&](std::size_t from) {
    return StraightPiece(load3(&x[3 * from]), load3(&x[3 * from + 3]));
  };
  std::vector<int> start{0}, partner, near;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const StraightPiece own = piece(point_[i]);
    cells_.near(own, wide, strand(static_cast<int>(i)), near);
    for (const int from : near) {
      const StraightPiece other = piece(static_cast<std::size_t>(from));
      for (int k = 0; k < samples_[i].count; ++k) {
        const Vec sample = own.at((k + 0.5) / samples_[i].count);
        const Vec gap = sample - other.at(other.nearest(sample));
        if (!(dot(gap, gap) <= wide * wide)) continue;
        partner.push_back(segment_[static_cast<std::size_t>(from)]);
        break;
      }
    }
    start.push_back(static_cast<int>(partner.size()));
  }
  if (start == start_ && partner == partner_) return false;
  start_.swap(start);
  partner_.swap(partner);
  return true;
}

}  // namespace tress::models
