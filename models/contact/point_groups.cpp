// Compiled without errno, so that the roots of all lanes are one instruction.
#include "models/contact/point_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "math/lanes.h"

namespace tress::models {
namespace {

constexpr auto eight = static_cast<std::size_t>(points_of_group);
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
// Of lengths that are compared to decide what to look at.
constexpr double rounding = 1 + 1e-9;

/// Segments at the last update.
struct Held {
  const StrandPartners& partners;
  const Vec& place(int i) const { return partners.place(i); }
  double inverse(int i) const { return partners.inverse(i); }
  const Vec& velocity(int i) const { return partners.velocity(i); }
};
/// A time after it.
struct Moving {
  const PointMotion& motion;
  double elapsed;
  Vec place(int i) const { return motion.place(static_cast<std::size_t>(i), elapsed); }
  double inverse(int i) const { return StraightPiece(place(i), place(i + 1)).inverse; }
  Vec velocity(int i) const {
    return motion.velocity(static_cast<std::size_t>(i), elapsed);
  }
};

template <class P>
P load(const GroupNumbers& x, std::size_t from) {
  return P::load(&x[from]);
}
template <class P>
Vec3<P> load(const GroupVectors& x, std::size_t from) {
  return {load<P>(x.x, from), load<P>(x.y, from), load<P>(x.z, from)};
}
template <class P>
void store(const P& x, std::size_t from, GroupNumbers& to) {
  for (int lane = 0; lane < lanes<P>; ++lane) {
    to[from + static_cast<std::size_t>(lane)] = x[lane];
  }
}
template <class P>
void store(const Vec3<P>& x, std::size_t from, GroupVectors& to) {
  store(x.x, from, to.x);
  store(x.y, from, to.y);
  store(x.z, from, to.z);
}

/// Of a number in memory: one instruction, without a sum.
template <class P>
[[gnu::always_inline]] inline P all(double x) {
  return [x]<int... lane>(std::integer_sequence<int, lane...>) {
    const typename P::Vector one{x};
    return P(__builtin_shufflevector(one, one, (0 * lane)...));
  }
  (std::make_integer_sequence<int, P::lanes>{});
}
template <class P>
[[gnu::always_inline]] inline Vec3<P> all(const Vec& x) {
  return {all<P>(x.x), all<P>(x.y), all<P>(x.z)};
}

/// Where on a segment is nearest to what is at d from its start.
template <class P>
[[gnu::always_inline]] inline P nearest(const Vec3<P>& d, const Vec3<P>& edge,
                                        const P& inverse) {
  return larger(smaller(inverse * dot(d, edge), P(1)), P(0));
}
template <class P>
[[gnu::always_inline]] inline P square_of(const Vec3<P>& d) {
  return dot(d, d);
}

template <class P>
[[gnu::always_inline]] inline Vec3<P> choose(const P& x, const P& y, const Vec3<P>& yes,
                                             const Vec3<P>& no) {
  return {where_less(x, y, yes.x, no.x), where_less(x, y, yes.y, no.y),
          where_less(x, y, yes.z, no.z)};
}

/// Calls work(from, pack) for the points of a group, pack by pack: eight together where
/// registers are that wide.
template <class F>
void by_packs(Instructions instructions, const F& work) {
  if (instructions == Instructions::avx512) {
    by(instructions, [&] { work(std::size_t{0}, PackOf<double, 8>{}); });
  } else {
    for (std::size_t from = 0; from < eight; from += Pack::lanes) work(from, Pack{});
  }
}

/// Sorts them, ascending, but for those that equal an earlier one, which may become -1.
/// Few are sorted without branches: as many as are less come before.
void sort(std::vector<int>& numbers) {
  using Ints __attribute__((vector_size(32))) = int;
  constexpr std::size_t width = 8, few = 160;
  const std::size_t count = numbers.size();
  if (count > few) {
    std::ranges::sort(numbers);
    return;
  }
  alignas(sizeof(Ints)) std::array<int, few> all, rank;
  std::ranges::copy(numbers, all.begin());
  for (std::size_t i = 0; i < count; i += width) {
    Ints these, less{};
    std::memcpy(&these, &all[i], sizeof these);
    for (std::size_t k = 0; k < count; ++k) less -= all[k] < these;
    std::memcpy(&rank[i], &less, sizeof less);
  }
  std::ranges::fill(numbers, -1);
  for (std::size_t i = 0; i < count; ++i) {
    numbers[static_cast<std::size_t>(rank[i])] = all[i];
  }
}

}  // namespace

/// Those of the points from `from` on.
template <class P, class Segments>
[[gnu::always_inline]] inline void PointGroups::add_up(
    const Group& group, std::size_t from, const GroupVectors& of_v, const ContactLaw& law,
    const Segments& segments, GroupLoads& to) {
  const Vec3<P> x = load<P>(group.x, from), points_v = load<P>(of_v, from);
  const double reach = law.reach();
  const P far(reach * reach), zero(0), one(1);
  Vec3<P> force{zero, zero, zero}, rows[3] = {force, force, force};
  P by_velocity(0);
  for (auto run = group.list.begin(); run != group.list.end();) {
    // The nearest point of one strand: on which of its segments within reach, and where.
    const auto first = run;
    P least = far, s(0), number(0), which(0);
    for (bool more = true; more; ++run) {
      more = !run->last;
      const int end = run->first + static_cast<int>(run->count);
      Vec3<P> start = all<P>(segments.place(run->first));
      for (int i = run->first; i < end; ++i) {
        const Vec3<P> next = all<P>(segments.place(i + 1));
        const Vec3<P> d = x - start, edge = next - start;
        const P here = nearest(d, edge, all<P>(segments.inverse(i))),
                square = square_of(d - here * edge);
        s = where_less(square, least, here, s);
        which = where_less(square, least, number, which);
        least = where_less(square, least, square, least);
        number += one;
        start = next;
      }
    }
    if (!any_less(least, far)) continue;
    Vec3<P> start, edge, v, faster;
    P inverse(0), before(-0.5);
    for (auto part = first; part != run; ++part) {
      const int end = part->first + static_cast<int>(part->count);
      Vec3<P> here = all<P>(segments.place(part->first)),
              here_v = all<P>(segments.velocity(part->first));
      for (int i = part->first; i < end; ++i) {
        const Vec3<P> next = all<P>(segments.place(i + 1)),
                      next_v = all<P>(segments.velocity(i + 1));
        start = choose(before, which, here, start);
        edge = choose(before, which, next - here, edge);
        inverse = where_less(before, which, all<P>(segments.inverse(i)), inverse);
        v = choose(before, which, here_v, v);
        faster = choose(before, which, next_v - here_v, faster);
        before += one;
        here = next;
        here_v = next_v;
      }
    }
    // Lanes out of reach get a gap without force.
    const Vec3<P> gap =
        choose(least, far, x - start - s * edge, Vec3<P>(Vec{2 * reach, 0, 0}));
    const Vec3<P> u = choose(least, far, points_v - v - s * faster, Vec3<P>(Vec{}));
    const ContactLaw::Factors<P> at = law.factors(gap);
    force = force + at.push * gap - at.drag * u;
    by_velocity -= at.drag;
    // Between the ends of a segment its nearest point follows x: ds/dx = `along`.
    const P follows = where_less(zero, s * (one - s), inverse, zero);
    const Vec3<P> along = follows * edge;
    const Vec3<P> column = at.push_slope * gap - at.drag_slope * u;
    // Rows of push I + column d^T, less their product with ds/dx.
    const P by_edge = dot(gap, edge);
    const Vec3<P> by_s = at.push * edge + by_edge * column - at.drag * faster;
    rows[0] = rows[0] + column.x * gap - by_s.x * along;
    rows[1] = rows[1] + column.y * gap - by_s.y * along;
    rows[2] = rows[2] + column.z * gap - by_s.z * along;
    rows[0].x += at.push;
    rows[1].y += at.push;
    rows[2].z += at.push;
  }
  store(force, from, to.force);
  for (std::size_t i = 0; i < 3; ++i) store(rows[i], from, to.by_place[i]);
  store(by_velocity, from, to.by_velocity);
}

PointGroups::PointGroups(const StrandPartners& partners, int strand,
                         Instructions instructions)
    : partners_(&partners), strand_(strand), instructions_(instructions) {}

void PointGroups::ready(In x, In length) {
  groups_.resize((length.size() + eight - 1) / eight);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    GroupVectors now;
    for (std::size_t lane = 0; lane < eight; ++lane) {
      const std::size_t i = eight * g + lane;
      const bool there = i < length.size() && length[i] != 0;
      const Vec at = there ? load3(&x[3 * i]) : Vec{nowhere, nowhere, nowhere};
      now.x[lane] = at.x;
      now.y[lane] = at.y;
      now.z[lane] = at.z;
    }
    const bool held = holds(group, now);
    group.x = now;
    group.update = partners_->updates();
    if (!held) list(group);
  }
}

/// Whether all that is near now is listed. Since points were last looked at, they and
/// what is near them have moved, but not nearer to each other than by as much as is left.
bool PointGroups::holds(Group& group, const GroupVectors& x) const {
  const long updates = partners_->updates() - group.update;
  if (group.lists != partners_->lists() || updates > 1) return false;
  GroupVectors at_epoch, moved;
  by_packs(instructions_, [&]<class P>(std::size_t from, const P&) {
    const Vec3<P> now = load<P>(x, from),
                  before = updates == 1 ? partners_->before(now) : now;
    store(partners_->at_epoch(now), from, at_epoch);
    store(before - load<P>(group.x, from), from, moved);
  });
  Box drift{{0, 0, 0}, {0, 0, 0}};
  if (updates == 1) {
    drift = Box::none();
    const Box* last = nullptr;
    for (std::size_t lane = 0; lane < eight; ++lane) {
      const Vec at = lane_of(at_epoch, lane);
      if (!is_finite(at)) continue;
      const Box& one = partners_->drift(at);
      if (&one == last || one.empty()) continue;
      drift.include(one);
      last = &one;
    }
    if (drift.empty()) return true;  // nothing is near
  }
  const Vec middle = 0.5 * (drift.least + drift.most);
  double most = 0;
  for (std::size_t lane = 0; lane < eight; ++lane) {
    const Vec off = lane_of(moved, lane) - middle;
    const double square = dot(off, off);
    // Lanes without a point have not moved.
    if (is_finite(lane_of(x, lane)) && !(square <= most)) most = square;
  }
  group.used += 0.5 * norm(drift.most - drift.least);
  const double left = group.room - partners_->range() - group.used;
  if (!(left >= 0) || !(most <= left * left)) return false;
  group.used += std::sqrt(most);
  return true;
}

void PointGroups::list(Group& group) {
  ++made_;
  group.lists = partners_->lists();
  group.used = 0;
  group.room = partners_->margin() + partners_->range();
  group.list.clear();
  const double wide = (partners_->reach() + group.room) * rounding;
  Box box = Box::none();
  for (std::size_t lane = 0; lane < eight; ++lane) {
    const Vec at = partners_->at_epoch(lane_of(group.x, lane));
    if (is_finite(at)) box.include(at);
  }
  if (box.empty()) return;
  box.grow(wide + partners_->moved());
  const SegmentCells& segments = partners_->segments();
  segments.reaching_into(box, found_);
  keep_near(group, wide);
  for (const int i : segments.long_segments()) {
    if (segments.polyline(i) != strand_) found_.push_back(i);
  }
  sort(found_);
  runs_.clear();
  for (const int i : found_) {
    if (!runs_.empty()) {
      Run& run = runs_.back();
      const int next = run.first + static_cast<int>(run.count);
      if (i < next) continue;  // one of those before
      if (i == next) {
        ++run.count;
        continue;
      }
      run.last = segments.polyline(run.first) != segments.polyline(i) ? 1 : 0;
    }
    runs_.push_back({i, 1, 1});
  }
  group.list = runs_;
}

/// Drops what is farther from all points than that, and the own strand.
void PointGroups::keep_near(const Group& group, double distance) {
  const SegmentCells& segments = partners_->segments();
  const int own = segments.first(static_cast<std::size_t>(strand_)),
            other = segments.first(static_cast<std::size_t>(strand_) + 1);
  const auto is_own = [=](int i) { return i >= own && i < other; };
  std::size_t near = 0;
  const auto keep = [&](auto... packs) {
    for (const int i : found_) {
      const StraightPiece piece = partners_->piece(i);
      const auto is_near = [&]<class P>(const Vec3<P>& x) {
        const Vec3<P> d = x - all<P>(piece.start), edge = all<P>(piece.edge);
        const P s = nearest(d, edge, all<P>(piece.inverse));
        return any_less(square_of(d - s * edge), P(distance * distance));
      };
      // Without a branch, which nobody could foresee.
      found_[near] = i;
      near += !is_own(i) && (is_near(packs) | ...) ? 1 : 0;
    }
  };
  if (instructions_ == Instructions::avx512) {
    by(instructions_, [&] { keep(load<PackOf<double, 8>>(group.x, 0)); });
  } else {
    keep(load<Pack>(group.x, 0), load<Pack>(group.x, Pack::lanes));
  }
  found_.resize(near);
}

void PointGroups::loads(std::size_t group, const ContactLaw& law, In v, double elapsed,
                        GroupLoads& to) const {
  const Group& g = groups_[group];
  if (g.list.empty()) {
    to = {};
    return;
  }
  GroupVectors of_v{};
  for (std::size_t lane = 0; lane < eight; ++lane) {
    const std::size_t i = eight * group + lane;
    if (3 * i >= v.size()) break;
    of_v.x[lane] = v[3 * i];
    of_v.y[lane] = v[3 * i + 1];
    of_v.z[lane] = v[3 * i + 2];
  }
  by_packs(instructions_, [&]<class P>(std::size_t from, const P&) {
    if (elapsed == 0) {
      add_up<P>(g, from, of_v, law, Held{*partners_}, to);
    } else {
      add_up<P>(g, from, of_v, law, Moving{partners_->motion(), elapsed}, to);
    }
  });
}

std::size_t PointGroups::bytes() const {
  std::size_t sum = groups_.capacity() * sizeof(Group) + found_.capacity() * sizeof(int);
  for (const Group& group : groups_) sum += group.list.capacity() * sizeof(Run);
  return sum;
}

}  // namespace tress::models
