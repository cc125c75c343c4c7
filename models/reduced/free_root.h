#pragma once

#include "contract/basics.h"
#include "models/reduced/helix.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Motion of a frame: in its own components, relative to the world.
template <class T>
struct FrameMotionOf {
  FrameOf<T> frame;            // axes in components of the world
  Vec3<T> x;                   // position in components of the world, m
  Vec3<T> v, omega, a, alpha;  // velocity, angular velocity, and their rates
};
/// Motion of a frame in double precision.
using FrameMotion = FrameMotionOf<double>;

/// A root that moves freely, by 6 unknowns: its position (world components) and a
/// rotation vector theta relative to a reference frame, frame = reference exp([theta]x).
/// The reference follows the motion (rebase), so theta stays far from 2 pi.
class FreeRootFrame {
 public:
  /// Takes the frame of `start` as reference.
  explicit FreeRootFrame(const FreeRoot& start)
      : start_(start), reference_(start.frame) {}

  /// Writes the initial coordinates and rates (6 each).
  void initial_state(Out q, Out v) const;
  /// Sets the unknowns (6) that all calls below except rebase() use.
  void place(In q);
  /// Returns the motion of the root at its unknowns and their rates (6 each).
  FrameMotion motion(In q, In v, In a) const;
  /// Writes the generalised forces (6) of a wrench at the root, in the root's components.
  void residual(const Vec& force, const Vec& moment, Out r) const;
  /// Moves the reference if theta has grown; true if q and v have changed.
  bool rebase(InOut q, InOut v);
  /// Takes the frame of the start as reference.
  void reset() { reference_ = start_.frame; }
  /// Returns the reference frame.
  const Frame& reference() const { return reference_; }
  /// Restores an earlier reference().
  void recall(const Frame& reference) { reference_ = reference; }

  /// Returns the frame at the unknowns of place().
  const Frame& frame() const { return frame_; }
  /// Returns the rotation from the reference to the frame, as a helix of length 1.
  const Helix& joint() const { return joint_; }
  /// Returns the tip of joint(), as argument of its functions.
  const Helix::At<double>& at() const { return at_; }

 private:
  FreeRoot start_;
  Frame reference_;
  Helix joint_;
  Helix::At<double> at_{};
  Frame frame_;
};

}  // namespace tress::models
