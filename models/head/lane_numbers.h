#pragma once

#include <cstddef>
#include <span>

#include "math/lanes.h"

namespace tress::models {

/// The numbers of something that is made of T only.
template <class T, class S>
std::span<T> numbers_of(S& s) {
  static_assert(sizeof(S) % sizeof(T) == 0 && alignof(S) == alignof(T));
  return {reinterpret_cast<T*>(&s), sizeof(S) / sizeof(T)};
}
/// Returns the numbers that a structure consists of.
template <class T, class S>
std::span<const T> numbers_of(const S& s) {
  static_assert(sizeof(S) % sizeof(T) == 0 && alignof(S) == alignof(T));
  return {reinterpret_cast<const T*>(&s), sizeof(S) / sizeof(T)};
}

/// Copies the numbers of one strand between lanes.
template <class T>
void copy_lane(const T* from, int lane_from, T* to, int lane_to, std::size_t numbers) {
  for (std::size_t k = 0; k < numbers; ++k) to[k].v[lane_to] = from[k].v[lane_from];
}
/// Copies one lane of a structure.
template <class T, class S>
void copy_lane(const S& from, int lane_from, S& to, int lane_to) {
  const std::span<const T> numbers = numbers_of<T>(from);
  copy_lane(numbers.data(), lane_from, numbers_of<T>(to).data(), lane_to, numbers.size());
}

}  // namespace tress::models
