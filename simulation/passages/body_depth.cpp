#include "simulation/passages/body_depth.h"

#include <algorithm>

namespace tress::simulation {
namespace {

std::vector<int> before_of(const MaterialPoints& points) {
  std::vector<int> before;
  for (int i = 0; i < points.count(); ++i) before.push_back(points.before(i));
  return before;
}

}  // namespace

BodyDepth::BodyDepth(const models::Effects& effects, MaterialPoints& points)
    : passages_(effects, before_of(points)) {
  for (const auto& effect : effects) {
    if (effect->penetration(0, {})) bodies_.push_back(effect);
  }
  x_.resize(3 * passages_.places().points());
  old_x_.resize(x_.size());
}

void BodyDepth::look(MaterialPoints& points, double from, In old_q, double t, In q) {
  // Coordinates relative to a root stay as they are where it teleports.
  if (from == t_ && std::ranges::equal(old_q, q_)) {
    old_x_.swap(x_);
  } else {
    points.positions(from, old_q, old_x_);
  }
  points.positions(t, q, x_);
  t_ = t;
  q_.assign(q.begin(), q.end());
  const std::vector<double> places = passages_.places().of(x_);
  for (const auto& body : bodies_) {
    seen.deepest = std::max(seen.deepest, body->penetration(t, places).value_or(0));
  }
  const auto missed = passages_.find({from, t, old_x_, x_}).missed;
  if (!missed) return;
  seen.deepest = std::max(seen.deepest, missed->depth);
  if (!seen.missed) seen.missed = missed;
}

}  // namespace tress::simulation
