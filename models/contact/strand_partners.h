#pragma once

#include <cstddef>
#include <vector>

#include "models/contact/point_motion.h"
#include "models/contact/rigid_motion.h"
#include "models/contact/segment_cells.h"

namespace tress::models {

/// The polylines of many strands as others see them until the next update, and what is
/// needed to keep lists of those nearby, since they hardly change from step to step
/// [Bertails et al. 2006, section 4.1]: all that comes within `reach` + margin() of a
/// place is a candidate there while nothing has moved too far since the epoch. Distances
/// moved are relative to the head, whose rigid motion is that of the strands' first
/// points, or to the ground, whichever is less. An epoch ends, and segments are sorted
/// into cells anew, when some point has moved half the margin.
class StrandPartners {
 public:
  /// A point and the segment that begins there, one line of the cache.
  struct alignas(64) Node {
    Vec x, v;        // m, m/s
    double inverse;  // 1/length^2 of the segment, 0: none or of no length, 1/m^2
  };

  /// points[k] >= 2: of strand k; reach > 0, m.
  StrandPartners(std::span<const int> points, double reach);

  // As those of StrandInteraction, which see. The same bits whoever runs the loop.
  void hold(In x, In v, const Loop& loop);
  void extrapolate(double t, double end, In x, In v, const Loop& loop);
  void interpolate(double t, double end, In x, In v, In y, In w, const Loop& loop);

  bool updated() const { return !nodes_.empty(); }
  long updates() const { return updates_; }
  long epochs() const { return epochs_; }
  double reach() const { return reach_; }
  double margin() const { return margin_; }
  /// How far points may be, or be going to be until the next update, from where they were
  /// at the epoch; without the head's motion.
  double moved() const { return moved_; }
  /// The epoch's place of what would have moved with the head to x.
  template <class T>
  Vec3<T> at_epoch(const Vec3<T>& x) const {
    return head_.back(x);
  }

  const SegmentCells& segments() const { return cells_; }
  /// Places and velocities at the last update.
  const Node* nodes() const { return nodes_.data(); }
  /// At any time in its interval.
  const PointMotion& motion() const { return motion_; }
  StraightPiece piece(int segment) const {
    const Node* from = &nodes_[static_cast<std::size_t>(segment)];
    return {from[0].x, from[1].x};
  }

  /// Sets `found` to the segments of strands other than `but` that may come within
  /// `radius` of a piece at its epoch's place, and some others, ascending.
  void near(const StraightPiece& at_epoch, double radius, int but,
            std::vector<int>& found) const {
    cells_.near(at_epoch, radius + moved_, but, found);
  }

  std::size_t bytes() const;

 private:
  void move(double range, In x, In v, const Loop& loop);
  double displacement(const RigidMotion& head, const Loop& loop);
  double next_margin() const;

  double reach_, margin_;
  SegmentCells cells_;
  std::vector<Node> nodes_;
  std::vector<Vec> before_;  // places at the epoch
  PointMotion motion_;
  RigidMotion head_;
  double moved_ = 0;
  long updates_ = 0, epochs_ = 0, epoch_ = 0;  // epoch_: the update that began it
  double strayed_ = 0;                         // displacement at the last update
  std::vector<Vec> roots_, roots_before_;
  std::vector<double> farthest_;  // of each part of the points
};

}  // namespace tress::models
