#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "math/instructions.h"
#include "math/pack.h"
#include "models/contact/contact_law.h"
#include "models/contact/strand_partners.h"

namespace tress::models {

/// As many points of one strand are looked at together.
inline constexpr int points_of_group = 8;
struct alignas(64) GroupNumbers : std::array<double, points_of_group> {};
using GroupVectors = Vec3<GroupNumbers>;
inline Vec lane_of(const GroupVectors& x, std::size_t lane) {
  return {x.x[lane], x.y[lane], x.z[lane]};
}

/// Load per length on the points of a group from the nearest point of every other strand,
/// and its derivatives: rows of dF/dx, and dF/dv over the identity.
struct GroupLoads {
  GroupVectors force, by_place[3];
  GroupNumbers by_velocity;
};

/// Points of one strand by eights, each eight with a kept list of the segments of other
/// strands that may come within reach. A list is made anew when what is near has moved by
/// its margin relative to its points (StrandPartners). Results do not depend on when that
/// was. Memory of eight points: 256 bytes and 8 a
/// strand nearby.
class PointGroups {
 public:
  /// `partners` must outlive it. The results are the same by any instructions.
  PointGroups(const StrandPartners& partners, int strand,
              Instructions instructions = widest_instructions());

  /// The points at x (3 each). Points that carry no length are left out.
  void ready(In x, In length);
  std::size_t groups() const { return groups_.size(); }
  /// False: no segment is near a group made ready, its loads are zero.
  bool feels(std::size_t group) const { return !groups_[group].list.empty(); }
  /// Of a group made ready, with partners `elapsed` (s) after the last update.
  void loads(std::size_t group, const ContactLaw& law, In v, double elapsed,
             GroupLoads& to) const;
  /// How many lists have been made.
  long made() const { return made_; }

  std::size_t bytes() const;

 private:
  struct Run {  // of segments of one strand, one after the other
    int first;
    unsigned count : 31;
    unsigned last : 1;  // whether the next run is of another strand
  };
  struct Group {
    GroupVectors x;                // now, NaN where there is no point
    double used = 0, room = 0;     // of what a list sees beyond the reach, m
    long update = -1, lists = -1;  // those of StrandPartners
    std::vector<Run> list;         // ascending
  };

  bool holds(Group& group, const GroupVectors& x) const;
  void list(Group& group);
  void keep_near(const Group& group, double distance);
  template <class P, class Segments>
  static void add_up(const Group& group, std::size_t from, const GroupVectors& of_v,
                     const ContactLaw& law, const Segments& segments, GroupLoads& to);

  const StrandPartners* partners_;
  int strand_;
  Instructions instructions_;
  std::vector<Group> groups_;
  std::vector<int> found_;  // of a search
  std::vector<Run> runs_;   // the same
  long made_ = 0;
};

}  // namespace tress::models
