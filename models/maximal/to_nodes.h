#pragma once

namespace tress::models {

/// Converts h over the edge between two nodes and `others` more coordinates to a matrix
/// over the two nodes and the others.
template <int others>
void to_nodes(const double (&h)[3 + others][3 + others],
              double (&m)[6 + others][6 + others]) {
  const auto of = [](int i) { return i < 3 ? i : i - 3; };
  const auto sign = [](int i) { return i < 3 ? -1.0 : 1.0; };
  for (int i = 0; i < 6 + others; ++i) {
    for (int j = 0; j < 6 + others; ++j) m[i][j] = sign(i) * sign(j) * h[of(i)][of(j)];
  }
}

}  // namespace tress::models
