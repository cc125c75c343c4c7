#pragma once

#include <cstddef>

namespace tress {

/// Lets `count` objects come into the cache while other work is done.
template <class T>
void fetch(const T* first, std::size_t count) {
  constexpr std::size_t line = 64;  // bytes
  const char* const begin = reinterpret_cast<const char*>(first);
  const std::size_t bytes = count * sizeof(T);
  if (bytes == 0) return;
  for (std::size_t at = 0; at < bytes; at += line) __builtin_prefetch(begin + at);
  __builtin_prefetch(begin + bytes - 1);
}

}  // namespace tress
