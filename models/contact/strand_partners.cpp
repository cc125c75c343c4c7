#include "models/contact/strand_partners.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::models {
namespace {

constexpr double first_margin = 0.5;                     // over the reach
constexpr double least_margin = 0.1, most_margin = 1.0;  // the same
// What a list costs to make over what it costs to go through; see best_margin().
constexpr double making_over_using = 24;
// Displacement over the reach that ends an epoch: larger searches against more sorting.
constexpr double most_moved = 0.4;

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
  const bool first = nodes_.empty();
  range_ = range;
  step_ = {};
  if (!first) {
    roots_.clear();
    roots_before_.clear();
    for (std::size_t k = 0; k < cells_.polylines(); ++k) {
      const auto root = static_cast<std::size_t>(cells_.first(k));
      const Vec now = load3(&x[3 * root]);
      if (!is_finite(now) || !is_finite(nodes_[root].x)) continue;
      roots_.push_back(now);
      roots_before_.push_back(nodes_[root].x);
    }
    step_ = rigid_motion(roots_before_, roots_);
    roots_before_.clear();
    roots_.clear();
    for (std::size_t k = 0; k < cells_.polylines(); ++k) {
      const auto root = static_cast<std::size_t>(cells_.first(k));
      const Vec now = load3(&x[3 * root]);
      if (!is_finite(now) || !is_finite(before_[root])) continue;
      roots_.push_back(now);
      roots_before_.push_back(before_[root]);
    }
    head_ = rigid_motion(roots_before_, roots_);
  }
  const bool came = place(x, v, loop);
  ++updates_;
  if (came) ++lists_;
  if (!first) {
    const double still = displacement({}, loop);
    moved_ = displacement(head_, loop);
    if (!(moved_ < still)) head_ = {};
    moved_ = std::min(moved_, still);
  }
  if (first || came || !(moved_ <= most_moved * reach_) || range > covered_) {
    begin_epoch(x, loop);
  }
  drift_.move(cells_, moves_, loop);
  margin_ = first ? first_margin * reach_ : best_margin();
}

/// Takes the places of the points and their displacements; whether some had none before.
bool StrandPartners::place(In x, In v, const Loop& loop) {
  const std::size_t count = cells_.points();
  const bool first = nodes_.empty();
  nodes_.resize(count);
  v_.resize(count);
  moves_.resize(count);
  came_.assign(1 + count / loop_part, 0);
  in_parts(count, loop, [&](std::size_t from, std::size_t to) {
    bool came = false;
    for (std::size_t i = from; i < to; ++i) {
      Node& node = nodes_[i];
      const Vec now = load3(&x[3 * i]), old = first ? now : node.x;
      moves_[i] = step_.back(now) - old;
      came = came || (is_finite(now) && !is_finite(old));
      const bool last = cells_.last(static_cast<int>(i));
      node = {now, last ? 0 : StraightPiece(now, load3(&x[3 * i + 3])).inverse};
      v_[i] = load3(&v[3 * i]);
    }
    came_[from / loop_part] = came ? 1 : 0;
  });
  return std::ranges::count(came_, 1) > 0;
}

/// The largest of all points' since the epoch, without that of the head.
double StrandPartners::displacement(const RigidMotion& head, const Loop& loop) {
  farthest_.assign(1 + before_.size() / loop_part, 0.0);
  in_parts(before_.size(), loop, [&](std::size_t from, std::size_t to) {
    double most = 0;
    for (std::size_t i = from; i < to; ++i) {
      const Vec moved = head.back(nodes_[i].x) - before_[i];
      const double square = dot(moved, moved);
      // What is no place is near to nothing.
      if (square > most) most = square;
    }
    farthest_[from / loop_part] = most;
  });
  return std::sqrt(*std::ranges::max_element(farthest_));
}

/// A list sees (1 + most_margin) reach() and twice the range, of which the second was
/// over before; parts are as long as the cells say, and have moved since.
void StrandPartners::begin_epoch(In x, const Loop& loop) {
  ++epochs_;
  before_.resize(nodes_.size());
  in_parts(nodes_.size(), loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) before_[i] = nodes_[i].x;
  });
  head_ = {};
  moved_ = 0;
  covered_ = 2 * range_;
  const std::vector<int> long_before(cells_.long_segments().begin(),
                                     cells_.long_segments().end());
  cells_.fill(x, (1 + first_margin) * reach_, loop);
  // Long ones are in every list, and drift_ does not know of them.
  if (!std::ranges::equal(long_before, cells_.long_segments())) ++lists_;
  const double sight = (1 + most_margin + most_moved) * reach_ + 2 * covered_ +
                       0.5 * cells_.longest_part();
  drift_.fill(cells_, x, (1 + 1e-9) * sight, loop);
}

/// Returns the margin of least cost for lists whose surroundings move by d per step
/// relative to them. A list of reach r + m has (1 + m/r)^2 times the candidates of one of
/// reach r and is rebuilt every m/d steps. The cost using (1 + m/r)^2 + making d/m is
/// least where (m/r)^2 (1 + m/r) = d/r making/(2 using).
double StrandPartners::best_margin() const {
  const double target = making_over_using * drift_.mean() / reach_;
  double share = std::sqrt(target);
  for (int k = 0; k < 4; ++k) share = std::sqrt(target / (1 + share));
  share = std::min(share, most_margin);
  // One that does not hold for a step helps nothing.
  if (drift_.mean() > share * reach_) share = least_margin;
  return std::max(share, least_margin) * reach_;
}

std::size_t StrandPartners::bytes() const {
  return cells_.bytes() + nodes_.capacity() * sizeof(Node) +
         (v_.capacity() + before_.capacity() + moves_.capacity() + roots_.capacity() +
          roots_before_.capacity()) *
             sizeof(Vec);
}

std::size_t StrandPartners::bytes_of_point(double segment, double reach) {
  // Of a part: itself, its cells, and two numbers of them.
  constexpr double point_and_lists = 500, part = 32;
  const double longest = SegmentCells::longest_part(segment, (1 + first_margin) * reach);
  return static_cast<std::size_t>(point_and_lists +
                                  part * std::max(1.0, segment / longest));
}

}  // namespace tress::models
