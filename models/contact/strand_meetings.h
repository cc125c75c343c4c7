#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "math/lane_choice.h"
#include "models/contact/contact_law.h"
#include "models/contact/group_loads.h"

/// Contacts of points of one strand, one per lane of a pack P, with other strands.
/// Strands are given as runs of their segments. Segments returns a point's position and
/// velocity and a segment's 1/|edge|^2.
namespace tress::models {

/// Loads a number from memory into all lanes: one instruction, without a sum.
template <class P>
[[gnu::always_inline]] inline P all(double x) {
  return [x]<int... lane>(std::integer_sequence<int, lane...>) {
    const typename P::Vector one{x};
    return P(__builtin_shufflevector(one, one, (0 * lane)...));
  }
  (std::make_integer_sequence<int, P::lanes>{});
}
/// Sets all lanes to one vector.
template <class P>
[[gnu::always_inline]] inline Vec3<P> all(const Vec& x) {
  return {all<P>(x.x), all<P>(x.y), all<P>(x.z)};
}

/// Returns the position along a segment nearest to the point at d from its start.
template <class P>
[[gnu::always_inline]] inline P nearest(const Vec3<P>& d, const Vec3<P>& edge,
                                        const P& inverse) {
  return larger(smaller(inverse * dot(d, edge), P(1)), P(0));
}
/// Returns the square of the length, lane by lane.
template <class P>
[[gnu::always_inline]] inline P square_of(const Vec3<P>& d) {
  return dot(d, d);
}
/// Returns `yes` where x < y, else `no`, lane by lane.
template <class P>
[[gnu::always_inline]] inline Vec3<P> choose(const P& x, const P& y, const Vec3<P>& yes,
                                             const Vec3<P>& no) {
  return {where_less(x, y, yes.x, no.x), where_less(x, y, yes.y, no.y),
          where_less(x, y, yes.z, no.z)};
}

/// The nearest points of one strand.
template <class P>
struct Meeting {
  std::span<const SegmentRun> runs;  // segments that were searched
  P square;  // of the distance; at least `far` (see meet) where it is out of reach
  P s;       // where on its segment
  P which;   // number of the segment among those of the runs
};

/// Computes the contact with the first strand of `runs`, and removes that strand from
/// `runs`. `far`: the square of the reach.
template <class P, class Segments>
[[gnu::always_inline]] inline Meeting<P> meet(const Vec3<P>& x, const P& far,
                                              const Segments& segments,
                                              std::span<const SegmentRun>& runs) {
  P least = far, s(0), number(0), which(0);
  std::size_t count = 0;
  for (bool more = true; more; ++count) {
    const SegmentRun& run = runs[count];
    more = !run.last;
    const int end = run.first + static_cast<int>(run.count);
    Vec3<P> start = all<P>(segments.place(run.first));
    for (int i = run.first; i < end; ++i) {
      const Vec3<P> next = all<P>(segments.place(i + 1)), d = x - start,
                    edge = next - start;
      const P here = nearest(d, edge, all<P>(segments.inverse(i))),
              square = square_of(d - here * edge);
      s = where_less(square, least, here, s);
      which = where_less(square, least, number, which);
      least = where_less(square, least, square, least);
      number += P(1);
      start = next;
    }
  }
  const std::span<const SegmentRun> of_strand = runs.first(count);
  runs = runs.subspan(count);
  return {of_strand, least, s, which};
}

/// Segments that lanes chose, each its own.
template <class P>
struct ChosenSegments {
  Vec3<P> start, edge, v, faster;  // moves at v, its end by `faster` faster
  P inverse;                       // 1/|edge|^2
};

/// Reads the segments that lanes chose.
template <class P, class Segments>
[[gnu::always_inline]] inline ChosenSegments<P> chosen(const Meeting<P>& met,
                                                       const Segments& segments) {
  ChosenSegments<P> of;
  P before(-0.5);
  of.inverse = P(0);
  for (const SegmentRun& run : met.runs) {
    const int end = run.first + static_cast<int>(run.count);
    Vec3<P> start = all<P>(segments.place(run.first)),
            v = all<P>(segments.velocity(run.first));
    for (int i = run.first; i < end; ++i) {
      const Vec3<P> next = all<P>(segments.place(i + 1)),
                    next_v = all<P>(segments.velocity(i + 1));
      of.start = choose(before, met.which, start, of.start);
      of.edge = choose(before, met.which, next - start, of.edge);
      of.inverse = where_less(before, met.which, all<P>(segments.inverse(i)), of.inverse);
      of.v = choose(before, met.which, v, of.v);
      of.faster = choose(before, met.which, next_v - v, of.faster);
      before += P(1);
      start = next;
      v = next_v;
    }
  }
  return of;
}

/// Loads on points, a lane each.
template <class P>
struct LaneLoads {
  Vec3<P> force, by_place[3];  // force, and rows of dF/dx
  P by_velocity;               // dF/dv over the identity
};

/// Adds the loads of the segments that were met.
template <class P, class Segments>
[[gnu::always_inline]] inline void add(const Meeting<P>& met, const Vec3<P>& x,
                                       const Vec3<P>& points_v, const P& far,
                                       const ContactLaw& law, const Segments& segments,
                                       LaneLoads<P>& sum) {
  const P zero(0), &s = met.s;
  const ChosenSegments<P> on = chosen(met, segments);
  // Lanes out of reach get a gap without force.
  const Vec3<P> gap = choose(met.square, far, x - on.start - s * on.edge,
                             Vec3<P>(Vec{2 * law.reach(), 0, 0})),
                u = choose(met.square, far, points_v - on.v - s * on.faster,
                           Vec3<P>(Vec{}));
  const ContactLaw::Factors<P> at = law.factors(gap);
  sum.force = sum.force + at.push * gap - at.drag * u;
  sum.by_velocity -= at.drag;
  // Between the ends of a segment its nearest point follows x: ds/dx = `along`.
  const P follows = where_less(zero, s * (P(1) - s), on.inverse, zero);
  const Vec3<P> along = follows * on.edge;
  const Vec3<P> column = at.push_slope * gap - at.drag_slope * u;
  // Rows of push I + column d^T, less their product with ds/dx.
  const P by_edge = dot(gap, on.edge);
  const Vec3<P> by_s = at.push * on.edge + by_edge * column - at.drag * on.faster;
  sum.by_place[0] = sum.by_place[0] + column.x * gap - by_s.x * along;
  sum.by_place[1] = sum.by_place[1] + column.y * gap - by_s.y * along;
  sum.by_place[2] = sum.by_place[2] + column.z * gap - by_s.z * along;
  sum.by_place[0].x += at.push;
  sum.by_place[1].y += at.push;
  sum.by_place[2].z += at.push;
}

/// Sets the loads on the points from `from` on of a group at `places`.
template <class P, class Segments>
[[gnu::always_inline]] inline void set_loads(const GroupVectors& places,
                                             const GroupVectors& velocities,
                                             std::span<const SegmentRun> runs,
                                             std::size_t from, const ContactLaw& law,
                                             const Segments& segments, GroupLoads& to) {
  const Vec3<P> x = load<P>(places, from), v = load<P>(velocities, from);
  const P far(law.reach() * law.reach()), zero(0);
  const Vec3<P> none{zero, zero, zero};
  LaneLoads<P> sum{none, {none, none, none}, zero};
  // Strands within reach are collected first: nobody could foresee a branch on it.
  constexpr std::size_t at_once = 16;
  Meeting<P> met[at_once];
  while (!runs.empty()) {
    std::size_t count = 0;
    while (count < at_once && !runs.empty()) {
      met[count] = meet(x, far, segments, runs);
      count += any_less(met[count].square, far) ? 1 : 0;
    }
    for (std::size_t k = 0; k < count; ++k) {
      add(met[k], x, v, far, law, segments, sum);
    }
  }
  store(sum.force, from, to.force);
  for (std::size_t i = 0; i < 3; ++i) store(sum.by_place[i], from, to.by_place[i]);
  store(sum.by_velocity, from, to.by_velocity);
}

}  // namespace tress::models
