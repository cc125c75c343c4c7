#pragma once

#include <span>

#include "models/head/reduced_kernel.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// A block of strands whose points are to be read. Kind: see
/// models/head/reduced_kernel.h.
template <class Kind>
struct ReducedPlaces {
  using T = typename Kind::Real;

  RootPose pose;          // of the head
  Vec3<T> from;           // of the roots in the head, from its position
  FrameOf<T> frame;       // of the roots in the head
  ReducedMotion<T> root;  // their motion
  T length;               // of an element
  std::size_t elements;
  const Vec3<T>*q, *rate;  // (elements)
  double unit, speed;      // of length and velocity, m, m/s

  /// Root and tips of elements of the first `strands` lanes (m), strand after strand, and
  /// their velocities (m/s) unless `v` is empty. Compiled as ReducedLoads: what effects
  /// see of it is the same bits for any number of lanes.
  void write(std::size_t strands, std::span<double> x, std::span<double> v) const;
};

}  // namespace tress::models
