#pragma once

#include "contract/forms/loaded_tangent.h"
#include "contract/forms/sections.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Rotation c from a wall to a section, about the axes of the wall (rad), and its
/// derivatives by time. With phi the angle of the rotation:
///
///     frame              c = 4 tan(phi/4) times its axis,
///     tangent, in_plane  c = 2 tan(phi/2) times its axis, phi the angle between
///     tangents.
///
/// Both are the rotation vector up to terms of third order. c.x is 0 for tangents. The
/// measures are smooth up to a full turn and to half a turn, respectively; that of frames
/// takes the shorter way round.
class SectionGap {
 public:
  /// Computes the rotation between two motions.
  SectionGap(Sections::Turning turning, const RootPose& wall,
             const SectionMotion& section);

  Vec value, rate, acceleration;  // c, c', c''
  /// Returns the moment (N m, world components) on the section that is work-conjugate to
  /// `stress`: moment . (relative angular velocity) = stress . c'.
  Vec moment(const Vec& stress) const;

 private:
  Sections::Turning turning_;
  Frame wall_;
  double divisor_;  // 1 + cosine of a part of the angle
  double scalar_ = 1;
  Vec vector_;  // of the quaternion, or the section's tangent, in the wall's components
};

/// Computes the moment C^T stress on a section and its derivatives, where c' = C omega.
/// The stress (N m, of c) changes by `stiffness` times c and by `friction` times c'.
///
/// No differences are needed. Let b(x, x) be the acceleration c'' at a constant angular
/// velocity x, and b(x, y) the symmetric bilinear function. The derivative of C y along a
/// rotation x is then b(x, y) - C (x x y)/2.
SectionLoad section_load(Sections::Turning turning, const RootPose& wall,
                         const SectionMotion& section, const Vec& stress,
                         const Vec& stiffness, const Vec& friction);

}  // namespace tress::models
