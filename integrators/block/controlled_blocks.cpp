#include "integrators/block/controlled_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/block/lane_loops.h"

namespace tress::integrators {

/// A step is kept if its error is small.
template <class N>
class ControlledBlocks<N>::Judge final : public StepJudge {
 public:
  Judge(ControlledBlocks& of, const Step& now, std::vector<std::size_t>& later,
        double begin)
      : of_(of),
        now_(now),
        later_(later),
        begin_(begin),
        h_(of.solver_.length(now.span)) {}

  void ended() override {
    error_ = of_.error_.of(of_.solver_.work);
    of_.renew();
  }
  void judged(int lane, std::size_t strand) override {
    BlockWork<N>& work = of_.solver_.work;
    StepLength& length = now_.strands.length(strand);
    const double over = static_cast<double>(error_[lane]) / of_.threshold_;
    if (over <= 1) {
      length.accept(h_, over, of_.estimate_.falls);
      // The step began with the acceleration before its last.
      N* const lengths = work.lengths(work.after) + lane;
      if (lengths[0] > N(0)) lengths[work.lanes()] = static_cast<N>(h_);
      now_.strands.put_home(work, of_.stepped(), lane, strand);
      ++now_.done.steps;
      return;
    }
    ++now_.done.rejected_by_error;
    length.reject(h_, over, of_.estimate_.falls);
    now_.strands.interrupt(strand, h_, of_.stage_end_);
    if (of_.can_halve(now_.strands, strand, h_)) {
      later_.push_back(strand);
    } else {
      now_.strands.lose(strand);
      of_.lost_.push_back({strand, begin_, "the tolerance needs too short a step"});
    }
  }
  void failed(std::size_t strand, std::size_t stage) override {
    ++now_.done.rejected_by_newton;
    now_.strands.length(strand).unsolved(h_);
    if (stage > of_.first_stage_) now_.strands.interrupt(strand, h_, of_.stage_end_);
    (of_.can_halve(now_.strands, strand, h_) ? later_ : of_.stuck_).push_back(strand);
  }

 private:
  ControlledBlocks& of_;
  const Step& now_;
  std::vector<std::size_t>& later_;
  double begin_, h_;
  const N* error_ = nullptr;
};

template <class N>
ControlledBlocks<N>::ControlledBlocks(const Block<N>& block, const BlockMethod& method,
                                      double tolerance, double least,
                                      BlockSolver<N>& solver)
    : estimate_(*method.estimate),
      first_stage_(method.first()),
      stage_end_(method.stages[first_stage_].time),
      threshold_(estimate_.threshold(tolerance)),
      limits_(StepLimits::of(method, tolerance,
                             static_cast<double>(std::numeric_limits<N>::epsilon()))),
      least_(least / block.time_unit()),
      solver_(solver),
      error_(block) {}

template <class N>
auto ControlledBlocks<N>::step(std::size_t first, std::size_t last,
                               BlockStore<N>& strands, const TimeSpan& span,
                               NewtonWork& done) -> const std::vector<Loss>& {
  lost_.clear();
  std::vector<std::size_t>& all = later_of(0);
  all.clear();
  for (std::size_t k = first; k < last; ++k) {
    if (strands.lost(k)) continue;
    all.push_back(k);
    StepLength& length = strands.length(k);
    if (!length.begun()) length.begin(limits_.first * typical_time(strands, k));
  }
  go({strands, span, done}, 0, 0);
  return lost_;
}

template <class N>
std::vector<std::size_t>& ControlledBlocks<N>::later_of(int level) {
  while (later_.size() <= static_cast<std::size_t>(level)) later_.emplace_back();
  return later_[static_cast<std::size_t>(level)];
}

/// What later_of(level) has, from `begin` on over 2^-level of the interval.
template <class N>
void ControlledBlocks<N>::go(const Step& interval, double begin, int level) {
  const double part = std::ldexp(1.0, -level), h = part * solver_.length(interval.span);
  now_.clear();
  std::vector<std::size_t>& later = later_of(level + 1);
  later.clear();
  for (const std::size_t strand : later_of(level)) {
    if (!interval.strands.lost(strand)) {
      (fits(interval.strands, strand, h) ? now_ : later).push_back(strand);
    }
  }
  if (!now_.empty()) take(interval, begin, part, later);
  if (later.empty()) return;
  go(interval, begin, level + 1);
  go(interval, begin + part / 2, level + 1);
}

/// Whether it takes a step of h.
template <class N>
bool ControlledBlocks<N>::fits(BlockStore<N>& strands, std::size_t strand,
                               double h) const {
  return strands.length(strand).next() >= h || !can_halve(strands, strand, h);
}

template <class N>
bool ControlledBlocks<N>::can_halve(const BlockStore<N>& strands, std::size_t strand,
                                    double h) const {
  return h / 2 >= std::max(least_, limits_.shortest * typical_time(strands, strand));
}

/// In which it falls by its length.
template <class N>
double ControlledBlocks<N>::typical_time(const BlockStore<N>& strands,
                                         std::size_t strand) const {
  return std::sqrt(strands.memory().length(strands.place(strand)));
}

/// The step of those in now_; those that need shorter ones go to `later`.
template <class N>
void ControlledBlocks<N>::take(const Step& interval, double begin, double part,
                               std::vector<std::size_t>& later) {
  NewtonWork& done = interval.done;
  const Step now{interval.strands, TimeSpan::part_of(interval.span, begin, part), done};
  stuck_.clear();
  Judge judge(*this, now, later, begin);
  for (const auto& [strand, reason] :
       solver_.attempt(now, {0, now_.size(), &now_}, judge)) {
    lost_.push_back({strand, begin, reason});
  }
  done.steps += static_cast<long>(stuck_.size());
  solver_.in_parts(now, stuck_, 1);
  done.steps -= static_cast<long>(stuck_.size());
  for (const std::size_t strand : stuck_) {
    lost_.push_back({strand, begin, BlockSolver<N>::no_solution});
  }
  std::ranges::sort(later);
}

template <class N>
std::size_t ControlledBlocks<N>::stepped() const {
  using Work = BlockWork<N>;
  return solver_.work.strands->kept() > 0 ? Work::renewed : Work::now;
}

/// Reference frames at the end of a step, for the next one: strands with new ones have no
/// steps behind them. They are those of lanes that are judged; others go on in theirs.
template <class N>
void ControlledBlocks<N>::renew() {
  BlockWork<N>& work = solver_.work;
  if (stepped() == work.now) return;
  work.strands->copy_block(*work.strands, work.now, work.renewed);
  work.block().work_on(*work.strands, work.renewed);
  N* const q = work.after.data();
  const Lanes renewed = work.block().renew(Instant::end, q, q + work.numbers());
  if (renewed == 0) return;
  for_lanes(2, work.lanes(), [&](std::size_t i, int lane) {
    if (has(renewed, lane)) work.lengths(work.after)[i] = N(0);
  });
}

template class ControlledBlocks<double>;
template class ControlledBlocks<float>;

}  // namespace tress::integrators
