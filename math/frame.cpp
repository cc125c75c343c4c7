#include "math/frame.h"

namespace tress {

bool is_rotation(const Frame& frame) {
  const Vec axes[] = {frame.e0, frame.e1, frame.e2};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double off = std::abs(dot(axes[i], axes[j]) - (i == j ? 1 : 0));
      if (!(off <= 1e-12)) return false;  // NaN too
    }
  }
  return dot(cross(frame.e0, frame.e1), frame.e2) > 0;
}

}  // namespace tress
