#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "models/passages/body_passage.h"

namespace tress::simulation {

/// A strand that passed through a body within one step, outside it at both ends.
struct MissedContact {
  std::size_t body = 0;   // its number among the effects
  std::size_t point = 0;  // material point at the end of the segment that passed
  double t = 0;           // s, at the end of the step
  double depth = 0;       // m, on the way
  double needed = 0;      // s: in this step the path is half of the body's thickness
};

/// Contact that a strand missed. The point is then one of this strand.
struct StrandPassage {
  std::size_t strand = 0;  // its number
  MissedContact contact;   // what contact has missed
};

/// Material points of strands, and places between them. A strand is the polygon through
/// its material points. Places are at distances of at most half the thickness of the
/// thinnest body, in 64 pieces per segment at most.
class StrandPlaces {
 public:
  /// `before`: the point along the strand before each, -1: none.
  StrandPlaces(const models::Effects& bodies, std::vector<int> before);

  /// Returns the number of material points.
  std::size_t points() const { return before_.size(); }
  /// Places of the material points at x, m.
  std::vector<double> of(In x) const { return of(x, x); }
  /// Returns the places at x that are those of() of `like`, which has other positions of
  /// the points.
  std::vector<double> of(In x, In like) const;
  /// Returns the material point at the end of the segment that each place is on.
  std::vector<std::size_t> ends(In like) const;

 private:
  template <class Use>
  void each_between(In like, Use use) const;

  double spacing_;           // m
  std::vector<int> before_;  // each point along its strand, -1: none
};

/// Finds strands that pass through bodies between the ends of a step. Planes have no
/// other side. Costs two changes of frame per material point and body where the points
/// move by less than half of the body's thickness.
class BodyPassages {
 public:
  /// Looks at those of the effects that are bodies. `before` as in StrandPlaces.
  BodyPassages(const models::Effects& effects, std::vector<int> before);

  /// Result of a search.
  struct Found {
    double longest = 0;                   // longest path over half of a body's thickness
    std::optional<MissedContact> missed;  // the deepest
  };
  /// Searches the paths of material points in one step.
  Found find(const models::Paths& paths) const;
  /// Returns true if there is a body.
  bool any() const { return !bodies_.empty(); }
  /// Returns the places on strands.
  const StrandPlaces& places() const { return places_; }

 private:
  struct OneBody {
    std::size_t number;  // among the effects
    std::shared_ptr<const models::Effect> effect;
    const models::RigidBody* body;  // of the effect
  };
  std::vector<OneBody> bodies_;
  StrandPlaces places_;
};

}  // namespace tress::simulation
