#include "models/contact/local_drift.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

constexpr std::size_t pieces = 8;            // of work
constexpr std::size_t segments_of_cell = 2;  // at least, on average

}  // namespace

void LocalDrift::fill(const SegmentCells& segments, In x, double sight,
                      const Loop& loop) {
  const Box all = segments.extent();
  corner_ = all.least;
  const Vec width = all.most - all.least;
  const std::size_t fewest = segments.points() / segments_of_cell;
  const double limit = 1 + static_cast<double>(fewest);
  const auto number = [&](double along) {
    return std::max(1.0, std::ceil(inverse_side_ * along));
  };
  for (double side = sight;; side *= 1.1) {
    inverse_side_ = 1 / side;
    if (number(width.x) * number(width.y) * number(width.z) <= limit) break;
  }
  const double along[] = {width.x, width.y, width.z};
  for (int axis = 0; axis < 3; ++axis) {
    count_[axis] = static_cast<int>(number(along[axis]));
  }
  const auto cells = static_cast<std::size_t>(count_[0]) *
                     static_cast<std::size_t>(count_[1]) *
                     static_cast<std::size_t>(count_[2]);
  cell_of_.resize(segments.parts());
  in_parts(segments.points(), loop, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      segments.each_part(i, x, [&](std::size_t part, const Vec& middle) {
        cell_of_[part] = this->cells(Vec3<Pack>(middle))[0];
      });
    }
  });
  parts_.assign(cells, 0);
  for (const int c : cell_of_) ++parts_[static_cast<std::size_t>(c)];
  near_.resize(cells);
  at_.resize(cells);
}

void LocalDrift::move(const SegmentCells& segments, std::span<const Vec> by,
                      const Loop& loop) {
  const std::size_t cells = near_.size(), points = segments.points();
  own_.assign(pieces * cells, Box::none());
  loop(pieces, [&](std::size_t piece) {
    Box* const own = &own_[piece * cells];
    for (std::size_t i = points * piece / pieces; i < points * (piece + 1) / pieces;
         ++i) {
      const auto [from, to] = segments.parts_of(i);
      if (from == to || !is_finite(by[i]) || !is_finite(by[i + 1])) continue;
      for (std::size_t part = from; part < to; ++part) {
        Box& box = own[cell_of_[part]];
        box.include(by[i]);
        box.include(by[i + 1]);
      }
    }
  });
  near_.assign(cells, Box::none());
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    for (std::size_t c = 0; c < cells; ++c) near_[c].include(own_[piece * cells + c]);
  }
  // With those beside it along one axis after the other.
  std::size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<std::size_t>(count_[axis]);
    at_ = near_;
    for (std::size_t c = 0; c < cells; ++c) {
      const std::size_t place = c / stride % count;
      if (place > 0) near_[c].include(at_[c - stride]);
      if (place + 1 < count) near_[c].include(at_[c + stride]);
    }
    stride *= count;
  }
  double sum = 0, all = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    if (parts_[c] == 0 || near_[c].empty()) continue;
    const double half = 0.5 * norm(near_[c].most - near_[c].least);
    sum += parts_[c] * half;
    all += parts_[c];
  }
  mean_ = all > 0 ? sum / all : 0;
}

}  // namespace tress::models
