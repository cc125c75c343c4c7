#include "models/contact/strand_partners.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::models {
namespace {

constexpr double first_margin = 0.5;                     // over the reach
constexpr double least_margin = 0.1, most_margin = 1.0;  // the same
// What a list costs to make over what it costs to go through; see next_margin().
constexpr double making_over_using = 4;

}  // namespace

StrandPartners::StrandPartners(std::span<const int> points, double reach)
    : reach_(reach), margin_(first_margin * reach), cells_(points) {}

void StrandPartners::hold(In x, In v, const Loop& loop) {
  motion_.hold();
  move(0, x, v, loop);
}

void StrandPartners::extrapolate(double t, double end, In x, In v, const Loop& loop) {
  motion_.extrapolate(t, x, v);
  move(end > t ? motion_.range(end - t) : 0, x, v, loop);
}

void StrandPartners::interpolate(double t, double end, In x, In v, In y, In w,
                                 const Loop& loop) {
  motion_.interpolate(t, end, x, v, y, w);
  move(end > t ? motion_.range(end - t) : 0, x, v, loop);
}

/// `range`: how far a point goes until the next update.
void StrandPartners::move(double range, In x, In v, const Loop& loop) {
  const std::size_t count = cells_.points();
  nodes_.resize(count);
  in_parts(count, loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      Node& node = nodes_[i];
      node = {load3(&x[3 * i]), load3(&v[3 * i]), 0};
      if (cells_.last(static_cast<int>(i))) continue;
      node.inverse = StraightPiece(node.x, load3(&x[3 * i + 3])).inverse;
    }
  });
  ++updates_;
  if (before_.size() == count) {
    roots_.clear();
    roots_before_.clear();
    for (std::size_t k = 0; k < cells_.polylines(); ++k) {
      const auto root = static_cast<std::size_t>(cells_.first(k));
      if (!is_finite(nodes_[root].x) || !is_finite(before_[root])) continue;
      roots_.push_back(nodes_[root].x);
      roots_before_.push_back(before_[root]);
    }
    const RigidMotion turned = rigid_motion(roots_before_, roots_);
    const double still = displacement({}, loop), with = displacement(turned, loop);
    head_ = with < still ? turned : RigidMotion{};
    strayed_ = std::min(with, still);
    moved_ = strayed_ + range;
    if (moved_ <= margin_ / 2) return;
  }
  margin_ = next_margin() + 2 * range;
  epoch_ = updates_;
  ++epochs_;
  before_.resize(count);
  in_parts(count, loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) before_[i] = nodes_[i].x;
  });
  head_ = {};
  strayed_ = 0;
  moved_ = range;
  cells_.fill(x, reach_ + margin_, loop);
}

/// The largest of all points' since the epoch, without that of the head.
double StrandPartners::displacement(const RigidMotion& head, const Loop& loop) {
  farthest_.assign(1 + before_.size() / loop_part, 0.0);
  in_parts(before_.size(), loop, [&](std::size_t from, std::size_t to) {
    double most = 0;
    for (std::size_t i = from; i < to; ++i) {
      // What is no place is near to nothing, but it may have become one.
      if (!is_finite(nodes_[i].x)) continue;
      const Vec moved = head.back(nodes_[i].x) - before_[i];
      const double square = dot(moved, moved);
      most = std::max(
          most, is_finite(before_[i]) ? square : std::numeric_limits<double>::max());
    }
    farthest_[from / loop_part] = most;
  });
  return std::sqrt(*std::ranges::max_element(farthest_));
}

/// The one of least cost at the speed of the last epoch, d per update. Lists that reach
/// r + m have (1 + m/r)^2 times the candidates of ones that reach r, and cost their
/// making every m/(2 d) updates: using (1 + m/r)^2 + making 2 d/m is least where
/// (m/r)^2 (1 + m/r) = d/r making/using.
double StrandPartners::next_margin() const {
  const double updates = static_cast<double>(updates_ - epoch_);
  if (epochs_ == 0 || !(updates > 0)) return first_margin * reach_;
  const double target = making_over_using * strayed_ / updates / reach_;
  double share = std::sqrt(target);
  for (int k = 0; k < 4; ++k) share = std::sqrt(target / (1 + share));
  return (share < most_margin ? std::max(share, least_margin) : most_margin) * reach_;
}

std::size_t StrandPartners::bytes() const {
  return cells_.bytes() + nodes_.capacity() * sizeof(Node) +
         (before_.capacity() + roots_.capacity() + roots_before_.capacity()) *
             sizeof(Vec);
}

}  // namespace tress::models
