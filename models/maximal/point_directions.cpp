#include "models/maximal/point_directions.h"

#include <numeric>

#include "math/mat3.h"

namespace tress::models {

PointDirections::PointDirections(std::vector<NodeMean> points, int held)
    : points_(std::move(points)), groups_(groups(), held) {}

std::vector<std::vector<int>> PointDirections::groups() const {
  std::vector<std::vector<int>> all;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const NodeMean& last = points_[behind(i)];
    const int first = points_[before(i)].first, end = last.first + last.nodes;
    std::vector<int>& group = all.emplace_back(3 * static_cast<std::size_t>(end - first));
    std::iota(group.begin(), group.end(), 3 * first);
  }
  return all;
}

void PointDirections::tangents(In x, Out t) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec d = load3(&x[3 * behind(i)]) - load3(&x[3 * before(i)]);
    store3((1 / norm(d)) * d, &t[3 * i]);
  }
}

void PointDirections::add_tangent(In x, In t, In blocks, Out s) const {
  // Neighbouring points of a cubic lie in neighbouring spans at most.
  constexpr std::size_t most = 3 * 6;
  std::array<double, most * most> matrix;
  GroupSum sum(groups_, s);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec tangent = load3(&t[3 * i]);
    const Vec d = load3(&x[3 * behind(i)]) - load3(&x[3 * before(i)]);
    const double* block = &blocks[9 * i];
    const Mat3 load{load3(block), load3(block + 3), load3(block + 6)};
    double by_d[9] = {};
    add9((1 / norm(d)) * (load - outer(load * tangent, tangent)), by_d);

    const std::size_t size = groups_.size(i);
    std::fill_n(matrix.begin(), size * size, 0.0);
    const int first = points_[before(i)].first;
    const auto add = [&](std::size_t of_d, double sign) {
      const NodeMean &row = points_[i], &column = points_[of_d];
      for (std::size_t r = 0; r < 3 * static_cast<std::size_t>(row.nodes); ++r) {
        for (std::size_t c = 0; c < 3 * static_cast<std::size_t>(column.nodes); ++c) {
          const auto at_row = 3 * static_cast<std::size_t>(row.first - first) + r;
          const auto at_column = 3 * static_cast<std::size_t>(column.first - first) + c;
          matrix[size * at_row + at_column] +=
              sign * row.weight[r / 3] * column.weight[c / 3] * by_d[3 * (r % 3) + c % 3];
        }
      }
    };
    add(behind(i), 1);
    add(before(i), -1);
    sum.add(i, matrix.data());
  }
}

}  // namespace tress::models
