#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "models/head/near_bodies.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Bodies that may reach the strands of a batch. They are searched in the ball that holds
/// all strands, once for each time, and then by block.
class HeadBodies {
 public:
  /// Bodies found for one time; memory of one thread.
  struct Near {
    /// Time of the search, s.
    double t = std::numeric_limits<double>::quiet_NaN();
    Vec head;                             // its position, m
    std::vector<NearBody> around, reach;  // bodies that reach the head, and a block

    /// Returns true if no body reaches the head.
    bool none() const { return around.empty(); }
  };

  /// Adds a body, which must outlive it.
  void add(const RigidContact* body) { bodies_.push_back(body); }
  /// A strand that stays so near to the head's position (m).
  void include(double radius) { radius_ = std::max(radius_, radius); }

  /// Finds the bodies for a time, unless `near` is for that time.
  void look(double t, const RootMotion& head, Near& near) const {
    if (bodies_.empty() || near.t == t) return;
    near.t = t;
    near.head = head.at(t).x;
    bodies_around(bodies_, t, {near.head, radius_}, near.around);
  }
  /// Returns those of the bodies in `near` that reach a block of strands with these
  /// roots, seen from the head's position, and these lengths (m).
  template <class T>
  static std::span<const NearBody> reached(Near& near, const Vec3<T>& roots,
                                           const T& lengths) {
    bodies_near<T>(near.around, roots, lengths, near.reach);
    return near.reach;
  }

 private:
  std::vector<const RigidContact*> bodies_;
  double radius_ = 0;  // of the ball about the head's position, m
};

}  // namespace tress::models
