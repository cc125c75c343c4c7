#pragma once

#include <span>

#include "models/head/reduced_kernel.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// A block of strands whose points are to be read. Kind: see
/// models/head/reduced_kernel.h.
template <class Kind>
struct ReducedPlaces {
  using T = typename Kind::Real;  // scalar: a number, or a pack of SIMD lanes

  RootPose pose;                        // pose and motion of the head
  Vec3<T> from;                         // positions of the roots in the head
  FrameOf<T> frame;                     // frames of the roots in the head
  ReducedMotion<T> root;                // motion of the roots
  T length;                             // length of an element
  std::size_t elements;                 // number of elements
  const typename Kind::Rule* rule;      // of the points of an element
  const typename Kind::Unknowns* q;     // unknowns (elements)
  const typename Kind::Unknowns* rate;  // their rates (elements)
  double unit, speed;                   // units of length and velocity, m and m/s

  /// Root and tips of elements of the first `strands` lanes (m), strand after strand, and
  /// their velocities (m/s) unless `v` is empty. Compiled as ReducedLoads: what effects
  /// see of it is the same bits for any number of lanes.
  void write(std::size_t strands, std::span<double> x, std::span<double> v) const;
};

}  // namespace tress::models
