// Compiled without errno, so that the roots of all lanes are one instruction.
#include "models/contact/point_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/lanes.h"

namespace tress::models {
namespace {

constexpr auto four = static_cast<std::size_t>(Pack::lanes);
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
// Of lengths that are compared to decide what to look at.
constexpr double rounding = 1 + 1e-9;

/// Segments at the last update, and how fast they move: ends at s = 0 and 1.
struct Held {
  const StrandPartners& partners;
  const StraightPiece& piece(int i) const { return partners.piece(i); }
  Vec velocity(int i) const { return partners.velocity(i); }
};
/// A time after it.
struct Moving {
  const PointMotion& motion;
  double elapsed;
  StraightPiece piece(int i) const {
    const auto at = static_cast<std::size_t>(i);
    return {motion.place(at, elapsed), motion.place(at + 1, elapsed)};
  }
  Vec velocity(int i) const {
    return motion.velocity(static_cast<std::size_t>(i), elapsed);
  }
};

/// Of a number that is in memory: one instruction.
Pack all(double x) { return {x, x, x, x}; }
Vec3<Pack> all(const Vec& x) { return {all(x.x), all(x.y), all(x.z)}; }

struct Nearest {
  Pack s;
  Vec3<Pack> gap;
};
[[gnu::always_inline]] inline Nearest nearest(const Vec3<Pack>& x,
                                              const StraightPiece& to) {
  const Vec3<Pack> d = x - all(to.start), edge = all(to.edge);
  const Pack s = larger(smaller(all(to.inverse) * dot(d, edge), Pack(1)), Pack(0));
  return {s, d - s * edge};
}

[[gnu::always_inline]] inline Vec3<Pack> choose(const Pack& x, const Pack& y,
                                                const Vec3<Pack>& yes,
                                                const Vec3<Pack>& no) {
  return {where_less(x, y, yes.x, no.x), where_less(x, y, yes.y, no.y),
          where_less(x, y, yes.z, no.z)};
}

bool there(const Vec3<Pack>& x, int lane) { return is_finite(lane_of(x, lane)); }

/// Of lanes with a number; infinity if there is none.
double smallest(const Pack& of) {
  const Pack x = where_less(of, Pack(infinity), of, Pack(infinity));
  return std::min(std::min(x[0], x[1]), std::min(x[2], x[3]));
}

}  // namespace

/// `still`: partners stay until the next update, and their drift is known.
template <class Segments>
[[gnu::always_inline]] inline void PointGroups::sum_loads(Group& group,
                                                          const ContactLaw& law,
                                                          const Segments& segments,
                                                          const Vec3<Pack>& of_v,
                                                          bool still, FourLoads& to) {
  FourLoads sum{};
  const Vec3<Pack> x = group.x;
  const double reach = partners_->reach();
  const Pack far(reach * reach), zero(0), one(1);
  const auto used = static_cast<float>(group.used);
  found_.resize(group.list.size());
  for (auto candidate = group.list.begin(); candidate != group.list.end();) {
    // The nearest point of one strand: on which of its segments within reach, and where.
    Pack least(infinity), s(0), which(0);
    int count = 0;
    for (bool more = true; more; ++candidate) {
      more = (candidate->segment & 1) == 0;
      if (used < candidate->wake) continue;
      const int segment = candidate->segment >> 1;
      const Nearest at = nearest(x, segments.piece(segment));
      const Pack square = dot(at.gap, at.gap);
      if (!any_less(square, far)) {
        if (still) candidate->wake = wakes_at(group, smallest(square));
        continue;
      }
      s = where_less(square, least, at.s, s);
      which = where_less(square, least, Pack(static_cast<double>(count)), which);
      least = where_less(square, least, square, least);
      found_[static_cast<std::size_t>(count++)] = segment;
    }
    if (count == 0) continue;
    Vec3<Pack> start, edge, v, faster;
    Pack inverse;
    for (int k = 0; k < count; ++k) {
      const int i = found_[static_cast<std::size_t>(k)];
      const StraightPiece& piece = segments.piece(i);
      const Vec here = segments.velocity(i), change = segments.velocity(i + 1) - here;
      if (k == 0) {
        start = all(piece.start);
        edge = all(piece.edge);
        inverse = all(piece.inverse);
        v = all(here);
        faster = all(change);
        continue;
      }
      const Pack before(k - 0.5);
      start = choose(before, which, all(piece.start), start);
      edge = choose(before, which, all(piece.edge), edge);
      inverse = where_less(before, which, all(piece.inverse), inverse);
      v = choose(before, which, all(here), v);
      faster = choose(before, which, all(change), faster);
    }
    // Lanes out of reach get a gap without force.
    const Vec3<Pack> gap =
        choose(least, far, x - start - s * edge, Vec3<Pack>(Vec{2 * reach, 0, 0}));
    const Vec3<Pack> u = choose(least, far, of_v - v - s * faster, Vec3<Pack>(Vec{}));
    const ContactLaw::Factors<Pack> at = law.factors(gap);
    sum.force = sum.force + at.push * gap - at.drag * u;
    sum.by_velocity -= at.drag;
    // Between the ends of a segment its nearest point follows x: ds/dx = `along`.
    const Pack follows = where_less(
        least, far, where_less(zero, s, where_less(s, one, inverse, zero), zero), zero);
    const Vec3<Pack> along = follows * edge;
    const Vec3<Pack> column = at.push_slope * gap - at.drag_slope * u;
    // Rows of push I + column d^T, less their product with ds/dx.
    const Pack by_edge = dot(gap, edge);
    const Vec3<Pack> by_s = at.push * edge + by_edge * column - at.drag * faster;
    sum.by_place[0] = sum.by_place[0] + column.x * gap - by_s.x * along;
    sum.by_place[1] = sum.by_place[1] + column.y * gap - by_s.y * along;
    sum.by_place[2] = sum.by_place[2] + column.z * gap - by_s.z * along;
    sum.by_place[0].x += at.push;
    sum.by_place[1].y += at.push;
    sum.by_place[2].z += at.push;
  }
  to = sum;
}

/// The value of `used` up to which what is at a distance d (its square is given) stays
/// out of reach r. A list knows no farther than it sees, r + room: up to there d - r is
/// at least (d^2 - r^2)/(2 r + room). Less by what a float is rounded by.
float PointGroups::wakes_at(const Group& group, double square) const {
  constexpr double less = 1 - 1e-6;
  const double reach = partners_->reach(),
               away = (square - reach * reach) / (2 * reach + group.room);
  return static_cast<float>(less *
                            (group.used + std::min(away, group.room - group.used)));
}

PointGroups::PointGroups(const StrandPartners& partners, int strand)
    : partners_(&partners), strand_(strand) {}

void PointGroups::ready(In x, In length) {
  groups_.resize((length.size() + four - 1) / four);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    Vec3<Pack> now;
    for (std::size_t lane = 0; lane < four; ++lane) {
      const std::size_t i = four * g + lane;
      const bool there = i < length.size() && length[i] != 0;
      const Vec at = there ? load3(&x[3 * i]) : Vec{nowhere, nowhere, nowhere};
      set_lane(now, static_cast<int>(lane), at);
    }
    const bool held = holds(group, now);
    group.x = now;
    group.update = partners_->updates();
    if (!held) list(group);
  }
}

/// Whether all that is near now is listed. Since points were last looked at, they and
/// what is near them have moved, but not nearer to each other than by as much as is left.
bool PointGroups::holds(Group& group, const Vec3<Pack>& x) const {
  const long updates = partners_->updates() - group.update;
  if (group.lists != partners_->lists() || updates > 1) return false;
  Box drift{{0, 0, 0}, {0, 0, 0}};
  if (updates == 1) {
    drift = Box::none();
    const Vec3<Pack> at_epoch = partners_->at_epoch(x);
    const Box* last = nullptr;
    for (int lane = 0; lane < Pack::lanes; ++lane) {
      if (!there(at_epoch, lane)) continue;
      const Box& one = partners_->drift(lane_of(at_epoch, lane));
      if (&one == last || one.empty()) continue;
      drift.include(one);
      last = &one;
    }
    if (drift.empty()) return true;  // nothing is near
  }
  const Vec3<Pack> before = updates == 1 ? partners_->before(x) : x;
  const Vec3<Pack> moved =
      before - group.x - Vec3<Pack>(0.5 * (drift.least + drift.most));
  // Lanes without a point have not moved.
  const Pack square = where_less(dot(x, x), Pack(infinity), dot(moved, moved), Pack(0));
  group.used += 0.5 * norm(drift.most - drift.least);
  const double left = group.room - partners_->range() - group.used;
  if (!(left >= 0) || !all_up_to(square, left * left)) return false;
  group.used += std::sqrt(largest(square));
  return true;
}

void PointGroups::list(Group& group) {
  ++made_;
  group.lists = partners_->lists();
  group.used = 0;
  group.room = partners_->margin() + partners_->range();
  group.list.clear();
  const double wide = (partners_->reach() + group.room) * rounding;
  const Vec3<Pack> at_epoch = partners_->at_epoch(group.x);
  Box box = Box::none();
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    if (there(at_epoch, lane)) box.include(lane_of(at_epoch, lane));
  }
  if (box.empty()) return;
  box.grow(wide + partners_->moved());
  const SegmentCells& segments = partners_->segments();
  segments.reaching_into(box, found_);
  const int own = segments.first(static_cast<std::size_t>(strand_)),
            other = segments.first(static_cast<std::size_t>(strand_) + 1);
  const auto is_own = [=](int i) { return i >= own && i < other; };
  std::size_t near = 0;
  by(instructions_, [&] {
    const Pack square(wide * wide);
    for (const int i : found_) {
      const Vec3<Pack> gap = nearest(group.x, partners_->piece(i)).gap;
      // Without a branch, which nobody could foresee.
      found_[near] = i;
      near += any_less(dot(gap, gap), square) && !is_own(i) ? 1 : 0;
    }
  });
  found_.resize(near);
  for (const int i : segments.long_segments()) {
    if (!is_own(i)) found_.push_back(i);
  }
  std::ranges::sort(found_);
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  group.list.reserve(found_.size());
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const bool last = k + 1 == found_.size() ||
                      segments.polyline(found_[k]) != segments.polyline(found_[k + 1]);
    group.list.push_back({2 * found_[k] + (last ? 1 : 0), 0});
  }
}

void PointGroups::loads(std::size_t group, const ContactLaw& law, In v, double elapsed,
                        FourLoads& to) {
  Group& g = groups_[group];
  to = {};
  if (g.list.empty()) return;
  Vec3<Pack> of_v{};
  for (std::size_t lane = 0; lane < four; ++lane) {
    const std::size_t i = four * group + lane;
    if (3 * i < v.size()) set_lane(of_v, static_cast<int>(lane), load3(&v[3 * i]));
  }
  by(instructions_, [&] {
    if (elapsed == 0) {
      const bool still =
          partners_->range() == 0 && partners_->segments().long_segments().empty();
      sum_loads(g, law, Held{*partners_}, of_v, still, to);
    } else {
      sum_loads(g, law, Moving{partners_->motion(), elapsed}, of_v, false, to);
    }
  });
}

std::size_t PointGroups::bytes() const {
  std::size_t sum = groups_.capacity() * sizeof(Group) + found_.capacity() * sizeof(int);
  for (const Group& group : groups_) {
    sum += group.list.capacity() * sizeof(Candidate);
  }
  return sum;
}

}  // namespace tress::models
