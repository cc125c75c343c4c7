#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "math/pack.h"
#include "models/contact/contact_law.h"
#include "models/contact/strand_partners.h"

namespace tress::models {

/// Four neighbouring points of a strand, one per lane; NaN where there is none.
struct PointLanes {
  Vec3<Pack> x, v;
};

/// Load per length on four points from the nearest point of every other strand, and its
/// derivatives: rows of dF/dx, and dF/dv over the identity.
struct FourLoads {
  Vec3<Pack> force;
  Vec3<Pack> by_place[3];
  Pack by_velocity;
};

/// Points of one strand by fours, each with a kept list of the segments of other strands
/// that may come within a distance. A list is made anew when its epoch has ended
/// (StrandPartners) or its own points have used up the rest of the margin. Results do not
/// depend on when lists were made. Memory of four points: 130 bytes and 4 a candidate.
class PointGroups {
 public:
  /// `partners` must outlive it. beyond: distance added to its reach, m.
  PointGroups(const StrandPartners& partners, int strand, double beyond = 0);

  /// The points at x (3 each) and those of partners `elapsed` (s) after the last update.
  /// Points that carry no length are left out.
  void ready(In x, In length, double elapsed);
  std::size_t groups() const { return groups_.size(); }
  /// False: no segment is near a group made ready, its loads are zero.
  bool feels(std::size_t group) const { return !groups_[group].list.empty(); }
  /// Of a group made ready, at the same time.
  FourLoads loads(std::size_t group, const ContactLaw& law, In v, double elapsed) const;
  /// Whether some segment comes as near as that (m), at most the reach and what is
  /// beyond.
  bool touched(std::size_t group, double radius, double elapsed) const;

  std::size_t bytes() const;

 private:
  struct Group {
    Vec3<Pack> x;       // now
    Vec3<Pack> listed;  // place at the epoch where the list was made
    double moved = 0;   // StrandPartners::moved() then
    long epoch = -1;
    std::vector<int> list;  // twice the segment, and 1 if a strand's last one
  };

  bool stands(const Group& group) const;
  void list(Group& group, double elapsed);

  const StrandPartners* partners_;
  int strand_;
  double reach_;
  std::vector<Group> groups_;
  std::vector<int> found_;
};

}  // namespace tress::models
