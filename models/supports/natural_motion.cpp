#include "models/supports/natural_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/piecewise_linear.h"
#include "models/strand/geometry.h"

namespace tress::models {

namespace {

/// Turn of a section from the natural half of the model to another.
Frame turn_between(const Vec& model, const Vec& before, const Vec& after, double part) {
  const Vec now = before + part * (after - before), off = now - model;
  if (norm(off) == 0) return {};
  return helix_turn(model, -1) * helix_turn(now, 1);
}

}  // namespace

NaturalMotion::Halves NaturalMotion::halves(const Strand& strand) {
  const Segment &first = strand.segments.front(), &last = strand.segments.back();
  return {(-0.5 * first.length) * first.natural, (0.5 * last.length) * last.natural};
}

void NaturalMotion::set(NaturalStrains& strains, double t) {
  if (begun_ && t == set_) return;
  set_beyond(strains, t, 0);
  set_ = t;
  begun_ = true;
}

void NaturalMotion::set_beyond(NaturalStrains& strains, double t, double ahead) {
  const auto [before, after, within] = between_rows(rows_, t, &Row::time);
  const double interval = after->time - before->time;
  const double part = within + (interval > 0 ? ahead / interval : 0);
  now_.resize(before->values.size());
  for (std::size_t i = 0; i < now_.size(); ++i) {
    now_[i] = std::lerp(before->values[i], after->values[i], part);
  }
  strains.set_natural(now_);
  const Halves &from = before->halves, &to = after->halves;
  to_root_ = turn_between(model_.root, from.root, to.root, part);
  to_tip_ = turn_between(model_.tip, from.tip, to.tip, part);
  begun_ = false;
}

double NaturalMotion::interval(double t) const {
  if (rows_.empty()) return 0;
  const auto [before, after, part] = between_rows(rows_, t, &Row::time);
  return after->time - before->time;
}

double NaturalMotion::next_breakpoint(double t) const {
  const auto after = std::ranges::upper_bound(rows_, t, {}, &Row::time);
  return after == rows_.end() ? std::numeric_limits<double>::infinity() : after->time;
}

}  // namespace tress::models
