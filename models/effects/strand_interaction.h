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

/// Many strands, each a System of its own, that repel and drag each other (ContactLaw).
/// The effect of a strand pushes its points, each by the force per length times the
/// length it carries, away from the polylines of all other strands' material points *as
/// they were after the last step* (lagged partners): it is a pure function between two
/// update()s, whoever calls it from whichever thread. Of every other strand the nearest
/// point counts; a second one, of an arc that comes back, does not: counted by segments,
/// a joint would push twice and a strand cut finer push more.
///
/// Derivatives are of the own point; the partners stand still. Nothing of the load is in
/// potential(), power() counts all of it. Action and reaction differ by what partners
/// move in a step, first order in it, and by how the two strands are cut. Forces between
/// points are seen only as well as points lie: nearer to each other than the inner
/// radius.
///
/// A load takes one look into the broad phase per point, O(points + candidates); update()
/// is O(segments).
class StrandInteraction {
 public:
  /// points[k]: material points of strand k, a polyline. Throws InputError when a strand
  /// has fewer than two, or the law is none.
  StrandInteraction(const Parameters& parameters, std::vector<int> points);
  StrandInteraction(const ContactLaw& law, std::vector<int> points);

  /// Refers to *this, which outlives it and does not move. No load before update(). Keeps
  /// what it found last: one thread at a time, though others may ask other effects.
  std::unique_ptr<const Effect> effect(std::size_t strand) const;

  /// At the start and after every step: positions and velocities (3 each) of all strands'
  /// material points, strand after strand.
  void update(In x, In v);

  // Readouts of the strands as they are after update(). Strands are looked at every
  // inner radius or closer (up to 64 times a segment); not for every step.
  /// Of strands that come closer to each other than the inner radius.
  long touching_pairs() const;
  /// From a strand to the nearest other one, the mean over the length of all strands, m:
  /// the less, the more cluttered. Infinite for one strand only or before update().
  double mean_distance() const;

  const SegmentGrid& grid() const { return grid_; }

 private:
  class OnStrand;

  /// The nearest point of another strand.
  struct Contact {
    int segment;
    double s;  // on it
    Vec gap;   // from there
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
