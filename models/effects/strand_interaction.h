#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/parameters.h"
#include "models/contact/contact_law.h"
#include "models/contact/strand_partners.h"
#include "models/effects/effect.h"

namespace tress::models {

/// The table [effects.strand_interaction] of a scene: `coupling` and the contact law.
std::span<const Parameter> strand_interaction_parameters();

/// Interaction of many strands, each a separate System, that repel and drag each other
/// (ContactLaw). The effect of a strand pushes its points away from the polylines of all
/// other strands' material points. The load on a point is the force per length times the
/// length that the point carries. The motion of the other strands is given (lagged
/// partners). After update() they stay in place, after extrapolate() they move uniformly,
/// after interpolate() to known places. The effect is a pure function between two of
/// these calls, for any caller and thread. Only the nearest point of every other strand
/// counts, even if a second arc of that strand is near. Otherwise a joint would push
/// twice and a finer discretisation would push more.
///
/// Derivatives are with respect to the strand's own point; partners are fixed. None of
/// the load is in potential(); power() counts all of it. Action and reaction differ by
/// the motion of partners in a step, first order in the step, and by the discretisations
/// of the two strands. Contacts are resolved only if points are closer to each other than
/// the inner radius.
///
/// Eight points of a strand share a cached list of the segments that may come near
/// (PointGroups), which the first caller makes. Load and derivatives at the same state
/// come from one search. Cost: O(points in reach), whatever the number of strands;
/// update() is O(points).
class StrandInteraction {
 public:
  /// points[k]: material points of strand k, a polyline. Throws InputError if a strand
  /// has fewer than two, or the law is invalid.
  StrandInteraction(const Parameters& parameters, std::vector<int> points);
  /// Constructs the interaction from a law; points as above.
  StrandInteraction(const ContactLaw& law, std::vector<int> points);

  /// Refers to *this, which must outlive it and not move. No load before update(). Caches
  /// its last search: one thread at a time per effect; other threads may use others.
  std::unique_ptr<const Effect> effect(std::size_t strand) const;

  /// Updates positions and velocities (3 each) of all strands' material points, strand
  /// after strand; call it at the start and after every step. The loop may share its
  /// parts among threads: the results are the same.
  void update(In x, In v, const Loop& loop = in_turn);
  /// Updates the points at t for an interval up to `end` (s) in which they keep their
  /// velocities; `end` is a breakpoint of the effects.
  void extrapolate(double t, double end, In x, In v, const Loop& loop = in_turn);
  /// Updates the points for an interval in which they move along cubics to y with the
  /// velocities w.
  void interpolate(double t, double end, In x, In v, In y, In w,
                   const Loop& loop = in_turn);
  /// Longest distance (m) at which strands feel each other.
  double reach() const { return law_.reach(); }
  /// Returns the law of contact.
  const ContactLaw& law() const { return law_; }

  // Readouts of the strands where the last call put them, too costly for every step.
  // Strands are sampled at most one inner radius apart (up to 64 samples a segment).
  /// Number of pairs of strands closer to each other than the inner radius.
  long touching_pairs(const Loop& loop = in_turn) const;
  /// Distance from a strand to the nearest other one, mean over the length of all
  /// strands, m. Infinite for a single strand or before update().
  double mean_distance(const Loop& loop = in_turn) const;

  /// Returns the strands as others see them.
  const StrandPartners& partners() const { return partners_; }

 private:
  class OnStrand;

  ContactLaw law_;
  StrandPartners partners_;
  double end_ = 0;  // of the interval
};

}  // namespace tress::models
