#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace tress {

/// Memory that starts at the alignment of the widest pack (math/pack.h).
template <class N>
struct LaneAllocator {
  /// Type of the elements, as allocators name it.
  using value_type = N;
  static constexpr std::align_val_t alignment{64};  // alignment in bytes

  LaneAllocator() = default;
  /// Converts from the allocator of other elements, which has no state.
  template <class M>
  LaneAllocator(const LaneAllocator<M>& /*other*/) {}  // NOLINT: as allocators convert

  /// Allocates memory for `count` elements.
  N* allocate(std::size_t count) {
    return static_cast<N*>(::operator new(count * sizeof(N), alignment));
  }
  /// Frees memory of allocate().
  void deallocate(N* at, std::size_t /*count*/) { ::operator delete(at, alignment); }
  friend bool operator==(const LaneAllocator&, const LaneAllocator&) { return true; }
};

/// Numbers of W strands: entry k of lane l at [k W + l], which kernels read as packs.
template <class N>
using LaneVector = std::vector<N, LaneAllocator<N>>;

}  // namespace tress
