#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "math/fetch.h"
#include "models/contact/local_drift.h"
#include "models/contact/point_motion.h"
#include "models/contact/rigid_motion.h"
#include "models/contact/segment_cells.h"

namespace tress::models {

/// Polylines of many strands as others see them until the next update, with data to keep
/// lists of neighbours. Neighbours hardly change from step to step [Bertails et al. 2006,
/// section 4.1]. Displacements are relative to the head, whose rigid motion is that of
/// the strands' first points. A list is valid until its surroundings have moved too far
/// relative to it, by drift(); it lasts longer where hair is slow. An epoch ends, and
/// segments are sorted into cells again, when some point has moved far from its place at
/// the epoch.
class StrandPartners {
 public:
  /// points[k] >= 2: of strand k; reach > 0, m.
  StrandPartners(std::span<const int> points, double reach);

  // As those of StrandInteraction, which see. The same bits whoever runs the loop.
  /// Takes points that stay in place.
  void hold(In x, In v, const Loop& loop);
  /// Takes points that move uniformly from t to `end`.
  void extrapolate(double t, double end, In x, In v, const Loop& loop);
  /// Takes points that move to known places y and velocities w.
  void interpolate(double t, double end, In x, In v, In y, In w, const Loop& loop);

  /// Returns true after the first update.
  bool updated() const { return !nodes_.empty(); }
  /// Returns the number of updates.
  long updates() const { return updates_; }
  /// Returns the number of epochs.
  long epochs() const { return epochs_; }
  /// Returns the distance within which strands act on each other, m.
  double reach() const { return reach_; }

  // For lists of what is within reach() + margin() of a place at an update.
  /// The distance that costs least, m.
  double margin() const { return margin_; }
  /// Returns the largest distance that a point moves until the next update, m.
  double range() const { return range_; }
  /// Lists made before it changed hold no longer, whatever has moved.
  long lists() const { return lists_; }
  /// Returns the position at the last update but one of what has moved with the head to
  /// x.
  template <class T>
  Vec3<T> before(const Vec3<T>& x) const {
    return step_.back(x);
  }
  /// Holds the last displacements x - before of all that may have come within a list's
  /// distance of a place in the cell, but for long segments.
  const LocalDrift::Spread& drift(int cell) const { return drift_.near(cell); }
  /// Returns the cell of each lane; `at_epoch`: position at the last update. Positions
  /// that are not finite have some cell.
  template <class P>
  std::array<int, lanes<P>> cells(const Vec3<P>& at_epoch) const {
    return drift_.cells(at_epoch);
  }

  /// The epoch's place of what would have moved with the head to x.
  template <class T>
  Vec3<T> at_epoch(const Vec3<T>& x) const {
    return head_.back(x);
  }
  /// Returns the largest displacement of points since the epoch.
  double moved() const { return moved_; }

  /// Returns the cells of the epoch's segments.
  const SegmentCells& segments() const { return cells_; }
  /// Returns the motion of the points at any time in its interval.
  const PointMotion& motion() const { return motion_; }
  /// Returns the piece of a segment at the last update; the last point of a strand begins
  /// none.
  StraightPiece piece(int segment) const {
    const auto i = static_cast<std::size_t>(segment);
    StraightPiece piece;
    piece.start = nodes_[i].x;
    piece.edge = nodes_[i + 1].x - piece.start;
    piece.inverse = nodes_[i].inverse;
    return piece;
  }
  /// Returns the place of a point at the last update.
  const Vec& place(int point) const { return nodes_[static_cast<std::size_t>(point)].x; }
  /// 1/|edge|^2 of a segment, as of its piece.
  double inverse(int segment) const {
    return nodes_[static_cast<std::size_t>(segment)].inverse;
  }
  /// Returns the velocity of a point.
  const Vec& velocity(int point) const { return v_[static_cast<std::size_t>(point)]; }
  // What is needed soon is let come into the cache.
  /// Prefetches the data of a run of segments.
  void fetch_segments(int first, unsigned count) const {
    const auto i = static_cast<std::size_t>(first);
    fetch(&nodes_[i], count + 1);
    fetch(&v_[i], count + 1);
  }
  /// Prefetches the places of a segment.
  void fetch_place(int segment) const {
    fetch(&nodes_[static_cast<std::size_t>(segment)], 2);
  }

  /// Sets `found` to the segments of strands other than `but` that may come within
  /// `radius` of a piece at its epoch's place, and some others, ascending.
  void near(const StraightPiece& at_epoch, double radius, int but,
            std::vector<int>& found) const {
    cells_.near(at_epoch, radius + moved_, but, found);
  }

  /// Returns the memory in use, bytes.
  std::size_t bytes() const;
  /// With what PointGroups keep, for each point of hair as dense as that of a head, of
  /// segments of that length (m): an estimate.
  static std::size_t bytes_of_point(double segment, double reach);

 private:
  void move(double range, In x, In v, const Loop& loop);
  bool place(In x, In v, const Loop& loop);
  double displacement(const RigidMotion& head, const Loop& loop);
  void begin_epoch(In x, const Loop& loop);
  double best_margin() const;

  double reach_, margin_;
  SegmentCells cells_;
  struct alignas(32) Node {  // never in two lines of the cache
    Vec x;
    double inverse;  // of the segment that it begins
  };
  std::vector<Node> nodes_;
  std::vector<Vec> v_;
  std::vector<Vec> before_;  // places at the epoch
  std::vector<Vec> moves_;   // displacements in the last step
  PointMotion motion_;
  RigidMotion head_, step_;  // since the epoch and the last update but one
  LocalDrift drift_;
  double moved_ = 0, range_ = 0, covered_ = 0;  // covered_: range that drift_ allows for
  long updates_ = 0, epochs_ = 0, lists_ = 0;
  std::vector<Vec> roots_, roots_before_;
  std::vector<double> farthest_;  // of each part of the points
  std::vector<char> came_;        // of the same: whether a point has got a place
};

}  // namespace tress::models
