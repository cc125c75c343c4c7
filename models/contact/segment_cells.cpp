#include "models/contact/segment_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace tress::models {
namespace {

// Longest part over segments of usual length; parts of the longest one that is cut.
constexpr double part_over_usual = 1.1, longest_parts = 64;
// Cells over the reach: smaller ones fit closer but are more runs of numbers.
constexpr double cell_over_reach = 1;
constexpr double cells_over_parts = 2;  // at most
// Shares of points below and above which the grid may end, and points that tell.
constexpr double outside = 0.05;
constexpr std::size_t sampled = 4096;
constexpr std::size_t slabs = 8;  // ranges of cells, each a piece of work
constexpr std::size_t width = 8;  // parts that a search tests together
// Of floats that stand for places, over their size: more than 2^-24 of two of them.
constexpr double float_error = 1e-6;

using Floats __attribute__((vector_size(width * sizeof(float)))) = float;
using Ints __attribute__((vector_size(width * sizeof(int)))) = int;
Floats load(const float* p) {
  Floats x;
  std::memcpy(&x, p, sizeof x);
  return x;
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
  longest_ = std::max(reach, part_over_usual * quantile(lengths, 1 - outside));
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
  }
}

/// Those of places from `from` to `to` along an axis; NaN is at its beginning.
SegmentCells::Range SegmentCells::cells(int axis, double from, double to) const noexcept {
  const double corner = axis == 0 ? corner_.x : axis == 1 ? corner_.y : corner_.z;
  const double end = count_[axis] - 1;
  const auto index = [&](double place) {
    const double at = inverse_cell_ * (place - corner);
    return static_cast<int>(at > 0 ? at < end ? at : end : 0);
  };
  return {index(from), index(to)};
}

/// Counting sort. Ranges of cells are filled side by side, each from all parts, so that
/// parts of a cell keep their order, that of segments.
void SegmentCells::sort(In x, const Loop& loop) {
  const auto parts = static_cast<std::size_t>(part_.back());
  cell_of_.resize(parts);
  segment_.resize(parts + width);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    least_[axis].resize(parts + width);
    most_[axis].resize(parts + width);
  }
  in_parts(points(), loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      each_part(i, x, [&](std::size_t p, const Vec& middle) {
        cell_of_[p] = static_cast<int>(
                          row(cells(1, middle.y, 0).from, cells(2, middle.z, 0).from)) +
                      cells(0, middle.x, 0).from;
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
        const StraightPiece whole = piece_at(x, static_cast<int>(segment));
        const double share = 1.0 / (part_[segment + 1] - part_[segment]);
        const Vec a = whole.at((p - part_[segment]) * share),
                  b = whole.at((p + 1 - part_[segment]) * share);
        segment_[at] = static_cast<int>(segment);
        const auto box = [&](std::size_t axis, double one, double other) {
          least_[axis][at] = static_cast<float>(std::min(one, other));
          most_[axis][at] = static_cast<float>(std::max(one, other));
        };
        box(0, a.x, b.x);
        box(1, a.y, b.y);
        box(2, a.z, b.z);
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
  const double size = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z),
                                std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  const double wide = float_error * (size + longest_);
  // A part that reaches into it has its middle no farther from it than this.
  const double far = wide + 0.5 * longest_;
  const Range xs = cells(0, a.x - far, b.x + far), ys = cells(1, a.y - far, b.y + far),
              zs = cells(2, a.z - far, b.z + far);
  const auto least = [wide](double at) { return Floats{} + float(at - wide); };
  const auto most = [wide](double at) { return Floats{} + float(at + wide); };
  const Floats x0 = least(a.x), x1 = most(b.x), y0 = least(a.y), y1 = most(b.y),
               z0 = least(a.z), z1 = most(b.z);
  constexpr Ints numbers{0, 1, 2, 3, 4, 5, 6, 7};
  std::size_t count = 0;
  for (int z = zs.from; z <= zs.to; ++z) {
    for (int y = ys.from; y <= ys.to; ++y) {
      const std::size_t cells_of = row(y, z);
      const auto begin = static_cast<std::size_t>(
                     start_[cells_of + static_cast<std::size_t>(xs.from)]),
                 end = static_cast<std::size_t>(
                     start_[cells_of + static_cast<std::size_t>(xs.to) + 1]);
      for (std::size_t i = begin; i < end; i += width) {
        if (found.size() < count + width) found.resize(2 * found.size() + width);
        const auto close = (load(&least_[0][i]) <= x1) & (load(&most_[0][i]) >= x0) &
                           (load(&least_[1][i]) <= y1) & (load(&most_[1][i]) >= y0) &
                           (load(&least_[2][i]) <= z1) & (load(&most_[2][i]) >= z0);
        // Without branches, which nobody could foresee.
        const Ints of_row = close & (numbers < static_cast<int>(end - i));
        for (std::size_t k = 0; k < width; ++k) {
          found[count] = segment_[i + k];
          count -= static_cast<std::size_t>(of_row[k] >> 31);
        }
      }
    }
  }
  found.resize(count);
}

void SegmentCells::near(const StraightPiece& axis, double radius, int but,
                        std::vector<int>& found) const {
  Box box{axis.start, axis.start};
  box.include(axis.at(1));
  box.grow(radius);
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
  return of(polyline_) + of(first_) + of(part_) + of(cell_of_) + of(start_) +
         of(segment_) + 3 * (of(least_[0]) + of(most_[0])) + of(long_);
}

}  // namespace tress::models
