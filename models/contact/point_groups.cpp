// Compiled without errno, so that the roots of four lanes are one instruction.
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

/// A segment and how fast it moves: ends at s = 0 and 1.
struct Segment {
  Vec x, edge;
  double inverse;  // 1/length^2
  Vec v, faster;
};
struct Held {
  const StrandPartners::Node* nodes;
  Segment operator()(int i) const {
    const StrandPartners::Node &a = nodes[i], &b = nodes[i + 1];
    return {a.x, b.x - a.x, a.inverse, a.v, b.v - a.v};
  }
};
struct Moving {
  const PointMotion& motion;
  double elapsed;
  Segment operator()(int i) const {
    const auto at = static_cast<std::size_t>(i);
    const StraightPiece piece(motion.place(at, elapsed), motion.place(at + 1, elapsed));
    const Vec v = motion.velocity(at, elapsed);
    return {piece.start, piece.edge, piece.inverse, v,
            motion.velocity(at + 1, elapsed) - v};
  }
};

/// Calls act with one of the two.
template <class F>
auto with_segments(const StrandPartners& partners, double elapsed, const F& act) {
  return elapsed == 0 ? act(Held{partners.nodes()})
                      : act(Moving{partners.motion(), elapsed});
}

struct Nearest {
  Pack s;
  Vec3<Pack> gap;
};
Nearest nearest(const Vec3<Pack>& x, const Segment& to) {
  const Vec3<Pack> d = x - Vec3<Pack>(to.x), edge(to.edge);
  const Pack s = larger(smaller(Pack(to.inverse) * dot(d, edge), Pack(1)), Pack(0));
  return {s, x - (Vec3<Pack>(to.x) + s * edge)};
}

void choose(const Pack& square, const Pack& least, const Vec3<Pack>& from,
            Vec3<Pack>& to) {
  to = {where_less(square, least, from.x, to.x), where_less(square, least, from.y, to.y),
        where_less(square, least, from.z, to.z)};
}

template <class Segments>
FourLoads sum_loads(const ContactLaw& law, double reach, std::span<const int> list,
                    const Segments& segments, const PointLanes& p) {
  FourLoads sum{};
  const Pack far(reach * reach);
  for (std::size_t k = 0; k < list.size();) {
    // The nearest point of one strand; lanes out of its reach keep a gap without force.
    Pack least = far, s{}, inverse{};
    Vec3<Pack> gap(Vec{2 * reach, 0, 0}), v{}, edge{}, faster{};
    bool more = true;
    while (more) {
      const Segment segment = segments(list[k] >> 1);
      more = (list[k++] & 1) == 0;
      const Nearest at = nearest(p.x, segment);
      const Pack square = dot(at.gap, at.gap);
      if (!any_less(square, least)) continue;
      const Vec3<Pack> change(segment.faster);
      s = where_less(square, least, at.s, s);
      inverse = where_less(square, least, Pack(segment.inverse), inverse);
      choose(square, least, at.gap, gap);
      choose(square, least, Vec3<Pack>(segment.v) + at.s * change, v);
      choose(square, least, Vec3<Pack>(segment.edge), edge);
      choose(square, least, change, faster);
      least = where_less(square, least, square, least);
    }
    if (!any_less(least, far)) continue;
    const Vec3<Pack> apart = p.v - v;
    const Vec3<Pack> u{where_less(least, far, apart.x, Pack(0)),
                       where_less(least, far, apart.y, Pack(0)),
                       where_less(least, far, apart.z, Pack(0))};
    const ContactLaw::Factors<Pack> at = law.factors(gap);
    sum.force = sum.force + at.push * gap - at.drag * u;
    sum.by_velocity -= at.drag;
    // Between the ends of a segment its nearest point follows x: ds/dx = `along`.
    const Pack follows =
        where_less(Pack(0), s, where_less(s, Pack(1), inverse, Pack(0)), Pack(0));
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
  return sum;
}

/// Whether a segment comes as near as that to some lane.
bool within(const Vec3<Pack>& x, const Segment& segment, double square) {
  const Vec3<Pack> gap = nearest(x, segment).gap;
  return any_less(dot(gap, gap), Pack(square));
}

}  // namespace

PointGroups::PointGroups(const StrandPartners& partners, int strand, double beyond)
    : partners_(&partners), strand_(strand), reach_(partners.reach() + beyond) {}

void PointGroups::ready(In x, In length, double elapsed) {
  groups_.resize((length.size() + four - 1) / four);
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Group& group = groups_[g];
    for (std::size_t lane = 0; lane < four; ++lane) {
      const std::size_t i = four * g + lane;
      const bool there = i < length.size() && length[i] != 0;
      const Vec at = there ? load3(&x[3 * i]) : Vec{nowhere, nowhere, nowhere};
      set_lane(group.x, static_cast<int>(lane), at);
    }
    if (!stands(group)) list(group, elapsed);
  }
}

/// Whether all that is near now is listed: own points and partners have not come nearer
/// to each other than by the margin.
bool PointGroups::stands(const Group& group) const {
  if (group.epoch != partners_->epochs()) return false;
  const double room = partners_->margin() - partners_->moved() - group.moved;
  const Vec3<Pack> moved = partners_->at_epoch(group.x) - group.listed;
  // Lanes without a point have not moved.
  const Pack square =
      where_less(dot(group.x, group.x), Pack(infinity), dot(moved, moved), Pack(0));
  return room >= 0 && all_up_to(square, room * room);
}

void PointGroups::list(Group& group, double elapsed) {
  group.listed = partners_->at_epoch(group.x);
  group.epoch = partners_->epochs();
  group.moved = partners_->moved();
  group.list.clear();
  // The points lie about the piece from the first to the last one.
  Vec ends[2];
  int count = 0;
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    const Vec at = lane_of(group.listed, lane);
    if (!is_finite(at)) continue;
    ends[count == 0 ? 0 : 1] = at;
    if (count++ == 0) ends[1] = at;
  }
  if (count == 0) return;
  const StraightPiece axis(ends[0], ends[1]);
  double beside = 0;
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    const Vec at = lane_of(group.listed, lane);
    if (is_finite(at)) beside = std::max(beside, norm(at - axis.at(axis.nearest(at))));
  }
  const double wide = (reach_ + partners_->margin()) * rounding;
  partners_->near(axis, wide + beside, strand_, found_);
  const SegmentCells& all = partners_->segments();
  group.list.reserve(found_.size());
  with_segments(*partners_, elapsed, [&](const auto& segments) {
    for (const int i : found_) {
      if (within(group.x, segments(i), wide * wide)) group.list.push_back(2 * i);
    }
  });
  for (std::size_t k = 0; k < group.list.size(); ++k) {
    const bool last =
        k + 1 == group.list.size() ||
        all.polyline(group.list[k] / 2) != all.polyline(group.list[k + 1] / 2);
    if (last) ++group.list[k];
  }
}

FourLoads PointGroups::loads(std::size_t group, const ContactLaw& law, In v,
                             double elapsed) const {
  const Group& g = groups_[group];
  if (g.list.empty()) return FourLoads{};
  PointLanes p{g.x, {}};
  for (std::size_t lane = 0; lane < four; ++lane) {
    const std::size_t i = four * group + lane;
    if (3 * i < v.size()) set_lane(p.v, static_cast<int>(lane), load3(&v[3 * i]));
  }
  return with_segments(*partners_, elapsed, [&](const auto& segments) {
    return sum_loads(law, reach_, g.list, segments, p);
  });
}

bool PointGroups::touched(std::size_t group, double radius, double elapsed) const {
  const Group& g = groups_[group];
  return with_segments(*partners_, elapsed, [&](const auto& segments) {
    return std::ranges::any_of(g.list, [&](int entry) {
      return within(g.x, segments(entry >> 1), radius * radius);
    });
  });
}

std::size_t PointGroups::bytes() const {
  std::size_t sum = groups_.capacity() * sizeof(Group) + found_.capacity() * sizeof(int);
  for (const Group& group : groups_) sum += group.list.capacity() * sizeof(int);
  return sum;
}

}  // namespace tress::models
