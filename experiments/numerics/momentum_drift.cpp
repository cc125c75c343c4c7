#include "experiments/numerics/momentum_drift.h"

#include <algorithm>
#include <cmath>

namespace tress::experiments {

MomentumDrift::MomentumDrift(Energetics& energetics, In q, In v)
    : energetics_(energetics) {
  energetics_.momentum(0, q, v, start_);
  now_ = start_;
}

void MomentumDrift::see(double t, In q, In v) {
  energetics_.momentum(t, q, v, now_);
  linear_ = std::max(linear_, distance(now_.linear, start_.linear));
  angular_ = std::max(angular_, distance(now_.angular, start_.angular));
}

double MomentumDrift::norm(const Three& x) { return std::hypot(x[0], x[1], x[2]); }

double MomentumDrift::distance(const Three& x, const Three& y) {
  return norm({x[0] - y[0], x[1] - y[1], x[2] - y[2]});
}

}  // namespace tress::experiments
