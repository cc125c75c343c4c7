#include "integrators/block/block_work.h"

#include <algorithm>

#include "integrators/block/lane_loops.h"

namespace tress::integrators {

template <class N>
BlockWork<N>::BlockWork(Block<N>& block, const BlockMethod& method)
    : strands(block.memory()),
      state((4 * block.unknowns() + 2) * static_cast<std::size_t>(block.lanes())),
      after(state),
      q_bar(block.unknowns() * static_cast<std::size_t>(block.lanes())),
      q(q_bar),
      v(q_bar),
      step(q_bar),
      size(static_cast<std::size_t>(block.lanes())),
      block_(block),
      method_(method),
      lanes_(block.lanes()),
      size_(block.unknowns()),
      numbers_(q_bar.size()),
      v_bar_(q_bar),
      a_(q_bar),
      guess_(q_bar) {
  strands->resize(2);
}

template <class N>
void BlockWork<N>::begin(std::size_t stage, double h, double loads, Lanes starts,
                         NewtonStart from) {
  const BlockStage& of = method_.stages[stage];
  stage_ = stage;
  h_ = h;
  const N *const q_n = state.data(), *const v_n = q_n + numbers_,
                 *const a_0 = v_n + numbers_, *const a_1 = a_0 + numbers_;
  const N rate0(static_cast<N>(h * of.rate[0])), rate1(static_cast<N>(h * of.rate[1])),
      drift0(static_cast<N>(h * of.drift[0])), drift1(static_cast<N>(h * of.drift[1]));
  N *const v_bar = v_bar_.data(), *const drift = v.data();
  for (std::size_t i = 0; i < numbers_; ++i) {
    v_bar[i] = v_n[i] + rate0 * a_0[i] + rate1 * a_1[i];
    drift[i] = v_n[i] + drift0 * a_0[i] + drift1 * a_1[i];
  }
  guess(starts);
  block_.work_on(*strands, now);
  block_.predict(Instant::stage, of.time * h, q_n, drift, q_bar.data());
  const double s = of.gamma * h;
  weights = {1, s, s * s};
  block_.take_stresses(q_n, starts);
  place();
  block_.meet(Instant::stage, loads, q.data(), v.data());
  if (from != NewtonStart::guess) start_from(from, starts);
}

/// Along the line through the known accelerations: from a_0 on, over what lies between
/// a_1 and a_0; a_0 if there is one alone. Those of the last steps are at their last
/// stages.
template <class N>
void BlockWork<N>::guess(Lanes starts) {
  const N *const a_0 = state.data() + 2 * numbers_, *const a_1 = a_0 + numbers_;
  const double time = method_.stages[stage_].time;
  N ahead[32];
  if (stage_ > method_.first()) {
    std::fill_n(ahead, lanes_, static_cast<N>(-time / method_.stages[stage_ - 1].time));
  } else {
    const N *const last = lengths(state), *const before = last + lanes_;
    const double at = method_.stages.back().time;
    for (int lane = 0; lane < lanes_; ++lane) {
      const N way = static_cast<N>(time * h_) + static_cast<N>(1 - at) * last[lane],
              between =
                  static_cast<N>(at) * last[lane] + static_cast<N>(1 - at) * before[lane];
      ahead[lane] = N(0) < before[lane] ? way / between : N(0);
    }
  }
  N* const to = starts == all_lanes(lanes_) ? a_.data() : guess_.data();
  for_lanes(size_, lanes_, [=, &ahead](std::size_t i, int lane) {
    to[i] = a_0[i] + ahead[lane] * (a_0[i] - a_1[i]);
  });
  if (to == a_.data()) return;
  for_lanes(size_, lanes_, [this, starts](std::size_t i, int lane) {
    if (has(starts, lane)) a_[i] = guess_[i];
  });
}

template <class N>
void BlockWork<N>::start_from(NewtonStart from, Lanes starts) {
  const N still = from == NewtonStart::zero ? N(0) : static_cast<N>(-1 / weights.vel);
  for_lanes(size_, lanes_, [&](std::size_t i, int lane) {
    if (has(starts, lane)) a_[i] = still * v_bar_[i];
  });
  place();
}

template <class N>
void BlockWork<N>::place() {
  const auto pos = static_cast<N>(weights.pos), vel = static_cast<N>(weights.vel);
  const N *const a = a_.data(), *const bar = q_bar.data(), *const rate = v_bar_.data();
  N *const to_q = q.data(), *const to_v = v.data();
  for (std::size_t i = 0; i < numbers_; ++i) {
    to_q[i] = bar[i] + pos * a[i];
    to_v[i] = rate[i] + vel * a[i];
  }
}

template <class N>
void BlockWork<N>::end() {
  const std::size_t n = numbers_;
  after = state;
  N *const q_n = after.data(), *const v_n = q_n + n, *const a_0 = v_n + n,
           *const a_1 = a_0 + n, *const steps = lengths(after);
  const BlockStage& of = method_.stages[stage_];
  if (of.gamma == 0) {
    std::ranges::copy(a_, a_0);
    return;
  }
  if (stage_ + 1 < method_.stages.size()) {
    std::ranges::copy(a_, a_1);
    return;
  }
  if (of.time == 1) {
    std::ranges::copy(q, q_n);
    std::ranges::copy(v, v_n);
  } else {
    block_.predict(Instant::end, h_, state.data(), v.data(), q_n);
    const auto h = static_cast<N>(h_);
    for (std::size_t i = 0; i < n; ++i) v_n[i] += h * a_[i];
  }
  if (method_.accelerations > 1) {
    std::copy_n(a_0, n, a_1);
    std::copy_n(steps, lanes_, steps + lanes_);
    std::fill_n(steps, lanes_, static_cast<N>(h_));
  }
  std::ranges::copy(a_, a_0);
}

template <class N>
void BlockWork<N>::difference(N* dq, N* dv) const {
  const BlockEstimate& by = *method_.estimate;
  const N *const a_0 = state.data() + 2 * numbers_, *const a_1 = a_0 + numbers_,
                 *const a_2 = a_.data();
  const auto sum = [=, this](double scale, const std::array<double, 3>& of, N* to) {
    const auto of0 = static_cast<N>(scale * of[0]), of1 = static_cast<N>(scale * of[1]),
               of2 = static_cast<N>(scale * of[2]);
    for (std::size_t i = 0; i < numbers_; ++i) {
      to[i] = of0 * a_0[i] + of1 * a_1[i] + of2 * a_2[i];
    }
  };
  sum(h_ * h_, by.drift, dq);
  sum(h_, by.rate, dv);
}

template <class N>
void BlockWork<N>::newton(bool whole) {
  if (!whole) block_.take_stresses(q.data(), all_lanes(lanes_));
  block_.newton(weights, q.data(), v.data(), a(), step.data(), size.data());
}

template <class N>
void BlockWork<N>::again() {
  block_.again(weights, q.data(), v.data(), a(), step.data(), size.data());
}

template <class N>
void BlockWork<N>::move(const N* by) {
  N* const a = a_.data();
  for (std::size_t i = 0; i < numbers_; ++i) a[i] -= by[i];
  place();
}

template <class N>
void BlockWork<N>::move(const N* part, const N* by) {
  N* const a = a_.data();
  for_lanes(size_, lanes_, [=](std::size_t i, int lane) { a[i] -= part[lane] * by[i]; });
  place();
}

template class BlockWork<double>;
template class BlockWork<float>;

}  // namespace tress::integrators
