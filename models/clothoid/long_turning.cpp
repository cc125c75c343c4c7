#include "models/clothoid/long_turning.h"

#include "models/clothoid/turning.h"

namespace tress::models {
namespace {

/// Places in [-1, 1] as a rule of TurningOf<double>.
class Places {
 public:
  Places(int points, const double* y) : blocks_((points + width - 1) / width) {
    for (int b = 0; b < blocks_; ++b) {
      Pack& to = place_[static_cast<std::size_t>(b)];
      to = Pack(0);
      for (int lane = 0; lane < width && width * b + lane < points; ++lane) {
        to.set(lane, y[width * b + lane]);
      }
    }
  }
  int blocks() const { return blocks_; }
  const Pack& place(int b) const { return place_[static_cast<std::size_t>(b)]; }

 private:
  static constexpr int width = Pack::lanes;
  int blocks_;
  std::array<Pack, most_points_of_element / width> place_;
};

}  // namespace

void turn_far(const double (&ab)[6], int points, const double* y, LongTurning& to) {
  TurningOf<double> turning({4.0 * load3(ab), 4.0 * load3(ab + 3)}, 1);
  const Frame tip = turning.place(Places(points, y), [&](int b,
                                                         const FrameOf<Pack>& frame) {
    for (int lane = 0; lane < Pack::lanes; ++lane) {
      const int at = Pack::lanes * b + lane;
      if (at >= points) break;
      store9({lane_of(frame.e0, lane), lane_of(frame.e1, lane), lane_of(frame.e2, lane)},
             &to.frames[9 * static_cast<std::size_t>(at)]);
    }
  });
  store9(tip, &to.frames[9 * static_cast<std::size_t>(points)]);
}

}  // namespace tress::models
