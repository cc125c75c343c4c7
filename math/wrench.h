#pragma once

#include "math/matrix3.h"

namespace tress {

/// Force and moment about a frame's origin, in the frame's components.
template <class T>
struct WrenchOf {
  Vec3<T> force, moment;  // force, and moment about the origin
};
/// Wrench in double precision.
using Wrench = WrenchOf<double>;

}  // namespace tress
