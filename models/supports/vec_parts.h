#pragma once

#include "math/vec3.h"

namespace tress::models {

/// Returns entry i of a vector, 0 to 2.
inline double component(const Vec& x, int i) { return i == 0 ? x.x : i == 1 ? x.y : x.z; }

/// Returns the products of the entries of two vectors.
inline Vec entrywise(const Vec& a, const Vec& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

}  // namespace tress::models
