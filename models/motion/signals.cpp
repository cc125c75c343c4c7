#include "models/motion/signals.h"

namespace tress::models {

Signal there_and_back(double height, double duration) {
  return sum(smooth_step(height, 0, duration), smooth_step(-height, duration, duration));
}

}  // namespace tress::models
