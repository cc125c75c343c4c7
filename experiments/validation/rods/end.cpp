#include "experiments/validation/rods/end.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "math/quaternion.h"
#include "models/strand/geometry.h"

namespace tress::experiments::validation {
namespace {

using Eigen::Index;

Vec tip(MaterialPoints& points, double t, In q) {
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(t, q, x);
  return load3(&x[x.size() - 3]);
}

/// Axis times angle, below pi, of a rotation.
Vec rotation_vector(const Frame& frame) {
  const Quaternion q = nearer({1, {}}, quaternion_of(frame));
  const double s = std::sqrt(dot(q.v, q.v));
  return (s > 0 ? 2 * std::atan2(s, q.w) / s : 2) * q.v;
}

/// The last `rows` components of x.
Eigen::VectorXd last_of(const Vec& x, int rows) {
  const double components[3] = {x.x, x.y, x.z};
  Eigen::VectorXd last(rows);
  for (int k = 0; k < rows; ++k) last[k] = components[3 - rows + k];
  return last;
}

}  // namespace

int End::section_rows() const {
  return section == Section::free ? 0 : section == Section::tangent ? 2 : 3;
}

EndConditions::EndConditions(System& system, const End& end)
    : system_(system),
      points_(*system.material_points()),
      end_(end),
      places_(static_cast<int>(end.along.size())),
      sections_(end.section_rows()),
      q_typ_(static_cast<std::size_t>(system.layout().coordinates)) {
  std::vector<double> v_typ(q_typ_.size()), q = q_typ_, v = q_typ_;
  system_.scale(q_typ_, v_typ);
  system_.initial_state(q, v);
  if (sections_ > 0 && !points_.end_frame(0, q)) {
    throw std::runtime_error("the model has no frame at its end");
  }
}

Eigen::VectorXd EndConditions::section(double t, In q) {
  const auto axes = points_.end_frame(t, q).value();
  const Frame now = load9(axes.data()) * helix_turn(end_.rest, -1), &held = end_.frame;
  const Vec turned =
      rotation_vector({held.back(now.e0), held.back(now.e1), held.back(now.e2)});
  return last_of(turned + end_.rest, sections_);
}

Eigen::VectorXd EndConditions::value(double t, In q) {
  Eigen::VectorXd c(rows());
  const Vec away = tip(points_, t, q) - end_.place;
  for (int i = 0; i < places_; ++i) {
    c[i] = dot(end_.along[static_cast<std::size_t>(i)], away);
  }
  if (sections_ > 0) c.tail(sections_) = section(t, q);
  return c;
}

Eigen::MatrixXd EndConditions::gradient(double t, In q) {
  const auto n = static_cast<Index>(q.size());
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(n, rows());
  std::vector<double> v(q.size()), u(3 * static_cast<std::size_t>(points_.count()));
  for (Index j = 0; j < n && places_ > 0; ++j) {
    const auto at = static_cast<std::size_t>(j);
    v[at] = 1;
    points_.velocities(t, q, v, u);
    v[at] = 0;
    const Vec moved = load3(&u[u.size() - 3]);
    for (int i = 0; i < places_; ++i) {
      g(j, i) = dot(end_.along[static_cast<std::size_t>(i)], moved);
    }
  }
  if (sections_ > 0) g.rightCols(sections_) = section_gradient(t, q);
  return g;
}

Eigen::MatrixXd EndConditions::section_gradient(double t, In q) {
  const auto n = static_cast<Index>(q.size());
  Eigen::MatrixXd g(n, sections_);
  std::vector<double> moved(q.begin(), q.end());
  constexpr double step = 1e-3;  // error step^4 and eps/step: 1e-12
  for (Index j = 0; j < n; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const double e = step * q_typ_[at];
    const auto shifted = [&](double by) {
      moved[at] = q[at] + by * e;
      return section(t, moved);
    };
    g.row(j) = ((8 * (shifted(1) - shifted(-1)) - (shifted(2) - shifted(-2))) / (12 * e))
                   .transpose();
    moved[at] = q[at];
  }
  return g;
}

std::vector<std::size_t> EndConditions::turning(double t, In q) {
  const Eigen::VectorXd here = section(t, q);
  std::vector<double> moved(q.begin(), q.end());
  std::vector<std::size_t> all;
  constexpr double far = 0.1;  // of the typical size: no rotation vanishes by accident
  for (std::size_t j = 0; j < q.size(); ++j) {
    moved[j] = q[j] + far * q_typ_[j];
    if (section(t, moved) != here) all.push_back(j);
    moved[j] = q[j];
  }
  return all;
}

Eigen::MatrixXd EndConditions::curvature(double t, In q, const Eigen::VectorXd& moment) {
  const auto n = static_cast<Index>(q.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  if (sections_ == 0) return all;
  std::vector<double> moved(q.begin(), q.end());
  // A step that rotates the end by this: error step^2 and eps/step^2, 1e-7.
  constexpr double step = 3e-4;
  const Eigen::MatrixXd slope = section_gradient(t, q);
  std::vector<double> steps(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    constexpr double little = 1e-3;  // such an unknown rotates it to second order only
    const double turn = slope.row(static_cast<Index>(i)).norm();
    steps[i] = step / (turn * q_typ_[i] > little ? turn : 1 / q_typ_[i]);
  }
  const std::vector<std::size_t> active = turning(t, q);
  const auto turned = [&](double by, std::size_t i, std::size_t j) {
    moved[i] += by * steps[i];
    if (j != i) moved[j] += by * steps[j];
    const double w = moment.dot(section(t, moved));
    moved[i] = q[i];
    moved[j] = q[j];
    return w;
  };
  // Central second difference in one unknown: f'' steps^2.
  const double here = moment.dot(section(t, q));
  std::vector<double> alone;
  alone.reserve(active.size());
  for (const std::size_t i : active) {
    alone.push_back(turned(1, i, i) + turned(-1, i, i) - 2 * here);
  }
  for (std::size_t k = 0; k < active.size(); ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      const std::size_t i = active[k], j = active[l];
      const double mixed = turned(1, i, j) + turned(-1, i, j) - 2 * here;
      const double second =
          (k == l ? alone[k] : (mixed - alone[k] - alone[l]) / 2) / (steps[i] * steps[j]);
      all(static_cast<Index>(i), static_cast<Index>(j)) = second;
      all(static_cast<Index>(j), static_cast<Index>(i)) = second;
    }
  }
  return all;
}

Eigen::VectorXd EndConditions::compliance() const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(rows());
  all.tail(sections_) = last_of(end_.compliance, sections_);
  return all;
}

}  // namespace tress::experiments::validation
