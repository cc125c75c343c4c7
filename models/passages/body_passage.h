#pragma once

#include <cstddef>

#include "models/effects/rigid_body.h"

namespace tress::models {

/// Places of the same points at two times, (3 points) m each.
struct Paths {
  double from = 0, to = 0;  // s
  In x;                     // at `from`
  In y;                     // at `to`
};

/// Passage of points through a body, from outside to outside.
struct Passage {
  double longest = 0;     // longest path of a point over half of the body's thickness
  double depth = 0;       // m, on the deepest path through the body; 0: none
  std::size_t point = 0;  // that has this path
  double over = 0;        // length of this path over half of the body's thickness
};

/// Finds points that are outside the body at both times, on opposite sides, with the body
/// on the straight path between them in its frame. Contact at the ends of steps does not
/// see them. Points that move by less than half of the body's thickness are not searched.
Passage passage(const RigidBody& body, const Paths& paths);

/// Returns the body of an effect that is one of body(); null: it is none.
const RigidBody* body_of(const Effect& effect);

}  // namespace tress::models
