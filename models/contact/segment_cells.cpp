#include "models/contact/segment_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "math/fetch.h"

namespace tress::models {
namespace {

// Longest part over segments of usual length; parts of the longest one that is cut.
constexpr double part_over_usual = 1.1, longest_parts = 64;
// Where segments are much longer than the reach they lie in parts of so many times the
// reach, but so many of a usual segment at most, by the memory that they take.
constexpr double much_longer = 4, part_over_reach = 2, parts_of_usual = 16;
// Cells over the reach: smaller ones fit closer but are more runs of numbers.
constexpr double cell_over_reach = 1;
constexpr double cells_over_parts = 2;  // at most
// Shares of points below and above which the grid may end, and points that tell.
constexpr double outside = 0.05;
constexpr std::size_t sampled = 4096;
constexpr std::size_t slabs = 8;   // ranges of cells, each a piece of work
constexpr double rounding = 1e-9;  // of lengths that are compared to places
// Across the grid: with either sign 16 bits.
constexpr double most_steps = 2 * std::numeric_limits<std::int16_t>::max();

constexpr int at_once = 4;                // parts that a search looks at
constexpr std::size_t rows_at_once = 16;  // of cells, fetched together
using Shorts __attribute__((vector_size(32))) = std::int16_t;
using Longs __attribute__((vector_size(32))) = std::int64_t;
// Of one place, along each axis.
using Along __attribute__((vector_size(32))) = double;
using Whole __attribute__((vector_size(16))) = int;

Along along(const Vec& x) { return Along{x.x, x.y, x.z, 0}; }
/// Of what is in [0, most]; of what is not, NaN too, of its ends.
Whole whole(Along at, const Along& most) {
  at = at > 0 ? at : Along{};
  return __builtin_convertvector(at < most ? at : most, Whole);
}

/// Shorts in pairs: least, the most negated, so that all are compared the same way, and
/// a number. Not by way of memory, where smaller numbers would be waited for.
Whole bounds(const Whole& least, const Whole& most, int number) {
  using Four __attribute__((vector_size(8))) = std::int16_t;
  const Four a = __builtin_convertvector(least, Four),
             b = __builtin_convertvector(-most, Four);
  Whole all = std::bit_cast<Whole>(__builtin_shufflevector(a, b, 0, 1, 2, 4, 5, 6, 6, 6));
  all[3] = number;
  return all;
}

/// Of parts from there on: not 0 where no number of one, 16 bytes each, is above the
/// limit.
template <class Part>
Longs within(const Part* parts, const Shorts& limit) {
  static_assert(sizeof(Part) == 16);
  Shorts two, more;
  std::memcpy(&two, parts, sizeof two);
  std::memcpy(&more, parts + 2, sizeof more);
  const auto a = std::bit_cast<Longs>(two > limit),
             b = std::bit_cast<Longs>(more > limit);
  return (__builtin_shufflevector(a, b, 0, 2, 4, 6) |
          __builtin_shufflevector(a, b, 1, 3, 5, 7)) == 0;
}

/// A value with the share `below` of the others below it, of those that are finite.
double quantile(std::vector<double>& values, double below) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(
                                       below * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

StraightPiece piece_at(In x, int segment) {
  const double* from = &x[3 * static_cast<std::size_t>(segment)];
  return {load3(from), load3(from + 3)};
}

}  // namespace

SegmentCells::SegmentCells(std::span<const int> points) : first_{0} {
  for (std::size_t k = 0; k < points.size(); ++k) {
    polyline_.insert(polyline_.end(), static_cast<std::size_t>(points[k]),
                     static_cast<int>(k));
    first_.push_back(static_cast<int>(polyline_.size()));
  }
  start_.assign(2, 0);
}

void SegmentCells::fill(In x, double reach, const Loop& loop) {
  choose_parts(x, reach);
  part_.resize(points() + 1);
  in_parts(points(), loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      part_[i + 1] = number_of_parts(static_cast<int>(i), x);
    }
  });
  part_[0] = 0;
  long_.clear();
  for (std::size_t i = 0; i < points(); ++i) {
    if (part_[i + 1] < 0) {
      long_.push_back(static_cast<int>(i));
      part_[i + 1] = 0;
    }
    part_[i + 1] += part_[i];
  }
  choose_cells(x, static_cast<std::size_t>(part_.back()));
  sort(x, loop);
}

double SegmentCells::longest_part(double usual, double reach) {
  return usual > much_longer * reach
             ? std::max(part_over_reach * reach, usual / parts_of_usual)
             : std::max(usual, reach);
}

void SegmentCells::choose_parts(In x, double reach) {
  std::vector<double> lengths;
  const std::size_t stride = 1 + points() / sampled;
  for (std::size_t i = 0; i + 1 < points(); i += stride) {
    const double square = last(static_cast<int>(i))
                              ? 0
                              : dot(piece_at(x, static_cast<int>(i)).edge,
                                    piece_at(x, static_cast<int>(i)).edge);
    if (square > 0 && std::isfinite(square)) lengths.push_back(std::sqrt(square));
  }
  const double usual = part_over_usual * quantile(lengths, 1 - outside);
  longest_ = longest_part(usual, reach);
  divided_ = longest_ < usual;
  cell_ = cell_over_reach * reach;
}

/// -1: it is long. A segment that is not finite is near to nothing.
int SegmentCells::number_of_parts(int segment, In x) const noexcept {
  if (last(segment)) return 0;
  const StraightPiece all = piece_at(x, segment);
  const double length = std::sqrt(dot(all.edge, all.edge));
  if (length <= longest_parts * longest_) {
    return std::max(1, static_cast<int>(std::ceil(length / longest_)));
  }
  return is_finite(all.start) && is_finite(all.edge) ? -1 : 0;
}

void SegmentCells::choose_cells(In x, std::size_t parts) {
  double across[3], *corner[3] = {&corner_.x, &corner_.y, &corner_.z};
  std::vector<double> values;
  const std::size_t stride = 1 + points() / sampled;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    values.clear();
    for (std::size_t i = axis; i < x.size(); i += 3 * stride) {
      if (std::abs(x[i]) < 1e100) values.push_back(x[i]);
    }
    const double least = quantile(values, outside), most = quantile(values, 1 - outside),
                 beyond = 0.25 * (most - least) + longest_;
    *corner[axis] = least - beyond;
    across[axis] = most - least + 2 * beyond;
  }
  const double limit = cells_over_parts * static_cast<double>(parts) + 1;
  const auto number = [&](std::size_t axis) {
    return std::max(1.0, std::ceil(across[axis] / cell_));
  };
  while (number(0) * number(1) * number(2) > limit && cell_ < 1e200) cell_ *= 1.1;
  inverse_cell_ = 1 / cell_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    count_[axis] = static_cast<int>(std::min(number(axis), limit));
    steps_[axis] = most_steps * inverse_cell_ / count_[axis];
  }
}

/// Of a place, along each axis; of one outside the grid, at its border.
SegmentCells::Numbers SegmentCells::cell(const Vec& place) const noexcept {
  const Along last{count_[0] - 1.0, count_[1] - 1.0, count_[2] - 1.0, 0};
  return std::bit_cast<Numbers>(whole(inverse_cell_ * along(place - corner_), last));
}

SegmentCells::Numbers SegmentCells::steps(const Vec& place) const noexcept {
  const Along a_metre{steps_[0], steps_[1], steps_[2], 0};
  return std::bit_cast<Numbers>(
      whole(a_metre * along(place - corner_), Along{} + most_steps) -
      int{std::numeric_limits<std::int16_t>::max()});
}

/// Of a segment, from one share of its edge to another.
SegmentCells::Part SegmentCells::part(In x, std::size_t segment, double from,
                                      double to) const noexcept {
  const Vec start = load3(&x[3 * segment]), edge = load3(&x[3 * segment + 3]) - start;
  const Whole one = std::bit_cast<Whole>(steps(start + from * edge)),
              other = std::bit_cast<Whole>(steps(start + to * edge));
  return std::bit_cast<Part>(bounds(one < other ? one : other, one < other ? other : one,
                                    static_cast<int>(segment)));
}

/// Counting sort. Ranges of cells are filled side by side, each from all parts, so that
/// parts of a cell keep their order, that of segments.
void SegmentCells::sort(In x, const Loop& loop) {
  const auto parts = static_cast<std::size_t>(part_.back());
  cell_of_.resize(parts);
  parts_.resize(parts + at_once);
  in_parts(points(), loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      each_part(i, x, [&](std::size_t p, const Vec& middle) {
        const Numbers at = cell(middle);
        cell_of_[p] = static_cast<int>(row(at[1], at[2])) + at[0];
      });
    }
  });

  const std::size_t all = row(0, count_[2]);
  start_.resize(all + 1);
  std::array<int, slabs + 1> begin{};
  const auto slab = [all](std::size_t i) { return static_cast<int>(i * all / slabs); };
  loop(slabs, [&](std::size_t i) {
    const int from = slab(i), to = slab(i + 1);
    std::fill(start_.begin() + from, start_.begin() + to, 0);
    int sum = 0;
    for (const int c : cell_of_) {
      if (c < from || c >= to) continue;
      ++start_[static_cast<std::size_t>(c)];
      ++sum;
    }
    begin[i + 1] = sum;
  });
  for (std::size_t i = 0; i < slabs; ++i) begin[i + 1] += begin[i];
  loop(slabs, [&](std::size_t i) {
    const int from = slab(i), to = slab(i + 1);
    // From the ends: every part takes the place before the last one, back to front.
    int end = begin[i];
    for (int c = from; c < to; ++c) {
      end += start_[static_cast<std::size_t>(c)];
      start_[static_cast<std::size_t>(c)] = end;
    }
    for (std::size_t segment = points(); segment-- > 0;) {
      for (int p = part_[segment + 1]; p-- > part_[segment];) {
        const int c = cell_of_[static_cast<std::size_t>(p)];
        if (c < from || c >= to) continue;
        const auto at = static_cast<std::size_t>(--start_[static_cast<std::size_t>(c)]);
        const double share = 1.0 / (part_[segment + 1] - part_[segment]);
        parts_[at] = part(x, segment, (p - part_[segment]) * share,
                          (p + 1 - part_[segment]) * share);
      }
    }
  });
  start_[all] = static_cast<int>(parts);
}

Box SegmentCells::extent() const {
  const Vec size{cell_ * count_[0], cell_ * count_[1], cell_ * count_[2]};
  return {corner_, corner_ + size};
}

void SegmentCells::reaching_into(const Box& box, std::vector<int>& found) const {
  const Vec &a = box.least, &b = box.most;
  // A part that reaches into it has its middle no farther from it than this.
  const double far = (1 + rounding) * 0.5 * longest_;
  const Vec beside{far, far, far};
  const Numbers first = cell(a - beside), last = cell(b + beside);
  // A part's least is compared with the box's most, its number with what none exceeds.
  constexpr int any = 0x7fff7fff;
  const Whole one =
      bounds(std::bit_cast<Whole>(steps(b)), std::bit_cast<Whole>(steps(a)), any);
  const auto limit =
      std::bit_cast<Shorts>(__builtin_shufflevector(one, one, 0, 1, 2, 3, 0, 1, 2, 3));
  std::size_t count = found.size();
  constexpr Longs numbers{0, 1, 2, 3};
  const auto look = [&](int begin, int end) {
    const std::size_t most_found =
        count + static_cast<std::size_t>(end - begin) + at_once;
    if (found.size() < most_found) found.resize(2 * most_found);
    for (int i = begin; i < end; i += at_once) {
      const Part* const four = &parts_[static_cast<std::size_t>(i)];
      // Without branches, which nobody could foresee.
      const Longs hit = within(four, limit) & (numbers < end - i);
      for (int k = 0; k < at_once; ++k) {
        found[count] = four[k].segment;
        count -= static_cast<std::size_t>(hit[k]);
      }
    }
  };
  // Of rows of cells, which lie far from each other, none is waited for.
  const auto each_row = [&](const auto& act) {
    for (int z = first[2]; z <= last[2]; ++z) {
      for (int y = first[1]; y <= last[1]; ++y) {
        act(&start_[row(y, z) + static_cast<std::size_t>(first[0])]);
      }
    }
  };
  const int wide = last[0] - first[0] + 1;
  each_row([](const int* start) { fetch(start, 1); });
  std::array<std::array<int, 2>, rows_at_once> rows;
  std::size_t waiting = 0;
  const auto look_at_all = [&] {
    for (std::size_t i = 0; i < waiting; ++i) look(rows[i][0], rows[i][1]);
    waiting = 0;
  };
  each_row([&](const int* start) {
    const int begin = start[0], end = start[wide];
    if (begin == end) return;
    fetch(&parts_[static_cast<std::size_t>(begin)],
          static_cast<std::size_t>(end - begin));
    rows[waiting++] = {begin, end};
    if (waiting == rows.size()) look_at_all();
  });
  look_at_all();
  found.resize(count);
}

void SegmentCells::near(const StraightPiece& axis, double radius, int but,
                        std::vector<int>& found) const {
  Box box{axis.start, axis.start};
  box.include(axis.at(1));
  box.grow(radius);
  found.clear();
  reaching_into(box, found);
  found.insert(found.end(), long_.begin(), long_.end());
  std::erase_if(found, [&](int segment) { return polyline(segment) == but; });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

std::size_t SegmentCells::bytes() const {
  const auto of = [](const auto& values) {
    return values.capacity() * sizeof(*values.data());
  };
  return of(polyline_) + of(first_) + of(part_) + of(cell_of_) + of(start_) + of(parts_) +
         of(long_);
}

}  // namespace tress::models
