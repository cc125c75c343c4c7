#include "experiments/numerics/momentum_drift.h"

#include <algorithm>
#include <cmath>

namespace tress::experiments {

MomentumDrift::MomentumDrift(Energetics& energetics, In q, In v)
    : energetics_(energetics) {
  start_ = now_ = energetics_.momentum(0, q, v).value();
}

void MomentumDrift::see(double t, In q, In v) {
  now_ = energetics_.momentum(t, q, v).value();
  linear_ = std::max(linear_, distance(now_.linear, start_.linear));
  angular_ = std::max(angular_, distance(now_.angular, start_.angular));
}

double MomentumDrift::norm(const Three& x) { return std::hypot(x[0], x[1], x[2]); }

double MomentumDrift::distance(const Three& x, const Three& y) {
  return norm({x[0] - y[0], x[1] - y[1], x[2] - y[2]});
}

}  // namespace tress::experiments
