#pragma once

#include <cstddef>
#include <vector>

#include "math/instructions.h"
#include "math/pack.h"
#include "models/contact/contact_law.h"
#include "models/contact/strand_partners.h"

namespace tress::models {

/// Load per length on four points from the nearest point of every other strand, and its
/// derivatives: rows of dF/dx, and dF/dv over the identity.
struct FourLoads {
  Vec3<Pack> force;
  Vec3<Pack> by_place[3];
  Pack by_velocity;
};

/// Points of one strand by fours, each with a kept list of the segments of other strands
/// that may come within reach. A list is made anew when what is near has moved by its
/// margin relative to its points (StrandPartners); a segment of the list is looked at
/// again when it may have come within reach since the last look. Results do not depend on
/// when that was. Memory of four points: 160 bytes and 8 a candidate.
class PointGroups {
 public:
  /// `partners` must outlive it.
  PointGroups(const StrandPartners& partners, int strand);

  /// The points at x (3 each). Points that carry no length are left out.
  void ready(In x, In length);
  std::size_t groups() const { return groups_.size(); }
  /// False: no segment is near a group made ready, its loads are zero.
  bool feels(std::size_t group) const { return !groups_[group].list.empty(); }
  /// Of a group made ready, with partners `elapsed` (s) after the last update.
  void loads(std::size_t group, const ContactLaw& law, In v, double elapsed,
             FourLoads& to);
  /// How many lists have been made.
  long made() const { return made_; }

  std::size_t bytes() const;

 private:
  struct Candidate {
    int segment;  // twice its number, and 1 if it is the strand's last one in the list
    float wake;   // the value of Group::used from which on it may be within reach
  };
  struct Group {
    Vec3<Pack> x;                  // now, NaN where there is no point
    double used = 0, room = 0;     // of what a list sees beyond the reach, m
    long update = -1, lists = -1;  // those of StrandPartners
    std::vector<Candidate> list;
  };

  bool holds(Group& group, const Vec3<Pack>& x) const;
  void list(Group& group);
  float wakes_at(const Group& group, double square) const;
  template <class Segments>
  void sum_loads(Group& group, const ContactLaw& law, const Segments& segments,
                 const Vec3<Pack>& v, bool still, FourLoads& to);

  const StrandPartners* partners_;
  int strand_;
  Instructions instructions_ = widest_instructions();
  std::vector<Group> groups_;
  std::vector<int> found_;  // of a search, and of one strand what is within reach
  long made_ = 0;
};

}  // namespace tress::models
