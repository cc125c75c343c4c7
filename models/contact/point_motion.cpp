#include "models/contact/point_motion.h"

#include <algorithm>

namespace tress::models {

void PointMotion::extrapolate(double t, In x, In v) {
  t_ = t;
  moves_ = 1;
  at_.resize(x.size() / 3);
  for (std::size_t i = 0; i < at_.size(); ++i) {
    at_[i] = {load3(&x[3 * i]), load3(&v[3 * i]), {}, {}};
  }
}

void PointMotion::interpolate(double t, double end, In x, In v, In y, In w) {
  extrapolate(t, x, v);
  const double h = end - t;
  for (std::size_t i = 0; i < at_.size(); ++i) {
    Cubic& p = at_[i];
    const Vec mean = (1 / h) * (load3(&y[3 * i]) - p.x), last = load3(&w[3 * i]);
    p.square = (1 / h) * (3 * mean - 2 * p.v - last);
    p.cube = (1 / (h * h)) * (p.v + last - 2 * mean);
  }
}

double PointMotion::range(double elapsed) const {
  double most = 0;
  for (const Cubic& p : at_) {
    const double far =
        elapsed * (norm(p.v) + elapsed * (norm(p.square) + elapsed * norm(p.cube)));
    if (!(far <= most)) most = far;
  }
  return most;
}

}  // namespace tress::models
