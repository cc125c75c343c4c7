// The matrix of a rod in rotation vectors.
#include <algorithm>

#include "linear/finite.h"
#include "linear/sparse_pattern.h"
#include "linear/vector_ops.h"
#include "models/quaternion_rods/rotation_vectors.h"

namespace tress::models {
namespace {

constexpr Vec unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

}  // namespace

/// The pattern, and what never changes of the matrices: inertia, and which are friction.
void RotationVectors::couple(const Pattern& of_rod) {
  const std::size_t nodes = first_ / 3, groups = nodes + edges();
  const auto group = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return k < first_ ? std::pair{k / 3, k % 3}
                      : std::pair{nodes + (k - first_) / 4, (k - first_) % 4};
  };
  std::vector<std::vector<int>> columns(3 * groups);
  std::vector<int> known(groups, -1);  // place in coupled_ of a row in this column
  for (std::size_t c = 0; c < groups; ++c) {
    const auto begin = static_cast<std::ptrdiff_t>(coupled_.size());
    const std::size_t size = c < nodes ? 3 : 4;
    const std::size_t first = c < nodes ? 3 * c : in_rod(c - nodes);
    for (std::size_t k = 0; k < size; ++k) {
      for (int i = of_rod.start[first + k]; i < of_rod.start[first + k + 1]; ++i) {
        const auto [row, entry] = group(of_rod.row[static_cast<std::size_t>(i)]);
        if (known[row] < begin) {
          known[row] = static_cast<int>(coupled_.size());
          coupled_.push_back({row, c, {}, {}});
          for (auto& line : coupled_.back().from) {
            line.fill(static_cast<std::size_t>(of_rod.nonzeros()));
          }
          for (std::size_t l = 0; l < 9; ++l) {
            columns[3 * c + l / 3].push_back(static_cast<int>(3 * row + l % 3));
          }
        }
        coupled_[static_cast<std::size_t>(known[row])].from[entry][k] =
            static_cast<std::size_t>(i);
      }
    }
  }
  const auto rows = static_cast<int>(columns.size());
  pattern_ = pattern_of(rows, std::move(columns));
  for (Coupled& pair : coupled_) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        pair.to[i][j] = static_cast<std::size_t>(
            place_of(pattern_, static_cast<int>(3 * pair.row + i),
                     static_cast<int>(3 * pair.column + j)));
      }
    }
  }
  slopes_.resize(edges());
  values_.resize(static_cast<std::size_t>(pattern_.nonzeros()));
  of_rod_.resize(static_cast<std::size_t>(of_rod.nonzeros()) + 1);
  friction_ = of_rod_;
  static_cast<void>(rod_values(0, {0, 1, 0}, friction_));
  static_cast<void>(rod_values(0, {1, 0, 0}, of_rod_));
  inertia_.resize(edges());
  for (const Coupled& pair : coupled_) {
    if (pair.column < nodes || pair.row != pair.column) continue;
    inertia_[pair.column - nodes] = of_rod_[pair.from[0][0]];
    for (const auto& line : pair.from) {
      for (const std::size_t i : line) damped_ = damped_ || friction_[i] != 0;
    }
  }
}

/// S of the rod at the coordinates of place().
Status RotationVectors::rod_values(double t, Weights w, Out s) noexcept {
  return rod_->sparse_form()->values(t, q_, v_, a_, w, s.first(s.size() - 1));
}

/// force_ = r with the stresses of the next matrix. With the change d since the origin,
/// the part linear in d is r(origin) + (r(origin + d) - r(origin - d))/2 up to d^3.
/// Stretch of edges that d has turned is even in d and drops out.
Status RotationVectors::find_force(double t) noexcept {
  if (!stresses_) return rod_->residual(t, q_, v_, a_, force_);
  const Stresses stresses = *stresses_;
  stresses_.reset();
  Status s = rod_->residual(t, origin_, v_, a_, force_);
  if (s != Status::ok || stresses == Stresses::held) return s;
  for (std::size_t i = 0; i < q_.size(); ++i) origin_[i] = 2 * origin_[i] - q_[i];
  for (const auto& [q, part] : {std::pair{&q_, 0.5}, {&origin_, -0.5}}) {
    if (s == Status::ok) s = rod_->residual(t, *q, v_, a_, free_);
    add(force_, part, free_);
  }
  return s;
}

void RotationVectors::find_slopes(In v, bool rates) noexcept {
  for (std::size_t e = 0; e < edges(); ++e) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto set = [&](const Quaternion& x, double(&to)[4][3]) {
        double entries[4];
        store_quaternion(reference_[e] * x, entries);
        for (std::size_t i = 0; i < 4; ++i) to[i][k] = entries[i];
      };
      set(rotations_[e].slope(unit[k]), slopes_[e].position);
      if (rates) set(rotations_[e].second(load3(&v[at(e)]), unit[k]), slopes_[e].rate);
    }
  }
}

template <std::size_t rows, std::size_t columns>
void RotationVectors::add_product(const Coupled& pair, bool rates,
                                  double (&h)[3][3]) const noexcept {
  const std::size_t nodes = first_ / 3;
  double product[rows][3] = {};
  for (std::size_t i = 0; i < rows; ++i) {
    if constexpr (columns == 3) {
      for (std::size_t j = 0; j < 3; ++j) product[i][j] = of_rod_[pair.from[i][j]];
    } else {
      const Slopes& slopes = slopes_[pair.column - nodes];
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t entry = pair.from[i][k];
        for (std::size_t j = 0; j < 3; ++j) {
          product[i][j] += of_rod_[entry] * slopes.position[k][j];
          if (rates) product[i][j] += friction_[entry] * slopes.rate[k][j];
        }
      }
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if constexpr (rows == 3) {
        h[i][j] += product[i][j];
      } else {
        const Slopes& slopes = slopes_[pair.row - nodes];
        for (std::size_t k = 0; k < 4; ++k) {
          h[i][j] += slopes.position[k][i] * product[k][j];
        }
      }
    }
  }
}

/// h += J^T M dq''/d(c', c) + pos d(J^T)/dc r of an edge, r in force_.
void RotationVectors::add_curvature(std::size_t edge, In v, In a, Weights w,
                                    double (&h)[3][3]) noexcept {
  const ConformalRotation& c = rotations_[edge];
  const Vec rate = load3(&v[at(edge)]), second = load3(&a[at(edge)]);
  for (std::size_t k = 0; k < 3; ++k) {
    Vec change = (2 * w.vel) * c.pull_back(c.second(rate, unit[k]));
    if (w.pos != 0) {
      change = change + w.pos * (c.pull_back(c.second(second, unit[k])) +
                                 c.pull_back(c.third(rate, unit[k])));
    }
    double inertial[3];
    store3(inertia_[edge] * change, inertial);
    for (std::size_t i = 0; i < 3; ++i) h[i][k] += inertial[i];
  }
  if (w.pos != 0) c.add_second(relative(force_, edge), w.pos, h);
}

Status RotationVectors::values(double t, In q, In v, In a, Weights w, Out s) noexcept {
  place(q, v, a);
  const bool rates = damped_ && w.pos != 0;
  Status status = rod_values(t, w, of_rod_);
  if (status == Status::ok && rates) status = rod_values(t, {0, w.pos, 0}, friction_);
  if (status == Status::ok && w.pos != 0) status = find_force(t);
  if (status != Status::ok) return status;
  find_slopes(v, rates);
  const std::size_t nodes = first_ / 3;
  for (const Coupled& pair : coupled_) {
    const bool turned_row = pair.row >= nodes, turned_column = pair.column >= nodes;
    double h[3][3] = {};
    if (turned_row && turned_column) {
      add_product<4, 4>(pair, rates, h);
    } else if (turned_row) {
      add_product<4, 3>(pair, rates, h);
    } else if (turned_column) {
      add_product<3, 4>(pair, rates, h);
    } else {
      add_product<3, 3>(pair, rates, h);
    }
    if (turned_row && pair.row == pair.column) {
      add_curvature(pair.row - nodes, v, a, w, h);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) s[pair.to[i][j]] = h[i][j];
    }
  }
  return all_finite(s) ? Status::ok : Status::retry;
}

}  // namespace tress::models
