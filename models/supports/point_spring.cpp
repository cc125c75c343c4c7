#include "models/supports/point_spring.h"

#include <algorithm>
#include <array>

#include "contract/input_error.h"
#include "models/supports/held_section.h"

namespace tress::models {
namespace {

double entry(const Matrix3<double>& m, int row, int column) {
  const Vec c = m.column(column);
  return row == 0 ? c.x : row == 1 ? c.y : c.z;
}

}  // namespace

PointSpring::PointSpring(System& strand, const Support& support, SparseForm* matrix,
                         const std::string& where)
    : points_(strand.material_points()),
      point_(support.point),
      path_(support.path),
      axes_(support.axes),
      stiffness_(support.compliance.stiffness),
      damping_(support.compliance.damping),
      x_(3 * static_cast<std::size_t>(points_->count())) {
  for (const Vec& axis : axes_) along_ = along_ + dyad(axis, axis);
  const auto n = static_cast<std::size_t>(strand.layout().coordinates);
  for (auto* x : {&q_typ_, &change_}) x->assign(n, 0.0);
  strand.scale(q_typ_, change_);
  const auto mean = points_->mean(point_);
  if (mean && matrix != nullptr) find_entries(*mean, matrix->pattern(), where);
}

void PointSpring::find_entries(const MaterialPoints::Mean& mean, const Pattern& matrix,
                               const std::string& where) {
  const auto count = static_cast<std::size_t>(mean.count);
  for (std::size_t k = 0; k < 3 * count; ++k) {
    const auto column = static_cast<std::size_t>(mean.coordinate[k / 3]) + k % 3;
    const auto from = matrix.row.begin() + matrix.start[column],
               to = matrix.row.begin() + matrix.start[column + 1];
    for (std::size_t i = 0; i < 3 * count; ++i) {
      const int row = mean.coordinate[i / 3] + static_cast<int>(i % 3);
      const auto found = std::find(from, to, row);
      const bool needed =
          entry(along_, static_cast<int>(i % 3), static_cast<int>(k % 3)) != 0;
      refuse_if(needed && found == to,
                "the model's matrix does not couple the coordinates of this point", where,
                "leave out stiffness_n_per_m, or use another model");
      entries_.push_back(static_cast<std::size_t>(needed ? found - matrix.row.begin()
                                                         : matrix.nonzeros()));
    }
  }
}

Vec PointSpring::held(const Vec& d) const { return along_ * d; }

Vec PointSpring::gap(double t, In q) {
  points_->positions(t, q, x_);
  return held(load3(&x_[3 * static_cast<std::size_t>(point_)]) - path_.at(t).x);
}

Vec PointSpring::gap_rate(double t, In q, In v) {
  points_->velocities(t, q, v, x_);
  return held(load3(&x_[3 * static_cast<std::size_t>(point_)]) - path_.at(t).v);
}

/// b += J^T force.
void PointSpring::pull(double t, In q, const Vec& force, InOut b) {
  const std::array<double, 3> f{force.x, force.y, force.z};
  if (const auto mean = points_->mean(point_)) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(mean->count); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        b[static_cast<std::size_t>(mean->coordinate[k]) + c] += mean->weight[k] * f[c];
      }
    }
    return;
  }
  static_cast<void>(points_->pull_back(t, q, {&point_, 1}, f, b));
}

void PointSpring::add_force(double t, In q, In v, InOut r) {
  const Vec stretch = gap(t, q);
  pull(t, q, stiffness_ * stretch + damping_ * gap_rate(t, q, v), r);
}

void PointSpring::add_tangent(double t, In q, In v, Weights w, InOut s) {
  if (!entries_.empty()) {
    const auto mean = points_->mean(point_);
    const double factor = w.pos * stiffness_ + w.vel * damping_;
    const std::size_t count = 3 * static_cast<std::size_t>(mean->count);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < count; ++i) {
        const double value =
            entry(along_, static_cast<int>(i % 3), static_cast<int>(k % 3));
        if (value == 0) continue;
        s[entries_[k * count + i]] +=
            factor * mean->weight[i / 3] * mean->weight[k / 3] * value;
      }
    }
    return;
  }
  const std::size_t n = q.size();
  const auto add_column = [&](std::size_t k, double factor, const auto& force) {
    std::ranges::fill(change_, 0.0);
    force(-1.0);
    for (double& c : change_) c = -c;
    force(1.0);
    for (std::size_t i = 0; i < n; ++i) s[n * k + i] += factor * change_[i];
  };
  for (std::size_t k = 0; k < n; ++k) {
    const double step = difference_step * q_typ_[k];
    shifted_.assign(q.begin(), q.end());
    if (w.pos != 0) {
      add_column(k, w.pos / (2 * step), [&](double side) {
        shifted_[k] = q[k] + side * step;
        add_force(t, shifted_, v, change_);
      });
    }
    if (w.vel == 0 || damping_ == 0) continue;
    shifted_.assign(v.begin(), v.end());
    // Linear in v.
    add_column(k, w.vel / 2, [&](double side) {
      shifted_[k] = v[k] + side;
      pull(t, q, damping_ * gap_rate(t, q, shifted_), change_);
    });
  }
}

SectionLoad PointSpring::load(double t, In q, In v) {
  const Vec stretch = gap(t, q);
  SectionLoad made;
  made.point = point_;
  made.force = -1.0 * (stiffness_ * stretch + damping_ * gap_rate(t, q, v));
  made.by_place = -stiffness_ * along_;
  made.by_velocity = -damping_ * along_;
  return made;
}

double PointSpring::energy(double t, In q) {
  const Vec stretch = gap(t, q);
  return stiffness_ / 2 * dot(stretch, stretch);
}

double PointSpring::energy_rate(double t, In q, In v) {
  const Vec stretch = gap(t, q);
  return stiffness_ * dot(stretch, gap_rate(t, q, v));
}

}  // namespace tress::models
