#include "integrators/block/block_error.h"

#include <algorithm>
#include <cmath>

#include "integrators/block/lane_loops.h"
#include "integrators/control/step_factors.h"

namespace tress::integrators {
namespace {

/// The largest square of the distances between points, per lane, and 0 or NaN added to
/// `finite`.
template <class N>
void look(const LaneVector<N>& x, const LaneVector<N>& y, std::size_t points, int lanes,
          N* most, N* finite) {
  const auto width = static_cast<std::size_t>(lanes);
  for_lanes(points, lanes, [&, from = x.data(), to = y.data()](std::size_t i, int lane) {
    const auto l = static_cast<std::size_t>(lane);
    const std::size_t at = 3 * (i - l) + l;  // x of point i
    const N dx = to[at] - from[at], dy = to[at + width] - from[at + width],
            dz = to[at + 2 * width] - from[at + 2 * width];
    const N square = dx * dx + dy * dy + dz * dz;
    finite[lane] += square - square;
    most[lane] = larger_of(most[lane], square);
  });
}

}  // namespace

template <class N>
BlockError<N>::BlockError(const Block<N>& block)
    : unknowns_(block.unknowns()),
      points_(block.points()),
      x_(3 * points_ * static_cast<std::size_t>(block.lanes())),
      u_(x_),
      next_x_(x_),
      next_u_(x_),
      dq_(unknowns_ * static_cast<std::size_t>(block.lanes())),
      dv_(dq_),
      q_(dq_),
      v_(dq_),
      far_(static_cast<std::size_t>(block.lanes())),
      fast_(far_),
      finite_(far_),
      of_coordinates_(far_) {}

template <class N>
const N* BlockError<N>::of(BlockWork<N>& work) {
  Block<N>& block = work.block();
  const int lanes = work.lanes();
  work.difference(dq_.data(), dv_.data());
  for (std::size_t i = 0; i < q_.size(); ++i) {
    q_[i] = work.q[i] - dq_[i];
    v_[i] = work.v[i] - dv_[i];
  }
  block.work_on(*work.strands, BlockWork<N>::now);
  block.positions(Instant::end, work.q.data(), x_.data());
  block.velocities(Instant::end, work.q.data(), work.v.data(), u_.data());
  block.positions(Instant::end, q_.data(), next_x_.data());
  block.velocities(Instant::end, q_.data(), v_.data(), next_u_.data());
  for (auto* all : {&far_, &fast_, &finite_}) std::ranges::fill(*all, N(0));
  look(x_, next_x_, points_, lanes, far_.data(), finite_.data());
  look(u_, next_u_, points_, lanes, fast_.data(), finite_.data());
  block.coordinate_size(dq_.data(), of_coordinates_.data());
  for (std::size_t l = 0; l < far_.size(); ++l) {
    const auto length =
        static_cast<N>(work.strands->length({BlockWork<N>::now, static_cast<int>(l)}));
    // In the block's units g is 1.
    const N by_length = N(1) / length;
    const N of_points =
        std::sqrt(larger_of(by_length * by_length * far_[l], by_length * fast_[l]));
    far_[l] = larger_of(of_points, static_cast<N>(step_factors::coordinate_weight) *
                                       of_coordinates_[l]) +
              finite_[l];
  }
  return far_.data();
}

template class BlockError<double>;
template class BlockError<float>;

}  // namespace tress::integrators
