// Compiled without errno, so that the roots of all lanes are one instruction.
#include "models/contact/point_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "math/lanes.h"
#include "models/contact/strand_meetings.h"

namespace tress::models {
namespace {

constexpr auto eight = static_cast<std::size_t>(points_of_group);
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
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

/// Sorts the numbers, ascending; duplicates of an earlier one may become -1. Short lists
/// are sorted without branches: the number of smaller ones is the place of each.
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

/// What a search needs for a moment: of a thread, as it is more than strands keep.
struct Search {
  std::vector<int> found;
  std::vector<SegmentRun> runs;
  std::vector<std::uint64_t> seen;  // a bit for each segment, 0 between searches

  /// Drops what was found before, of segments below `end`.
  void leave_once(std::size_t end) {
    constexpr std::size_t bits = 64;
    seen.resize(std::max(seen.size(), end / bits + 1));
    const auto word = [&](int i) -> std::uint64_t& {
      return seen[static_cast<std::size_t>(i) / bits];
    };
    std::size_t count = 0;
    for (const int i : found) {
      const std::uint64_t bit = std::uint64_t{1} << (static_cast<std::size_t>(i) % bits);
      std::uint64_t& marks = word(i);
      found[count] = i;
      count += (marks & bit) == 0 ? 1 : 0;
      marks |= bit;
    }
    found.resize(count);
    for (const int i : found) word(i) = 0;
  }
};
thread_local Search search_of_thread;

}  // namespace

PointGroups::PointGroups(const StrandPartners& partners, int strand,
                         Instructions instructions)
    : partners_(&partners), strand_(strand), instructions_(instructions) {}

void PointGroups::ready(In x, In length) {
  groups_.resize((length.size() + eight - 1) / eight);
  // All of it was last needed a step ago.
  fetch(groups_.data(), groups_.size());
  for (const Group& group : groups_) fetch(group.list.data(), group.list.size());
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
    for (const SegmentRun& run : group.list) {
      partners_->fetch_segments(run.first, run.count);
    }
  }
}

/// Tests whether the list contains all segments that are near now. Points and segments
/// have moved since the list was made, but their distance has shrunk by no more than the
/// remaining margin.
bool PointGroups::holds(Group& group, const GroupVectors& x) const {
  const long updates = partners_->updates() - group.update;
  if (group.lists != partners_->lists() || updates > 1) return false;
  double most = 0;
  by_packs(instructions_, [&]<class P>(std::size_t from, const P&) {
    const Vec3<P> now = load<P>(x, from),
                  before = updates == 1 ? partners_->before(now) : now;
    Vec3<P> off = before - load<P>(group.x, from);
    P spread(0);
    if (updates == 1) {
      const auto cells = partners_->cells(partners_->at_epoch(now));
      Vec3<P> middle;
      P numbers;
      for (int lane = 0; lane < lanes<P>; ++lane) numbers.set(lane, lane);
      // Points that follow each other mostly share a cell.
      int last = -1;
      for (int lane = 0; lane < lanes<P>; ++lane) {
        const int cell = cells[static_cast<std::size_t>(lane)];
        if (cell == last) continue;
        last = cell;
        const LocalDrift::Spread& near = partners_->drift(cell);
        const P these(lane);
        middle = choose(numbers, these, middle, all<P>(near.middle));
        spread = where_less(numbers, these, spread, all<P>(near.radius));
      }
      off = off - middle;
    }
    const P nearer = where_less(spread, P(0), P(0), square_root(square_of(off)) + spread);
    for (int lane = 0; lane < lanes<P>; ++lane) {
      if (!is_finite(lane_of(now, lane))) continue;
      // What had no place before may be anywhere.
      const double by = nearer[lane];
      most = std::max(most, is_finite(by) ? by : std::numeric_limits<double>::infinity());
    }
  });
  group.used += most;
  return group.used <= group.room - partners_->range();
}

void PointGroups::list(Group& group) {
  ++made_;
  group.lists = partners_->lists();
  group.used = 0;
  group.room = partners_->margin() + partners_->range();
  group.list.clear();
  const double wide = (partners_->reach() + group.room) * rounding;
  const SegmentCells& segments = partners_->segments();
  Search& of_thread = search_of_thread;
  std::vector<int>& found = of_thread.found;
  search(group, wide + partners_->moved(), found);
  if (segments.divided()) of_thread.leave_once(segments.points());
  keep_near(group, wide, found);
  for (const int i : segments.long_segments()) {
    if (segments.polyline(i) != strand_) found.push_back(i);
  }
  sort(found);
  std::vector<SegmentRun>& runs = of_thread.runs;
  runs.clear();
  for (const int i : found) {
    if (!runs.empty()) {
      SegmentRun& run = runs.back();
      const int next = run.first + static_cast<int>(run.count);
      if (i < next) continue;  // one of those before
      if (i == next) {
        ++run.count;
        continue;
      }
      run.last = segments.polyline(run.first) != segments.polyline(i) ? 1 : 0;
    }
    runs.push_back({i, 1, 1});
  }
  group.list = runs;
}

/// Sets `found` to what may come within the distance of a point, and some more. Points
/// lie apart where segments are much longer than the reach; else most of what is found
/// for one would be found for the next.
void PointGroups::search(const Group& group, double distance,
                         std::vector<int>& found) const {
  const SegmentCells& segments = partners_->segments();
  found.clear();
  const auto look = [&](Box box) {
    if (box.empty()) return;
    box.grow(distance);
    segments.reaching_into(box, found);
  };
  Box all = Box::none();
  for (std::size_t lane = 0; lane < eight; ++lane) {
    const Vec at = partners_->at_epoch(lane_of(group.x, lane));
    if (!is_finite(at)) continue;
    if (segments.divided()) {
      look({at, at});
    } else {
      all.include(at);
    }
  }
  look(all);
}

/// Drops what is farther from all points than that, and the own strand.
void PointGroups::keep_near(const Group& group, double distance,
                            std::vector<int>& found) const {
  const SegmentCells& segments = partners_->segments();
  const int own = segments.first(static_cast<std::size_t>(strand_)),
            other = segments.first(static_cast<std::size_t>(strand_) + 1);
  const auto is_own = [=](int i) { return i >= own && i < other; };
  std::size_t near = 0;
  for (const int i : found) partners_->fetch_place(i);
  const auto keep = [&](auto... packs) {
    for (const int i : found) {
      const StraightPiece piece = partners_->piece(i);
      const auto is_near = [&]<class P>(const Vec3<P>& x) {
        const Vec3<P> d = x - all<P>(piece.start), edge = all<P>(piece.edge);
        const P s = nearest(d, edge, all<P>(piece.inverse));
        return any_less(square_of(d - s * edge), P(distance * distance));
      };
      // Without a branch, which nobody could foresee.
      found[near] = i;
      near += !is_own(i) && (static_cast<int>(is_near(packs)) | ...) != 0 ? 1 : 0;
    }
  };
  if (instructions_ == Instructions::avx512) {
    by(instructions_, [&] { keep(load<PackOf<double, 8>>(group.x, 0)); });
  } else {
    keep(load<Pack>(group.x, 0), load<Pack>(group.x, Pack::lanes));
  }
  found.resize(near);
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
      set_loads<P>(g.x, of_v, g.list, from, law, Held{*partners_}, to);
    } else {
      set_loads<P>(g.x, of_v, g.list, from, law, Moving{partners_->motion(), elapsed},
                   to);
    }
  });
}

std::size_t PointGroups::bytes() const {
  std::size_t sum = groups_.capacity() * sizeof(Group);
  for (const Group& group : groups_) sum += group.list.capacity() * sizeof(SegmentRun);
  return sum;
}

}  // namespace tress::models
