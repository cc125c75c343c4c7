#pragma once

#include "integrators/block/block_work.h"

namespace tress::integrators {

/// Size of the estimated error of steps, per lane, by the points that the error moves.
/// The size is the largest of |dx|/L and |du| sqrt(L/g)/L over the root and the tips of
/// elements. L is the strand's length along its elements and g = 9.81 m/s^2. Coordinates
/// over their typical sizes count with the weight of ErrorNorm. ErrorNorm measures a
/// single strand in the same way except for L. Its L is the sum of the chords at the
/// start, which is shorter for elements that are arcs.
template <class N>
class BlockError {
 public:
  /// Allocates for the lanes of a block, which must outlive it.
  explicit BlockError(const Block<N>& block);

  /// Returns the error size of `work` at the end of a step, per lane; NaN where an entry
  /// is not finite. Valid until the next call.
  const N* of(BlockWork<N>& work);

 private:
  std::size_t unknowns_, points_;
  LaneVector<N> x_, u_, next_x_, next_u_;  // (points, 3)
  LaneVector<N> dq_, dv_, q_, v_;
  LaneVector<N> far_, fast_, finite_, of_coordinates_;  // (lanes)
};

extern template class BlockError<double>;
extern template class BlockError<float>;

}  // namespace tress::integrators
