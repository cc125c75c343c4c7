#include "models/head/helix_places.h"

#include "math/lanes.h"

namespace tress::models {

// Flat as functions of HelixLoads.
template <class T>
[[gnu::flatten]] void HelixPlaces<T>::write(std::size_t strands, std::span<double> x,
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
    const HelixElement<T> element(q[i], rate[i]);
    const LaneFunctions<T> functions(q[i], length);
    const HelixFunctions<T> f = functions.at(length);
    const auto turn = element.turn(length, f, functions.x2());
    const Vec3<T> tip = element.position(length, f);
    at = at + at_frame * tip;
    at_frame = at_frame * FrameOf<T>{turn.rotation.column(0), turn.rotation.column(1),
                                     turn.rotation.column(2)};
    velocity =
        turn.rotation.back(velocity + cross(omega, tip) + element.slope(f) * rate[i]);
    omega = turn.rotation.back(omega + turn.velocity);
    store(i + 1);
  }
}

template struct HelixPlaces<PackOf<double, 1>>;
template struct HelixPlaces<PackOf<double, 4>>;
template struct HelixPlaces<PackOf<double, 8>>;
template struct HelixPlaces<PackOf<float, 8>>;
template struct HelixPlaces<PackOf<float, 16>>;

}  // namespace tress::models
