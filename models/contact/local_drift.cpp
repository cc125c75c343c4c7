#include "models/contact/local_drift.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tress::models {
namespace {

constexpr std::size_t pieces = 4;            // of work
constexpr std::size_t cells_of_segment = 1;  // at most, with those where nothing is

}  // namespace

void LocalDrift::fill(const SegmentCells& segments, In x, double sight,
                      const Loop& loop) {
  const Box all = segments.extent();
  corner_ = all.least;
  const Vec width = all.most - all.least;
  const auto number = [&](double along) {
    return std::max(1.0, std::ceil(inverse_side_ * along));
  };
  const double limit = 1 + static_cast<double>(segments.points() * cells_of_segment);
  for (double side = sight;; side *= 1.1) {
    inverse_side_ = 1 / side;
    if (number(width.x) * number(width.y) * number(width.z) <= limit) break;
  }
  const double along[] = {width.x, width.y, width.z};
  for (int axis = 0; axis < 3; ++axis) {
    count_[axis] = static_cast<int>(number(along[axis]));
  }
  of_part_.resize(segments.parts());
  in_parts(segments.points(), loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      segments.each_part(i, x, [&](std::size_t part, const Vec& middle) {
        of_part_[part] = cells(Vec3<Pack>(middle))[0];
      });
    }
  });
  number_cells();
  in_parts(of_part_.size(), loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t part = from; part < to; ++part) {
      of_part_[part] = number_[static_cast<std::size_t>(of_part_[part])];
    }
  });
  parts_.assign(cell_.size(), 0);
  for (const int one : of_part_) ++parts_[static_cast<std::size_t>(one)];
}

/// Numbers the cells that contain parts, and their neighbours.
void LocalDrift::number_cells() {
  number_.assign(stride(3), 0);
  for (const int cell : of_part_) number_[static_cast<std::size_t>(cell)] = 1;
  // Bit `axis`: reached along the axes before.
  for (int axis = 0; axis < 3; ++axis) {
    const int before = 1 << axis, then = 2 << axis;
    for (std::size_t c = 0; c < number_.size(); ++c) {
      if ((number_[c] & before) == 0) continue;
      number_[c] |= then;
      each_beside(c, axis, [&](std::size_t beside) { number_[beside] |= then; });
    }
  }
  cell_.clear();
  for (std::size_t c = 0; c < number_.size(); ++c) {
    const bool counts = number_[c] != 0;
    number_[c] = counts ? static_cast<int>(cell_.size()) : -1;
    if (counts) cell_.push_back(static_cast<int>(c));
  }
}

std::size_t LocalDrift::stride(int axis) const {
  std::size_t all = 1;
  for (int k = 0; k < axis; ++k) all *= static_cast<std::size_t>(count_[k]);
  return all;
}

/// Calls use(cell) for those before and after one along an axis.
template <class Use>
void LocalDrift::each_beside(std::size_t cell, int axis, const Use& use) const {
  const std::size_t step = stride(axis), count = static_cast<std::size_t>(count_[axis]),
                    place = cell / step % count;
  if (place > 0) use(cell - step);
  if (place + 1 < count) use(cell + step);
}

void LocalDrift::move(const SegmentCells& segments, std::span<const Vec> by,
                      const Loop& loop) {
  const std::size_t cells = cell_.size(), points = segments.points();
  own_.resize(pieces * cells);
  loop(pieces, [&](std::size_t piece) {
    const std::span own = std::span(own_).subspan(piece * cells, cells);
    std::ranges::fill(own, Box::none());
    for (std::size_t i = points * piece / pieces; i < points * (piece + 1) / pieces;
         ++i) {
      const auto [from, to] = segments.parts_of(i);
      if (from == to || !is_finite(by[i]) || !is_finite(by[i + 1])) continue;
      const Vec along = 1 / static_cast<double>(to - from) * (by[i + 1] - by[i]);
      Vec start = by[i];
      for (std::size_t part = from; part < to; ++part) {
        const Vec end = by[i] + static_cast<double>(part + 1 - from) * along;
        Box& box = own[static_cast<std::size_t>(of_part_[part])];
        box.include(start);
        box.include(end);
        start = end;
      }
    }
  });
  near_.resize(cells);
  const auto each = [&](const auto& use) {
    in_parts(cells, loop, [&](std::size_t from, std::size_t to) {
      for (std::size_t c = from; c < to; ++c) use(c);
    });
  };
  // Extended along some axes, and before, where two of the pieces were.
  std::span some = std::span(own_).first(cells),
            before = std::span(own_).subspan(cells, cells);
  each([&](std::size_t c) {
    for (std::size_t piece = 1; piece < pieces; ++piece) {
      some[c].include(own_[piece * cells + c]);
    }
  });
  for (int axis = 0; axis < 3; ++axis) {
    std::swap(some, before);
    each([&](std::size_t c) {
      some[c] = before[c];
      each_beside(static_cast<std::size_t>(cell_[c]), axis, [&](std::size_t beside) {
        const int one = number_[beside];
        if (one >= 0) some[c].include(before[static_cast<std::size_t>(one)]);
      });
    });
  }
  each([&](std::size_t c) {
    const Box& box = some[c];
    near_[c] = box.empty() ? nothing
                           : Spread{0.5 * (box.least + box.most),
                                    0.5 * norm(box.most - box.least)};
  });
  double sum = 0, all = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    if (parts_[c] == 0 || near_[c].radius < 0) continue;
    sum += parts_[c] * near_[c].radius;
    all += parts_[c];
  }
  mean_ = all > 0 ? sum / all : 0;
}

std::size_t LocalDrift::bytes() const {
  const auto of = [](const auto& values) {
    return values.capacity() * sizeof(*values.data());
  };
  return of(number_) + of(cell_) + of(parts_) + of(own_) + of(near_) + of(of_part_);
}

}  // namespace tress::models
