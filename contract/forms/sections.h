#pragma once

#include <vector>

#include "contract/system.h"
#include "math/frame.h"

namespace tress {

/// Motion of a cross-section in world components.
struct SectionMotion {
  Frame frame;  // e0 the tangent; e1, e2 the axes of the section
  Vec omega;    // angular velocity, rad/s
  Vec alpha;    // angular acceleration, rad/s^2
};

/// Cross-sections at the points of MaterialPoints, an optional capability of systems.
class Sections {
 public:
  virtual ~Sections() = default;

  /// Part of a section's rotation that the coordinates determine.
  enum class Turning {
    nothing,   // no part
    in_plane,  // rotation in the plane of a planar model
    tangent,   // direction of the strand
    frame      // whole frame
  };
  /// Kind of a section.
  struct Kind {
    Turning turning = Turning::nothing;  // part that the coordinates determine
    /// True if the frame is that of the middle of the last edge, turned rigidly to the
    /// section: the model does not bend over the half edge between them.
    bool half_edge = false;
    /// True if that turn is the one of the natural shape. False: the frame is that of the
    /// middle of the edge.
    bool natural_half = false;
  };

  /// Returns the kind of the section at a point; fixed for life.
  virtual Kind section_kind(int point) const = 0;
  /// Returns the coordinates that turn a section, ascending; fixed for life.
  virtual std::vector<int> section_coordinates(int point) const = 0;
  /// Returns the frame of a section.
  virtual Frame section_frame(double t, In q, int point) = 0;
  /// Returns the motion of a section at a state (q, v, a).
  virtual SectionMotion section(double t, In q, In v, In a, int point) = 0;
  /// b += J^T moment, J = d omega/dv of a section and a moment on it (N m, world
  /// components).
  virtual void add_moment(double t, In q, int point, const Vec& moment, InOut b) = 0;
};

/// Returns the sections of a system; null if it has none.
inline Sections* sections(System& system) { return dynamic_cast<Sections*>(&system); }

}  // namespace tress
