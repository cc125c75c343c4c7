#include "integrators/block/block_store.h"

#include <algorithm>
#include <utility>

#include "integrators/block/lane_loops.h"

namespace tress::integrators {

template <class N>
BlockStore<N>::BlockStore(std::unique_ptr<StrandMemory> memory, int lanes,
                          std::size_t unknowns, const BlockMethod& method,
                          bool controlled)
    : memory_(std::move(memory)),
      width_(static_cast<std::size_t>(lanes)),
      size_(unknowns),
      of_state_(method.of_state(unknowns)),
      of_block_(of_state_ * width_),
      needed_(method.first_steps),
      controlled_(controlled) {}

template <class N>
void BlockStore<N>::reserve(std::size_t strands) {
  const std::size_t blocks = (strands + width_ - 1) / width_;
  memory_->reserve(blocks);
  state_.reserve(of_block_ * blocks);
  lost_.reserve(strands);
  if (controlled_) lengths_.reserve(strands);
}

/// The first strand of a block fills the lanes of those that may not come.
template <class N>
void BlockStore<N>::fill_block(std::size_t block) {
  for (int other = 1; other < static_cast<int>(width_); ++other) {
    memory_->copy(*memory_, {block, 0}, {block, other});
    copy_state(q(block), 0, q(block), other);
  }
}

template <class N>
void BlockStore<N>::add(const BlockStore& others, std::size_t strand) {
  const LanePlace from = place(strand);
  add([&](LanePlace to, StrandMemory& memory, N* q, N* /*v*/) {
    memory.copy(*others.memory_, from, to);
    copy_state(others.q(from.block), from.lane, q, to.lane);
  });
}

template <class N>
void BlockStore<N>::take(std::size_t strand, const BlockStore& others, std::size_t from) {
  const LanePlace of = place(from), to = place(strand);
  memory_->copy_changed(*others.memory_, of, to);
  copy_state(others.q(of.block), of.lane, q(to.block), to.lane);
}

template <class N>
void BlockStore<N>::clear() {
  memory_->resize(0);
  state_.clear();
  lost_.clear();
  lengths_.clear();
}

template <class N>
bool BlockStore<N>::some_lost(std::size_t block) const {
  const char* const from = &lost_[width_ * block];
  return std::any_of(from, from + of(block), [](char lost) { return lost != 0; });
}

template <class N>
void BlockStore<N>::lose(std::size_t strand) {
  const LanePlace at = place(strand);
  N* const from = v(at.block) + at.lane;
  for (std::size_t k = 0; k < of_state_ - size_; ++k) from[k * width_] = N(0);
  lost_[strand] = 1;
}

template <class N>
Lanes BlockStore<N>::renew(Block<N>& by, std::size_t block) {
  by.work_on(*memory_, block);
  const Lanes renewed = by.renew(Instant::start, q(block), v(block));
  if (renewed == 0) return renewed;
  for_lanes(of_state_, static_cast<int>(width_), [&](std::size_t i, int lane) {
    if (i >= 4 * size_ * width_ && has(renewed, lane)) q(block)[i] = N(0);
  });
  return renewed;
}

template <class N>
void BlockStore<N>::interrupt(std::size_t strand, double h, double time) {
  const LanePlace at = place(strand);
  N* const lengths = q(at.block) + 4 * size_ * width_ + at.lane;
  lengths[0] = static_cast<N>(-time * h);
  lengths[width_] = static_cast<N>(h);
}

template <class N>
void BlockStore<N>::keep(std::size_t block, double* to) const {
  for (std::size_t k = 0; k < of(block); ++k) {
    for (std::size_t i = 0; i < of_state_; ++i) {
      *to++ = static_cast<double>(q(block)[i * width_ + k]);
    }
    memory_->keep({block, static_cast<int>(k)}, to);
    to += memory_->kept();
    *to++ = lost_[width_ * block + k];
    if (controlled_) to = lengths_[width_ * block + k].keep(to);
  }
}

template <class N>
void BlockStore<N>::recall(std::size_t block, const double* from) {
  for (std::size_t k = 0; k < of(block); ++k) {
    for (std::size_t i = 0; i < of_state_; ++i) {
      q(block)[i * width_ + k] = static_cast<N>(*from++);
    }
    memory_->recall({block, static_cast<int>(k)}, from);
    from += memory_->kept();
    lost_[width_ * block + k] = *from++ != 0 ? 1 : 0;
    if (controlled_) from = lengths_[width_ * block + k].recall(from);
  }
}

template <class N>
void BlockStore<N>::fill(Home& home, LaneQueue& queue,
                         const std::vector<std::size_t>& but, BlockWork<N>& work) const {
  const auto waits = [&](std::size_t strand) {
    return !lost(strand) && !std::ranges::binary_search(but, strand);
  };
  const bool all_free =
      std::ranges::all_of(home, [](std::size_t k) { return k == none; });
  if (all_free && queue.list == nullptr && queue.next < queue.end &&
      queue.next % width_ == 0) {
    const std::size_t block = queue.next / width_;
    work.strands->copy_block(*memory_, block, BlockWork<N>::now);
    std::copy_n(q(block), of_block_, work.state.begin());
    for (std::size_t k = 0; k < width_ && queue.next < queue.end; ++k, ++queue.next) {
      if (waits(queue.next)) home[k] = queue.next;
    }
  }
  for (std::size_t k = 0; k < width_; ++k) {
    if (home[k] != none) continue;
    while (queue.next < queue.end && !waits(queue.strand())) ++queue.next;
    if (queue.next == queue.end) return;
    home[k] = queue.strand();
    const LanePlace from = place(home[k]);
    const auto lane = static_cast<int>(k);
    work.strands->copy(*memory_, from, {BlockWork<N>::now, lane});
    copy_state(q(from.block), from.lane, work.state.data(), lane);
    ++queue.next;
  }
}

template <class N>
void BlockStore<N>::put_home(const BlockWork<N>& work, std::size_t which, int lane,
                             std::size_t strand) {
  const LanePlace to = place(strand);
  memory_->copy_changed(*work.strands, {which, lane}, to);
  copy_state(work.after.data(), lane, q(to.block), to.lane);
}

template <class N>
void BlockStore<N>::copy_state(const N* from, int lane, N* to, int to_lane) const {
  from += lane;
  to += to_lane;
  for (std::size_t k = 0; k < of_block_; k += width_) to[k] = from[k];
}

template class BlockStore<double>;
template class BlockStore<float>;

}  // namespace tress::integrators
