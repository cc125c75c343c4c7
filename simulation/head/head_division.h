#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "math/vec3.h"

namespace tress::simulation {

/// Division of a batch's strands among ranks, and their order. Strands are known by their
/// number in the batch. A rank has its own at places from 0 on, in groups of neighbouring
/// roots, within a group by their numbers.
class HeadDivision {
 public:
  /// One rank has all, strand k at place k.
  explicit HeadDivision(std::size_t strands);
  /// Divides the scalp into regions of about equal sums of `cost` (of each strand,
  /// positive). The roots are bisected recursively across the longer side of their box.
  /// There must be at least one strand per rank. The result is the same on all ranks but
  /// for `rank`, whose places these are.
  HeadDivision(std::span<const Vec> roots, std::span<const double> cost, int ranks,
               int rank);

  std::size_t strands() const { return owner_.size(); }  // of the head
  /// Returns the number of ranks.
  int ranks() const { return ranks_; }
  /// Returns the rank that owns a strand.
  int owner(std::size_t strand) const { return owner_[strand]; }
  /// Numbers of this rank's own strands, by their places.
  std::span<const std::size_t> own() const { return own_; }
  /// The i-th of them by their numbers.
  std::size_t number(std::size_t i) const { return own_[by_number_[i]]; }
  /// Returns the places of own strands, by their numbers.
  std::span<const std::size_t> by_number() const { return by_number_; }
  /// The other way: of each place, which it is by the numbers.
  std::span<const std::size_t> order() const { return order_; }

  /// An own strand of a list.
  struct Listed {
    std::size_t place, index;  // index: among the own ones of the list
  };
  /// Own strands among these, ascending numbers; by their places.
  std::vector<Listed> own_among(std::span<const std::size_t> numbers) const;
  /// Returns the number of these strands that each rank has.
  std::vector<std::size_t> counts(std::span<const std::size_t> numbers) const;

 private:
  void order_own();

  int ranks_ = 1, rank_ = 0;
  std::vector<int> owner_;  // of each strand
  std::vector<std::size_t> own_, by_number_, order_;
};

}  // namespace tress::simulation
