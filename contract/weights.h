#pragma once

namespace tress {

/// Weights of S(w) = w.acc dr/da + w.vel dr/dv + w.pos dr/dq (contract/system.h).
struct Weights {
  double acc = 0;
  double vel = 0;
  double pos = 0;
};

}  // namespace tress
