#pragma once

#include <cstddef>

namespace tress {

/// Returns the value at x of the Lagrange polynomial that is 1 at node k of `count` nodes
/// and 0 at the others. `node(j)` is the place of node j; nodes differ. O(count).
template <class Node>
double lagrange(std::size_t k, std::size_t count, double x, Node node) {
  double value = 1;
  for (std::size_t j = 0; j < count; ++j) {
    if (j != k) value *= (x - node(j)) / (node(k) - node(j));
  }
  return value;
}

}  // namespace tress
