#pragma once

#include <span>
#include <utility>
#include <vector>

#include "models/contact/contact_law.h"
#include "models/contact/segment_cells.h"
#include "models/coupling/piece_contact.h"

namespace tress::models {

/// Contacts between the polylines of many strands, in both directions. Every segment has
/// samples, initially at most half the inner radius apart. Each sample interacts with the
/// nearest point of every other strand within reach, with half of its length because the
/// other strand has samples too. Only listed pairs of segments interact. The list is
/// complete while no point has moved more than a quarter of the reach since it was made.
class StrandContacts {
 public:
  /// points[k] >= 2: material points of strand k. x: initial positions of all points (3
  /// each), which determine the lengths of segments.
  StrandContacts(const ContactLaw& law, std::vector<int> points, In x);

  /// Rebuilds the list if a point has moved half as far as it may. True if pairs changed.
  bool update(In x);
  /// Rebuilds the list at x in any case.
  bool renew(In x);
  /// Positions at which the list was made.
  const std::vector<double>& made_at() const { return made_at_; }

  /// Returns the law of contact.
  const ContactLaw& law() const { return law_; }
  /// Returns the number of segments.
  std::size_t segments() const { return samples_.size(); }
  /// Segments of other strands that may touch this one, ascending.
  std::span<const int> partners(std::size_t segment) const {
    const auto first = static_cast<std::size_t>(start_[segment]);
    return std::span(partner_).subspan(
        first, static_cast<std::size_t>(start_[segment + 1]) - first);
  }
  /// Index of a segment's first point among all points.
  std::size_t point(int segment) const {
    return point_[static_cast<std::size_t>(segment)];
  }

  /// Calls of_contact(points, contact) for every contact of points at x with velocities
  /// v, in a fixed order.
  template <class F>
  void each_contact(In x, In v, F of_contact) const;

 private:
  struct Samples {
    int count;
    double length;  // per sample, m
  };

  int strand(int segment) const {
    return cells_.polyline(static_cast<int>(point(segment)));
  }

  ContactLaw law_;
  SegmentCells cells_;
  std::vector<std::size_t> point_;  // first one of each segment
  std::vector<int> segment_;        // that begins at each point
  std::vector<Samples> samples_;    // per segment
  std::vector<double> made_at_;
  std::vector<int> start_, partner_;
};

template <class F>
void StrandContacts::each_contact(In x, In v, F of_contact) const {
  const double far = law_.reach() * law_.reach();
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const std::span<const int> all = partners(i);
    if (all.empty()) continue;
    const std::size_t own = point(static_cast<int>(i));
    const StraightPiece piece(load3(&x[3 * own]), load3(&x[3 * own + 3]));
    for (int k = 0; k < samples_[i].count; ++k) {
      const double sigma = (k + 0.5) / samples_[i].count;
      const Vec sample = piece.at(sigma);
      for (std::size_t j = 0; j < all.size();) {
        const int other = strand(all[j]);
        double least = far, at = 0;
        std::size_t nearest = 0;
        for (; j < all.size() && strand(all[j]) == other; ++j) {
          const std::size_t from = point(all[j]);
          const StraightPiece partner(load3(&x[3 * from]), load3(&x[3 * from + 3]));
          const double s = partner.nearest(sample);
          const Vec gap = sample - partner.at(s);
          if (!(dot(gap, gap) < least)) continue;
          least = dot(gap, gap);
          at = s;
          nearest = from;
        }
        if (!(least < far)) continue;
        const std::array<std::size_t, 4> points{own, own + 1, nearest, nearest + 1};
        PieceContact::Points place, velocity;
        for (std::size_t a = 0; a < 4; ++a) {
          place[a] = load3(&x[3 * points[a]]);
          velocity[a] = load3(&v[3 * points[a]]);
        }
        of_contact(points,
                   PieceContact(place, velocity, sigma, at, samples_[i].length / 2));
      }
    }
  }
}

}  // namespace tress::models
