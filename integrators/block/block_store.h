#pragma once

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "integrators/block/block_work.h"
#include "integrators/block/step_length.h"

namespace tress::integrators {

/// Strands that wait for a lane: a range, or those of a list.
struct LaneQueue {
  std::size_t next, end;  // range of places in `list`, or of strands
  /// Strands in order; null: the range counts strands.
  const std::vector<std::size_t>* list = nullptr;
  /// Returns the strand that is next.
  std::size_t strand() const { return list == nullptr ? next : (*list)[next]; }
};

/// Many strands in blocks with one strand per lane. Moves strands into lanes of BlockWork
/// and back. Two threads must not put back strands of one block at the same time.
template <class N>
class BlockStore {
 public:
  /// Marks a lane without a strand.
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  using Home = std::vector<std::size_t>;  // the strand in each lane, or none

  /// `controlled`: whether strands choose their steps.
  BlockStore(std::unique_ptr<StrandMemory> memory, int lanes, std::size_t unknowns,
             const BlockMethod& method, bool controlled);

  /// Allocates memory for a number of strands.
  void reserve(std::size_t strands);
  /// write(place, memory, q, v) of another strand, whose numbers are those of its block.
  template <class Write>
  void add(Write write) {
    const LanePlace to = place(size());
    if (to.lane == 0) {
      memory_->resize(to.block + 1);
      state_.resize(state_.size() + of_block_, N(0));
    }
    write(to, *memory_, q(to.block), v(to.block));
    if (to.lane == 0) fill_block(to.block);
    lost_.push_back(0);
    if (controlled_) lengths_.emplace_back();
  }
  /// Another strand, with the whole state of `strand` of others.
  void add(const BlockStore& others, std::size_t strand);
  /// Copies from a strand of `others` the data that steps change.
  void take(std::size_t strand, const BlockStore& others, std::size_t from);
  /// Removes all strands.
  void clear();

  /// Returns the number of strands.
  std::size_t size() const { return lost_.size(); }
  /// Returns the number of blocks.
  std::size_t blocks() const { return memory_->blocks(); }
  /// Strands of a block.
  std::size_t of(std::size_t block) const {
    return std::min(width_, size() - width_ * block);
  }
  /// Returns the size of all data, bytes.
  std::size_t bytes() const {
    return memory_->bytes() + blocks() * of_block_ * sizeof(N) + size() +
           lengths_.size() * sizeof(StepLength);
  }

  /// Returns the block and lane of a strand.
  LanePlace place(std::size_t strand) const {
    return {strand / width_, static_cast<int>(strand % width_)};
  }
  /// Returns the model's data of the strands.
  StrandMemory& memory() { return *memory_; }
  /// Returns the model's data of the strands.
  const StrandMemory& memory() const { return *memory_; }
  /// Returns the coordinates of a block.
  N* q(std::size_t block) { return &state_[of_block_ * block]; }
  /// Returns the coordinates of a block.
  const N* q(std::size_t block) const { return &state_[of_block_ * block]; }
  /// Returns the rates of a block.
  N* v(std::size_t block) { return q(block) + size_ * width_; }
  /// Returns the rates of a block.
  const N* v(std::size_t block) const { return q(block) + size_ * width_; }

  /// Returns true if the strand has failed.
  bool lost(std::size_t strand) const { return lost_[strand] != 0; }
  /// Returns true if a strand of the block has failed.
  bool some_lost(std::size_t block) const;
  /// Marks a strand as failed: it rests from now on.
  void lose(std::size_t strand);

  /// Whether it takes one of its first steps.
  bool fresh(std::size_t strand) const {
    const LanePlace at = place(strand);
    return q(at.block)[(4 * size_ + needed_ - 1) * width_ +
                       static_cast<std::size_t>(at.lane)] == N(0);
  }
  /// Reference frames for a step: strands with new ones, which it returns, have no steps
  /// behind them.
  Lanes renew(Block<N>& by, std::size_t block);

  /// Ends the current step of h early. The last known acceleration a_1 is then that of
  /// the stage that ends at the fraction `time` of the step; the next trial interpolates
  /// from it.
  void interrupt(std::size_t strand, double h, double time);
  /// Returns the step-length control of a strand that chooses its steps.
  StepLength& length(std::size_t strand) { return lengths_[strand]; }

  /// Numbers that steps change of a strand: state, what else its model knows, whether it
  /// is lost, and the length of its next step.
  std::size_t kept() const {
    return of_state_ + memory_->kept() + 1 + (controlled_ ? StepLength::kept : 0);
  }
  /// Writes all numbers of a block that steps change, for checkpoints.
  void keep(std::size_t block, double* to) const;
  /// Restores what keep() wrote.
  void recall(std::size_t block, const double* from);

  /// Takes the next strands that are neither lost nor among `but` (sorted) into free
  /// lanes; into all lanes of a whole block at once.
  void fill(Home& home, LaneQueue& queue, const std::vector<std::size_t>& but,
            BlockWork<N>& work) const;
  /// Stores the results of a step for a strand in a lane: its state, and its data of
  /// `which` (now or renewed) of `work`.
  void put_home(const BlockWork<N>& work, std::size_t which, int lane,
                std::size_t strand);

 private:
  void fill_block(std::size_t block);
  void copy_state(const N* from, int lane, N* to, int to_lane) const;

  std::unique_ptr<StrandMemory> memory_;
  std::size_t width_, size_, of_state_, of_block_;  // lanes; unknowns and numbers of
                                                    // state of a strand; of a block
  std::size_t needed_;  // steps behind a strand that is not fresh
  bool controlled_;
  LaneVector<N> state_;              // (blocks; as BlockWork's)
  std::vector<char> lost_;           // of each strand
  std::vector<StepLength> lengths_;  // of each strand's next step, if it is controlled
};

extern template class BlockStore<double>;
extern template class BlockStore<float>;

}  // namespace tress::integrators
