#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "math/lane_choice.h"
#include "models/head/lane_numbers.h"
#include "models/head/stepping/lane_method.h"
#include "models/head/stepping/lane_work.h"
#include "models/head/stepping/step_length.h"

namespace tress::models {

/// Strands that wait for a lane: a range, or those of a list.
struct LaneQueue {
  std::size_t next, end;
  const std::vector<std::size_t>* list = nullptr;
  std::size_t strand() const { return list == nullptr ? next : (*list)[next]; }
};

/// The strands of a head in blocks of as many as a pack has lanes, and their ways into
/// lanes of LaneWork and back. Model: see models/head/stepping/stepped_model.h. Strands
/// of one block must not be put back by several threads at once.
template <class Model>
class LaneStrands {
 public:
  using T = typename Model::Real;
  using Strand = typename Model::Strand;
  using Element = typename Model::Element;
  static constexpr std::size_t width = T::lanes;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  using Lanes = std::array<std::size_t, width>;  // the strand in each, or none

  /// `controlled`: whether strands choose their steps.
  LaneStrands(const Model& model, const LaneMethod& method, bool controlled)
      : n_(model.elements()),
        size_(model.unknowns()),
        of_state_(method.of_state(size_)),
        needed_(method.first_steps),
        controlled_(controlled) {}

  void reserve(std::size_t strands) {
    const std::size_t blocks = (strands + width - 1) / width;
    strands_.reserve(blocks);
    elements_.reserve(n_ * blocks);
    state_.reserve(of_state_ * blocks);
    lost_.reserve(strands);
    if (controlled_) lengths_.reserve(strands);
  }
  /// write(lane, Strand, Element*, q, v) of another strand.
  template <class Write>
  void add(Write write) {
    const std::size_t block = size() / width;
    const auto lane = static_cast<int>(size() % width);
    if (lane == 0) {
      strands_.emplace_back();
      elements_.resize(elements_.size() + n_);
      state_.resize(state_.size() + of_state_, T(0));
    }
    write(lane, strands_[block], elements(block), q(block), v(block));
    // The first strand of a block fills the lanes of those that may not come.
    for (int other = 1; lane == 0 && other < T::lanes; ++other) {
      copy_lane<T>(strands_[block], 0, strands_[block], other);
      copy_changed(elements(block), q(block), 0, elements(block), q(block), other);
    }
    lost_.push_back(0);
    if (controlled_) lengths_.emplace_back();
  }

  /// Another strand, as `strand` of others is.
  void add(LaneStrands& others, std::size_t strand) {
    const std::size_t block = strand / width;
    const auto from = static_cast<int>(strand % width);
    add([&](int lane, Strand& to, Element* elements, T* q, T* /*v*/) {
      copy_lane<T>(others.strands_[block], from, to, lane);
      copy_changed(others.elements(block), others.q(block), from, elements, q, lane);
    });
  }
  /// What steps have changed of others' strand.
  void take(std::size_t strand, LaneStrands& others, std::size_t from) {
    put_home(others.elements(from / width), others.q(from / width),
             static_cast<int>(from % width), strand);
  }
  void clear() {
    strands_.clear();
    elements_.clear();
    state_.clear();
    lost_.clear();
    lengths_.clear();
  }

  std::size_t size() const { return lost_.size(); }
  std::size_t blocks() const { return strands_.size(); }
  /// Strands of a block.
  std::size_t of(std::size_t block) const {
    return std::min(width, size() - width * block);
  }
  std::size_t bytes() const {
    return blocks() * (sizeof(Strand) + n_ * sizeof(Element) + of_state_ * sizeof(T)) +
           size() + lengths_.size() * sizeof(StepLength);
  }

  const Strand& strand(std::size_t block) const { return strands_[block]; }
  Element* elements(std::size_t block) { return &elements_[n_ * block]; }
  const Element* elements(std::size_t block) const { return &elements_[n_ * block]; }
  T* q(std::size_t block) { return &state_[of_state_ * block]; }
  const T* q(std::size_t block) const { return &state_[of_state_ * block]; }
  T* v(std::size_t block) { return q(block) + size_; }
  const T* v(std::size_t block) const { return q(block) + size_; }

  bool lost(std::size_t strand) const { return lost_[strand] != 0; }
  bool some_lost(std::size_t block) const {
    return std::any_of(&lost_[width * block], &lost_[width * block] + of(block),
                       [](char lost) { return lost != 0; });
  }
  /// It rests from now on.
  void lose(std::size_t strand) {
    T* const from = v(strand / width);
    for (std::size_t k = 0; k < of_state_ - size_; ++k) {
      from[k].set(static_cast<int>(strand % width), 0);
    }
    lost_[strand] = 1;
  }

  /// Whether it takes one of its first steps.
  bool fresh(std::size_t strand) const {
    const T& length = q(strand / width)[4 * size_ + needed_ - 1];
    return lane_of(length, static_cast<int>(strand % width)) == 0;
  }
  /// Reference frames of a block for a step from this pose: strands with new ones, in
  /// lanes in which the result is > 0, have no steps behind them.
  T renew(const Model& model, std::size_t block, const RootPose& from) {
    const T renewed = model.renew(elements(block), model.clamp(strand(block), from),
                                  q(block), v(block));
    if (any_less(T(0), renewed)) forget_steps(block, renewed);
    return renewed;
  }

  /// The step of h (without units) that it was to take ends here: the last known
  /// acceleration, a_1, is that of the stage that ends at `time` of it, from which the
  /// next trial's is interpolated.
  void interrupt(std::size_t strand, double h, double time) {
    T* const lengths = q(strand / width) + 4 * size_;
    const auto lane = static_cast<int>(strand % width);
    set_lane(lengths[0], lane, -time * h);
    set_lane(lengths[1], lane, h);
  }
  /// Of a strand that chooses its steps.
  StepLength& length(std::size_t strand) { return lengths_[strand]; }

  /// Numbers that steps change of a strand: state, reference frames, whether it is lost,
  /// and the length of its next step.
  std::size_t kept() const {
    return of_state_ + Element::kept * n_ + 1 + (controlled_ ? StepLength::kept : 0);
  }
  void keep(std::size_t block, double* to) const {
    for (std::size_t k = 0; k < of(block); ++k) {
      const auto lane = static_cast<int>(k);
      for (std::size_t i = 0; i < of_state_; ++i) *to++ = lane_of(q(block)[i], lane);
      for (std::size_t i = 0; i < n_; ++i) {
        elements(block)[i].keep(lane, to);
        to += Element::kept;
      }
      *to++ = lost_[width * block + k];
      if (controlled_) to = lengths_[width * block + k].keep(to);
    }
  }
  void recall(std::size_t block, const double* from) {
    for (std::size_t k = 0; k < of(block); ++k) {
      const auto lane = static_cast<int>(k);
      for (std::size_t i = 0; i < of_state_; ++i) set_lane(q(block)[i], lane, *from++);
      for (std::size_t i = 0; i < n_; ++i) {
        elements(block)[i].recall(lane, from);
        from += Element::kept;
      }
      lost_[width * block + k] = *from++ != 0 ? 1 : 0;
      if (controlled_) from = lengths_[width * block + k].recall(from);
    }
  }

  /// Takes the next strands that are neither lost nor among `but` (sorted) into free
  /// lanes; into all lanes of a whole block at once.
  void fill(Lanes& home, LaneQueue& queue, const std::vector<std::size_t>& but,
            LaneWork<Model>& work) {
    const auto waits = [&](std::size_t strand) {
      return !lost(strand) && !std::ranges::binary_search(but, strand);
    };
    const bool all_free =
        std::ranges::all_of(home, [](std::size_t k) { return k == none; });
    if (all_free && queue.list == nullptr && queue.next < queue.end &&
        queue.next % width == 0) {
      const std::size_t block = queue.next / width;
      work.strand = strands_[block];
      std::copy_n(elements(block), n_, work.elements.begin());
      std::copy_n(q(block), of_state_, work.state.begin());
      for (std::size_t k = 0; k < width && queue.next < queue.end; ++k, ++queue.next) {
        if (waits(queue.next)) home[k] = queue.next;
      }
    }
    for (std::size_t k = 0; k < width; ++k) {
      if (home[k] != none) continue;
      while (queue.next < queue.end && !waits(queue.strand())) ++queue.next;
      if (queue.next == queue.end) return;
      home[k] = queue.strand();
      take(home[k], work, static_cast<int>(k));
      ++queue.next;
    }
  }
  void take(std::size_t strand, LaneWork<Model>& work, int lane) {
    const std::size_t block = strand / width;
    const auto from = static_cast<int>(strand % width);
    copy_lane<T>(strands_[block], from, work.strand, lane);
    copy_changed(elements(block), q(block), from, work.elements.data(), work.state.data(),
                 lane);
  }
  /// Those of `work`, or what they have become.
  void put_home(Element* changed, const T* state, int lane, std::size_t strand) {
    const std::size_t block = strand / width;
    copy_changed(changed, state, lane, elements(block), q(block),
                 static_cast<int>(strand % width));
  }

 private:
  /// What steps change of a strand, from a lane to another.
  void copy_changed(Element* from, const T* state, int lane, Element* to, T* to_state,
                    int to_lane) const {
    for (std::size_t i = 0; i < n_; ++i) copy_lane<T>(from[i], lane, to[i], to_lane);
    copy_lane(state, lane, to_state, to_lane, of_state_);
  }
  void forget_steps(std::size_t block, const T& which) {
    for (std::size_t k = 4 * size_; k < of_state_; ++k) {
      T& length = q(block)[k];
      length = where_less(T(0), which, T(0), length);
    }
  }

  std::size_t n_, size_, of_state_;  // per strand: elements, unknowns, numbers of state
  std::size_t needed_;               // steps behind a strand that is not fresh
  bool controlled_;
  std::vector<Strand> strands_;      // (blocks)
  std::vector<Element> elements_;    // (blocks, elements)
  std::vector<T> state_;             // (blocks; as LaneWork's)
  std::vector<char> lost_;           // of each strand
  std::vector<StepLength> lengths_;  // of each strand's next step, if it is controlled
};

}  // namespace tress::models
