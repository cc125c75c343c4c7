#include "models/head/reduced_places.h"

#include "math/instructions.h"
#include "math/lanes.h"
#include "models/head/chain_strand.h"
#include "models/head/clothoid_strand.h"
#include "models/head/helix_strand.h"
#include "models/head/packs.h"

namespace tress::models {

// Flat as functions of ReducedLoads.
template <class Kind>
TRESS_FLATTEN void ReducedPlaces<Kind>::write(std::size_t strands, std::span<double> x,
                                              std::span<double> v) const {
  const FrameOf<T> axes{pose.frame.e0, pose.frame.e1, pose.frame.e2};
  FrameOf<T> at_frame = axes * frame;
  Vec3<T> at = axes * from, velocity = root.v, omega = root.omega;
  const auto store = [&](std::size_t i) {
    const Vec3<T> moves = at_frame * velocity;
    for (std::size_t k = 0; k < strands; ++k) {
      const int lane = static_cast<int>(k);
      const std::size_t to = 3 * (k * (elements + 1) + i);
      store3(pose.x + unit * lane_of(at, lane), &x[to]);
      if (!v.empty()) store3(speed * lane_of(moves, lane), &v[to]);
    }
  };
  store(0);
  for (std::size_t i = 0; i < elements; ++i) {
    const SeenTip<T> tip = typename Kind::Shape(*rule, q[i], rate[i], length).tip();
    at = at + at_frame * tip.position;
    at_frame = at_frame * FrameOf<T>{tip.rotation.column(0), tip.rotation.column(1),
                                     tip.rotation.column(2)};
    velocity = tip.rotation.back(velocity + cross(omega, tip.position) + tip.velocity);
    omega = tip.rotation.back(omega + tip.turning);
    store(i + 1);
  }
}

#define TRESS_PACK(Number, width)                                  \
  template struct ReducedPlaces<HelixKind<PackOf<Number, width>>>; \
  template struct ReducedPlaces<ChainKind<PackOf<Number, width>>>; \
  template struct ReducedPlaces<ClothoidKind<PackOf<Number, width>>>;
TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK

}  // namespace tress::models
