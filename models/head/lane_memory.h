#pragma once

#include <algorithm>
#include <vector>

#include "contract/block.h"
#include "models/head/lane_model.h"
#include "models/head/lane_numbers.h"

namespace tress::models {

/// Memory of the strands of a LaneModel.
template <LaneModel Model>
class LaneMemory final : public StrandMemory {
 public:
  /// Scalar: a number, or a pack of SIMD lanes.
  using T = typename Model::Real;
  /// Data of a strand that steps do not change.
  using Strand = typename Model::Strand;
  /// Data of an element that steps change.
  using Element = typename Model::Element;

  /// `model` must outlive it.
  explicit LaneMemory(const Model& model) : model_(model), n_(model.elements()) {}

  /// Returns the constant data of a block's strands.
  Strand& strand(std::size_t block) { return strands_[block]; }
  /// Returns the constant data of a block's strands.
  const Strand& strand(std::size_t block) const { return strands_[block]; }
  /// Returns the elements of a block's strands.
  Element* elements(std::size_t block) { return &elements_[n_ * block]; }
  /// Returns the elements of a block's strands.
  const Element* elements(std::size_t block) const { return &elements_[n_ * block]; }

  std::size_t blocks() const override { return strands_.size(); }
  void reserve(std::size_t blocks) override {
    strands_.reserve(blocks);
    elements_.reserve(n_ * blocks);
  }
  void resize(std::size_t blocks) override {
    strands_.resize(blocks);
    elements_.resize(n_ * blocks);
  }
  std::size_t bytes() const override {
    return blocks() * (sizeof(Strand) + n_ * sizeof(Element));
  }

  void copy(const StrandMemory& from, LanePlace of, LanePlace to) override {
    const auto& other = static_cast<const LaneMemory&>(from);
    copy_lane<T>(other.strands_[of.block], of.lane, strands_[to.block], to.lane);
    copy_elements(other, of, to);
  }
  void copy_block(const StrandMemory& from, std::size_t of, std::size_t to) override {
    const auto& other = static_cast<const LaneMemory&>(from);
    strands_[to] = other.strands_[of];
    std::copy_n(other.elements(of), n_, elements(to));
  }
  void copy_changed(const StrandMemory& from, LanePlace of, LanePlace to) override {
    if constexpr (Element::kept > 0) {
      copy_elements(static_cast<const LaneMemory&>(from), of, to);
    }
  }

  std::size_t kept() const override { return Element::kept * n_; }
  void keep(LanePlace of, double* to) const override {
    for (std::size_t i = 0; i < n_; ++i, to += Element::kept) {
      elements(of.block)[i].keep(of.lane, to);
    }
  }
  void recall(LanePlace of, const double* from) override {
    for (std::size_t i = 0; i < n_; ++i, from += Element::kept) {
      elements(of.block)[i].recall(of.lane, from);
    }
  }

  double length(LanePlace of) const override {
    return lane_of(T(static_cast<double>(n_)) * model_.element_length(strand(of.block)),
                   of.lane);
  }

 private:
  void copy_elements(const LaneMemory& from, LanePlace of, LanePlace to) {
    for (std::size_t i = 0; i < n_; ++i) {
      copy_lane<T>(from.elements(of.block)[i], of.lane, elements(to.block)[i], to.lane);
    }
  }

  const Model& model_;
  std::size_t n_;
  std::vector<Strand> strands_;    // (blocks)
  std::vector<Element> elements_;  // (blocks, elements)
};

}  // namespace tress::models
