#include "integrators/block/block_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/block/lane_loops.h"

namespace tress::integrators {
namespace {

/// Strands that are solved go home.
template <class N>
class Home final : public StepJudge {
 public:
  Home(BlockStore<N>& strands, const BlockWork<N>& work)
      : strands_(strands), work_(work) {}
  void ended() override {}
  void judged(int lane, std::size_t strand) override {
    strands_.put_home(work_, BlockWork<N>::now, lane, strand);
  }
  void failed(std::size_t /*strand*/, std::size_t /*stage*/) override {}

 private:
  BlockStore<N>& strands_;
  const BlockWork<N>& work_;
};

LaneQueue all_of(const std::vector<std::size_t>& list) { return {0, list.size(), &list}; }

}  // namespace

template <class N>
BlockSolver<N>::BlockSolver(Block<N>& block, const BlockMethod& method,
                            const NewtonLimits& newton)
    : work(block, method),
      block_(block),
      method_(method),
      newton_(newton),
      work_time_(block.time_unit()),
      some_(block.memory(), block.lanes(), block.unknowns(), method, false),
      home_(static_cast<std::size_t>(block.lanes())),
      verdicts_(home_.size()) {}

template <class N>
auto BlockSolver<N>::step(LaneQueue all, const Step& now) -> const std::vector<Loss>& {
  begin(now, all);
  if (method_.iterates) {
    if (!fresh_.empty()) start(now);
    iterate(now, all);
  } else {
    if (!fresh_.empty()) iterate(now, all_of(fresh_));
    correct_once(now, fresh_.empty() ? all : all_of(others_), not_finite);
  }
  return lost_;
}

template <class N>
auto BlockSolver<N>::attempt(const Step& now, const LaneQueue& all, StepJudge& judge)
    -> const std::vector<Loss>& {
  begin(now, all);
  if (!fresh_.empty()) start(now);
  for (std::size_t k = method_.first(); k < method_.stages.size(); ++k) {
    failed_.clear();
    PlainCourse<N> course = plain();
    const Run of{now, all, k, course, now.done.iterations, now.done.lanes};
    if (k + 1 < method_.stages.size()) {
      run(of);
    } else {
      run(of, judge);
    }
    for (const std::size_t strand : failed_) judge.failed(strand, k);
    stuck_.insert(stuck_.end(), failed_.begin(), failed_.end());
    std::ranges::sort(stuck_);
  }
  return lost_;
}

template <class N>
void BlockSolver<N>::in_parts(const Step& now, std::vector<std::size_t>& strands,
                              int parts) {
  stuck_.clear();  // strands have other numbers among some_
  for (; parts <= most_parts && !strands.empty(); parts *= 2) {
    some_.clear();
    for (const std::size_t strand : strands) some_.add(now.strands, strand);
    for (int i = 0; i < parts; ++i) take_part(now, i, parts);
    std::size_t left = 0;
    for (std::size_t k = 0; k < strands.size(); ++k) {
      if (some_.lost(k)) {
        strands[left++] = strands[k];
      } else {
        now.strands.take(strands[k], some_, k);
        now.done.shortened += parts > 1 ? 1 : 0;
      }
    }
    strands.resize(left);
  }
  set_step(now.span);
  for (const std::size_t strand : strands) now.strands.lose(strand);
}

template <class N>
void BlockSolver<N>::set_step(const TimeSpan& span) {
  block_.set_step(span.at(0), span.at(1));
}

template <class N>
void BlockSolver<N>::begin(const Step& now, const LaneQueue& all) {
  lost_.clear();
  stuck_.clear();
  set_step(now.span);
  find_fresh(all, now.strands);
}

/// Which of these strands take first steps.
template <class N>
void BlockSolver<N>::find_fresh(LaneQueue all, const BlockStore<N>& strands) {
  fresh_.clear();
  others_.clear();
  if (method_.first_steps == 0) return;
  for (; all.next < all.end; ++all.next) {
    (strands.fresh(all.strand()) ? fresh_ : others_).push_back(all.strand());
  }
}

/// Those of the fresh ones that have no acceleration are lost.
template <class N>
void BlockSolver<N>::start(const Step& now) {
  correct_once(now, all_of(fresh_), "no acceleration at the start");
}

/// One correction of the first stage, or the strand is lost.
template <class N>
void BlockSolver<N>::correct_once(const Step& now, const LaneQueue& queue,
                                  std::string_view reason) {
  failed_.clear();
  SingleCourse<N> single;
  run({now, queue, 0, single, now.done.iterations, now.done.lanes});
  for (const std::size_t strand : failed_) lose(now, strand, reason);
}

template <class N>
PlainCourse<N> BlockSolver<N>::plain() const {
  return {newton_.tolerance, newton_.left, newton_.iterations};
}

template <class N>
void BlockSolver<N>::iterate(const Step& now, const LaneQueue& all) {
  NewtonWork& done = now.done;
  for (std::size_t k = method_.first(); k < method_.stages.size(); ++k) {
    PlainCourse<N> course = plain();
    failed_.clear();
    run({now, all, k, course, done.iterations, done.lanes});
    done.retried += static_cast<long>(failed_.size());
    damp(now, k);
    stuck_.insert(stuck_.end(), failed_.begin(), failed_.end());
    std::ranges::sort(stuck_);
  }
  unsolved_.swap(stuck_);
  in_parts(now, unsolved_, 2);
  for (const std::size_t strand : unsolved_) lost_.push_back({strand, no_solution});
}

/// A stage of those in failed_, where those remain on which this fails, too: damped
/// corrections from everywhere.
template <class N>
void BlockSolver<N>::damp(const Step& now, std::size_t stage) {
  NewtonWork& done = now.done;
  for (const NewtonStart from :
       {NewtonStart::guess, NewtonStart::zero, NewtonStart::standstill}) {
    if (failed_.empty()) return;
    waiting_.swap(failed_);
    failed_.clear();
    std::ranges::sort(waiting_);
    DampedCourse<N> damped(newton_.tolerance, newton_.iterations);
    run({now, all_of(waiting_), stage, damped, done.again_iterations, done.again_lanes,
         from});
    done.again_iterations += damped.iterations;
    done.again_lanes += damped.lanes;
  }
}

/// Of some_: those on which it fails are lost there.
template <class N>
void BlockSolver<N>::take_part(const Step& whole, int i, int parts) {
  NewtonWork done;
  const double part = 1.0 / parts;
  const Step now{some_, TimeSpan::part_of(whole.span, i * part, part), done};
  set_step(now.span);
  if (i > 0) renew(now);
  for (std::size_t k = method_.first(); k < method_.stages.size(); ++k) {
    PlainCourse<N> course = plain();
    failed_.clear();
    run({now, {0, some_.size()}, k, course, done.again_iterations, done.again_lanes});
    damp(now, k);
    for (const std::size_t strand : failed_) some_.lose(strand);
  }
  done.in_parts = done.again_iterations;
  whole.done += done;
}

/// Strands with new reference frames have no steps behind them, and the first stage to
/// solve if there is one.
template <class N>
void BlockSolver<N>::renew(const Step& now) {
  waiting_.clear();
  for (std::size_t block = 0; block < some_.blocks(); ++block) {
    const Lanes renewed = some_.renew(block_, block);
    for (std::size_t k = 0; k < some_.of(block); ++k) {
      if (has(renewed, static_cast<int>(k))) waiting_.push_back(home_.size() * block + k);
    }
  }
  if (waiting_.empty() || method_.first() == 0) return;
  SingleCourse<N> single;
  failed_.clear();
  run({now, all_of(waiting_), 0, single, now.done.again_iterations,
       now.done.again_lanes});
  for (const std::size_t strand : failed_) some_.lose(strand);
}

template <class N>
void BlockSolver<N>::run(const Run& of) {
  Home<N> home(of.now.strands, work);
  run(of, home);
}

template <class N>
void BlockSolver<N>::run(Run of, StepJudge& judge) {
  constexpr std::size_t none = BlockStore<N>::none;
  const BlockStage& stage = method_.stages[of.stage];
  block_.set_stage(of.now.span.at(stage.time));
  const double h = length(of.now.span), loads = of.now.span.length(stage.gamma);
  std::ranges::fill(home_, none);
  for (bool refill = true;;) {
    if (refill) {
      before_ = home_;
      of.now.strands.fill(home_, of.queue, stuck_, work);
      if (std::ranges::all_of(home_, [](std::size_t k) { return k == none; })) break;
      Lanes starts = 0;
      for (std::size_t k = 0; k < home_.size(); ++k) {
        if (before_[k] == none) starts |= Lanes{1} << k;
      }
      work.begin(of.stage, h, loads, starts, of.from);
      for (std::size_t k = 0; k < home_.size(); ++k) {
        if (before_[k] == none) of.course.start(static_cast<int>(k), work);
      }
      refill = false;
    }
    work.newton(of.course.whole());
    of.course.go_on(work, verdicts_);
    of.lanes += work.lanes();
    bool ended = false;
    for (std::size_t k = 0; k < home_.size(); ++k) {
      if (home_[k] == none) continue;
      ++of.iterations;
      if (verdicts_[k] == NewtonVerdict::go_on) continue;
      if (verdicts_[k] == NewtonVerdict::converged) {
        if (!ended) {
          work.end();
          judge.ended();
        }
        ended = true;
        judge.judged(static_cast<int>(k), home_[k]);
      } else {
        failed_.push_back(home_[k]);
      }
      home_[k] = none;
      refill = true;
    }
  }
}

template <class N>
auto BlockSolver<N>::correct_blocks(std::size_t first, std::size_t last, const Step& now)
    -> const std::vector<Loss>& {
  lost_.clear();
  set_step(now.span);
  const double h = length(now.span);
  std::ranges::fill_n(work.a(), static_cast<std::ptrdiff_t>(work.numbers()), N(0));
  for (std::size_t block = first; block < last; ++block) correct_block(block, now, h);
  return lost_;
}

template <class N>
void BlockSolver<N>::correct_block(std::size_t block, const Step& now, double h) {
  BlockStore<N>& strands = now.strands;
  N *const q = strands.q(block), *const v = strands.v(block);
  block_.work_on(strands.memory(), block);
  block_.predict(Instant::end, h, q, v, work.q_bar.data());
  block_.meet(Instant::end, now.span.length(1), work.q_bar.data(), v);
  block_.newton({1, h, h * h}, work.q_bar.data(), v, work.a(), work.step.data(),
                work.size.data());
  const auto pos = static_cast<N>(h * h), vel = static_cast<N>(h);
  const N *const step = work.step.data(), *const q_bar = work.q_bar.data();
  const bool finite = std::ranges::all_of(
      work.size, [](N size) { return size <= std::numeric_limits<N>::max(); });
  if (finite && !strands.some_lost(block)) [[likely]] {
    for (std::size_t i = 0; i < work.numbers(); ++i) {
      v[i] -= vel * step[i];
      q[i] = q_bar[i] - pos * step[i];
    }
    return;
  }
  const std::size_t width = home_.size();
  for (std::size_t k = 0; k < strands.of(block); ++k) {
    if (strands.lost(width * block + k)) continue;
    if (!std::isfinite(work.size[k])) {
      lose(now, width * block + k, not_finite);
      continue;
    }
    for (std::size_t i = k; i < work.numbers(); i += width) {
      v[i] -= vel * step[i];
      q[i] = q_bar[i] - pos * step[i];
    }
  }
}

template <class N>
void BlockSolver<N>::lose(const Step& now, std::size_t strand, std::string_view reason) {
  now.strands.lose(strand);
  lost_.push_back({strand, reason});
}

template class BlockSolver<double>;
template class BlockSolver<float>;

}  // namespace tress::integrators
