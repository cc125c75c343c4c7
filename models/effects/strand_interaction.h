#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/parameters.h"
#include "models/effects/contact_law.h"
#include "models/effects/effect.h"
#include "models/effects/segment_grid.h"

namespace tress::models {

/// The table [effects.strand_interaction] of a scene: `coupling` and the contact law.
std::span<const Parameter> strand_interaction_parameters();

/// Many strands, each a separate System, that repel and drag each other (ContactLaw). The
/// effect of a strand pushes its points, each by the force per length times the length it
/// carries, away from the polylines of all other strands' material points *as they were
/// after the last step* (lagged partners). It is a pure function between two update()s,
/// for any caller and thread. Only the nearest point of every other strand counts, even
/// if a second arc of that strand is near: counting segments, a joint would push twice
/// and a finer discretisation would push more.
///
/// Derivatives are with respect to the strand's own point; partners are fixed. None of
/// the load is in potential(); power() counts all of it. Action and reaction differ by
/// the motion of partners in a step, first order in the step, and by the discretisations
/// of the two strands. Contacts are resolved only if points are closer to each other than
/// the inner radius.
///
/// A load takes one query of the broad phase per point, O(points + candidates); update()
/// is O(segments).
class StrandInteraction {
 public:
  /// points[k]: material points of strand k, a polyline. Throws InputError if a strand
  /// has fewer than two, or the law is invalid.
  StrandInteraction(const Parameters& parameters, std::vector<int> points);
  StrandInteraction(const ContactLaw& law, std::vector<int> points);

  /// Refers to *this, which must outlive it and not move. No load before update(). Caches
  /// its last search: one thread at a time per effect; other threads may use others.
  std::unique_ptr<const Effect> effect(std::size_t strand) const;

  /// At the start and after every step: positions and velocities (3 each) of all strands'
  /// material points, strand after strand.
  void update(In x, In v);

  // Readouts of the strands after update(), too costly for every step. Strands are
  // sampled at most one inner radius apart (up to 64 samples a segment).
  /// Number of pairs of strands closer to each other than the inner radius.
  long touching_pairs() const;
  /// Distance from a strand to the nearest other one, mean over the length of all
  /// strands, m. Infinite for a single strand or before update().
  double mean_distance() const;

  const SegmentGrid& grid() const { return grid_; }

 private:
  class OnStrand;

  /// The nearest point of another strand.
  struct Contact {
    int segment;
    double s;  // position on its segment
    Vec gap;   // vector from there
  };
  template <class F>
  void each_contact(const SegmentGrid& grid, double reach, int strand, const Vec& x,
                    F of_contact) const;
  Vec velocity(int segment, double s) const;
  template <class F>
  void each_sample(F of_sample) const;

  ContactLaw law_;
  SegmentGrid grid_;
  std::vector<int> points_;
  std::vector<double> x_, v_;
  long updates_ = 0;
};

}  // namespace tress::models
