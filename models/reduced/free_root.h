#pragma once

#include "contract/basics.h"
#include "models/reduced/helix.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Motion of a frame: in its own components, relative to the world.
template <class T>
struct FrameMotionOf {
  FrameOf<T> frame;  // relative to the world
  Vec3<T> x;         // world components, m
  Vec3<T> v, omega, a, alpha;
};
using FrameMotion = FrameMotionOf<double>;

/// A root that moves freely, by 6 unknowns: its position (world components) and a
/// rotation vector theta relative to a reference frame, frame = reference exp([theta]x).
/// The reference follows the motion (rebase), so theta stays far from 2 pi.
class FreeRootFrame {
 public:
  explicit FreeRootFrame(const FreeRoot& start)
      : start_(start), reference_(start.frame) {}

  /// Writes the initial coordinates and rates (6 each).
  void initial_state(Out q, Out v) const;
  /// Sets the position (6) used by all calls below except rebase().
  void place(In q);
  FrameMotion motion(In q, In v, In a) const;
  /// Generalised forces of a wrench at the root, in the root's components.
  void residual(const Vec& force, const Vec& moment, Out r) const;
  /// Moves the reference if theta has grown; true if q and v have changed.
  bool rebase(InOut q, InOut v);
  void reset() { reference_ = start_.frame; }
  const Frame& reference() const { return reference_; }
  void recall(const Frame& reference) { reference_ = reference; }

  const Frame& frame() const { return frame_; }
  const Helix& joint() const { return joint_; }
  const Helix::At<double>& at() const { return at_; }

 private:
  FreeRoot start_;
  Frame reference_;
  Helix joint_;
  Helix::At<double> at_{};
  Frame frame_;
};

}  // namespace tress::models
