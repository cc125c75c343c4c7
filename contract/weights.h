#pragma once

namespace tress {

/// Weights of S(w) = w.acc dr/da + w.vel dr/dv + w.pos dr/dq (contract/system.h).
struct Weights {
  double acc = 0;  // factor of dr/da
  double vel = 0;  // factor of dr/dv
  double pos = 0;  // factor of dr/dq
};

}  // namespace tress
