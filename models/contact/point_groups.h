#pragma once

#include <cstddef>
#include <vector>

#include "math/instructions.h"
#include "models/contact/contact_law.h"
#include "models/contact/group_loads.h"
#include "models/contact/strand_partners.h"

namespace tress::models {

/// Points of one strand in groups of eight, each with a cached list of the segments of
/// other strands within reach. A list is rebuilt when its surroundings have moved by its
/// margin relative to its points (StrandPartners). Results do not depend on the time of
/// the rebuild. Memory of eight points: 256 bytes, and 8 per strand nearby.
class PointGroups {
 public:
  /// `partners` must outlive it. The results are the same by any instructions.
  PointGroups(const StrandPartners& partners, int strand,
              Instructions instructions = widest_instructions());

  /// The points at x (3 each). Points that carry no length are left out.
  void ready(In x, In length);
  /// Returns the number of groups.
  std::size_t groups() const { return groups_.size(); }
  /// False: no segment is near a group made ready, its loads are zero.
  bool feels(std::size_t group) const { return !groups_[group].list.empty(); }
  /// Computes the loads on a prepared group, with partners `elapsed` (s) after the last
  /// update.
  void loads(std::size_t group, const ContactLaw& law, In v, double elapsed,
             GroupLoads& to) const;
  /// Returns the number of lists made.
  long made() const { return made_; }

  /// Returns the memory in use, bytes.
  std::size_t bytes() const;

 private:
  struct Group {
    GroupVectors x;                // now, NaN where there is no point
    double used = 0, room = 0;     // of what a list sees beyond the reach, m
    long update = -1, lists = -1;  // those of StrandPartners
    std::vector<SegmentRun> list;  // ascending
  };

  bool holds(Group& group, const GroupVectors& x) const;
  void list(Group& group);
  void search(const Group& group, double distance, std::vector<int>& found) const;
  void keep_near(const Group& group, double distance, std::vector<int>& found) const;

  const StrandPartners* partners_;
  int strand_;
  Instructions instructions_;
  std::vector<Group> groups_;
  long made_ = 0;
};

}  // namespace tress::models
