#include "models/supports/natural_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/piecewise_linear.h"

namespace tress::models {

void NaturalMotion::set(NaturalStrains& strains, double t) {
  if (begun_ && t == set_) return;
  const auto [before, after, part] = between_rows(rows_, t, &Row::time);
  now_.resize(before->values.size());
  for (std::size_t i = 0; i < now_.size(); ++i) {
    now_[i] = std::lerp(before->values[i], after->values[i], part);
  }
  strains.set_natural(now_);
  set_ = t;
  begun_ = true;
}

double NaturalMotion::slope(double t, std::vector<double>& values,
                            std::vector<double>& change) const {
  const auto [before, after, part] = between_rows(rows_, t, &Row::time);
  values.resize(before->values.size());
  change.assign(values.size(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = std::lerp(before->values[i], after->values[i], part);
    change[i] = after->values[i] - before->values[i];
  }
  return after->time - before->time;
}

double NaturalMotion::next_breakpoint(double t) const {
  const auto after = std::ranges::upper_bound(rows_, t, {}, &Row::time);
  return after == rows_.end() ? std::numeric_limits<double>::infinity() : after->time;
}

}  // namespace tress::models
