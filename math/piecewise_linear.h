#pragma once

#include <algorithm>
#include <functional>
#include <iterator>

namespace tress {

/// Rows of a table on either side of a place, and the share of the way between them.
template <class Row>
struct BetweenRows {
  const Row *before, *after;  // the same row at and beyond the ends of the table
  double part;                // 0 at `before`, 1 at `after`
};

/// Returns the rows on either side of x, for values that are linear between rows and
/// constant beyond them. `rows` has at least one row and ascends by key(row). Of two rows
/// with one key, the second counts from there on.
template <class Rows, class Key>
auto between_rows(const Rows& rows, double x, Key key) {
  using Row = typename Rows::value_type;
  const auto after = std::ranges::upper_bound(rows, x, {}, key);
  if (after == rows.begin()) return BetweenRows<Row>{&rows.front(), &rows.front(), 0};
  const Row& before = *std::prev(after);
  if (after == rows.end()) return BetweenRows<Row>{&before, &before, 0};
  const double from = std::invoke(key, before);
  return BetweenRows<Row>{&before, &*after,
                          (x - from) / (std::invoke(key, *after) - from)};
}

}  // namespace tress
