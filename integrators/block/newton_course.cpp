#include "integrators/block/newton_course.h"

#include <algorithm>

namespace tress::integrators {

template <class N>
void SingleCourse<N>::go_on(BlockWork<N>& work, std::span<NewtonVerdict> all) {
  work.move(work.step.data());
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k] =
        std::isfinite(work.size[k]) ? NewtonVerdict::converged : NewtonVerdict::failed;
  }
}

template <class N>
void PlainCourse<N>::start(int lane, const BlockWork<N>& work) {
  of_lane_[static_cast<std::size_t>(lane)] = {
      NewtonRules::of(tolerance_, left_, work.resolved(lane))};
}

template <class N>
void PlainCourse<N>::go_on(BlockWork<N>& work, std::span<NewtonVerdict> all) {
  work.move(work.step.data());
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k] = of_lane_[k].judge(static_cast<double>(work.size[k]), iterations_);
  }
}

template <class N>
NewtonVerdict PlainCourse<N>::OfLane::judge(double size, int iterations) {
  if (!std::isfinite(size)) return NewtonVerdict::failed;
  const double rate = size / previous;
  // Of the error that is left the rate tells; the first correction has none yet.
  const double left = done > 0 && rate < 1 ? NewtonRules::error_left(size, rate) : size;
  if (size <= rules.tolerance || left <= rules.left ||
      rules.stagnates(size, rate, done)) {
    return NewtonVerdict::converged;
  }
  if (rate > 1 && done > 0 && ++grown == most_grown) return NewtonVerdict::failed;
  previous = size;
  return ++done == iterations ? NewtonVerdict::failed : NewtonVerdict::go_on;
}

template <class N>
void DampedCourse<N>::start(int lane, const BlockWork<N>& work) {
  of_lane_[static_cast<std::size_t>(lane)] = {
      .rules = NewtonRules::of(tolerance_, NewtonRules::margin, work.resolved(lane)),
      .runs = true};
}

template <class N>
NewtonVerdict DampedCourse<N>::OfLane::judge(double size, int most_iterations) {
  if (size <= rules.tolerance) return NewtonVerdict::converged;
  return std::isfinite(size) && ++done < most_iterations ? NewtonVerdict::go_on
                                                         : NewtonVerdict::failed;
}

template <class N>
void DampedCourse<N>::go_on(BlockWork<N>& work, std::span<NewtonVerdict> all) {
  from_.assign(work.a(), work.a() + work.numbers());
  step_ = work.step;
  sizes_.assign(work.size.begin(), work.size.end());
  part_.assign(all.size(), N(1));
  bool waits[32];
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k] = of_lane_[k].judge(static_cast<double>(sizes_[k]), iterations_);
    waits[k] = of_lane_[k].runs && all[k] == NewtonVerdict::go_on;
  }
  for (;;) {
    std::ranges::copy(from_, work.a());
    work.move(part_.data(), step_.data());
    const auto waiting = std::count(waits, waits + all.size(), true);
    if (waiting == 0) break;
    iterations += waiting;
    lanes += work.lanes();
    work.again();
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (!waits[k]) continue;
      const double taken = static_cast<double>(part_[k]),
                   before = static_cast<double>(sizes_[k]);
      waits[k] = !shrinks_enough(static_cast<double>(work.size[k]), taken, before);
      if (!waits[k]) continue;
      part_[k] = static_cast<N>(taken / 2);
      if (taken / 2 >= shortest_damped) continue;
      waits[k] = false;
      all[k] = before <= of_lane_[k].rules.rounding ? NewtonVerdict::converged
                                                    : NewtonVerdict::failed;
    }
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    of_lane_[k].runs = of_lane_[k].runs && all[k] == NewtonVerdict::go_on;
  }
}

template class SingleCourse<double>;
template class SingleCourse<float>;
template class PlainCourse<double>;
template class PlainCourse<float>;
template class DampedCourse<double>;
template class DampedCourse<float>;

}  // namespace tress::integrators
