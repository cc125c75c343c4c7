#include "models/maximal/corde_elasticity.h"

#include <cmath>

namespace tress {
namespace {

/// d turn_between/d(p, q); of rates: the derivative of its rate.
void turn_gradient(const Quaternion& p, const Quaternion& q, double (&g)[3][8]) {
  const auto fill = [&g](int first, double factor, const Quaternion& a) {
    const auto& [w, v] = a;
    const double rows[3][4] = {
        {-v.x, w, v.z, -v.y}, {-v.y, -v.z, w, v.x}, {-v.z, v.y, -v.x, w}};
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 4; ++l) g[k][first + l] = factor * rows[k][l];
    }
  };
  fill(0, -2, q);
  fill(4, 2, p);
}

/// d first_axis/dq.
void axis_gradient(const Quaternion& q, double (&g)[3][4]) {
  const auto& [w, v] = q;
  const double rows[3][4] = {
      {w, v.x, -v.y, -v.z}, {v.z, v.y, v.x, w}, {-v.y, v.z, -w, v.x}};
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 4; ++l) g[k][l] = 2 * rows[k][l];
  }
}

}  // namespace

struct CordeElasticity::Edge {
  const CordeEdge& data;
  Quaternion q;
  double length;
  Vec t;       // e/|e|
  Vec axis;    // of the quaternion
  Vec across;  // rate of t times the length
  double lengthening;
};

struct CordeElasticity::Joint {
  const RodJoint& data;
  Quaternion before, behind, rate_before, rate_behind;
  double gradient[3][8];  // of the strains
  double rate[3];         // of the strains
  double stress[3];       // elastic and friction
};

CordeElasticity::CordeElasticity(std::vector<CordeEdge> edges,
                                 std::vector<RodJoint> joints, bool walled)
    : edge_data_(std::move(edges)),
      joint_data_(std::move(joints)),
      walled_(walled),
      quaternions_(3 * (edge_data_.size() + 1)) {}

std::vector<std::vector<int>> CordeElasticity::groups() const {
  std::vector<std::vector<int>> all;
  const auto append = [&all](std::size_t first, int count) {
    for (int k = 0; k < count; ++k) all.back().push_back(static_cast<int>(first) + k);
  };
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    all.emplace_back();
    append(3 * i, 6);
    append(at(i), 4);
  }
  for (std::size_t i = 0; i + 1 < edge_data_.size(); ++i) {
    all.emplace_back();
    append(at(i), 8);
  }
  return all;
}

CordeElasticity::Edge CordeElasticity::edge(const Placement& p,
                                            std::size_t i) const noexcept {
  const Vec e = load3(&p.z[3 * i + 3]) - load3(&p.z[3 * i]);
  const Vec rate = load3(&p.rate[3 * i + 3]) - load3(&p.rate[3 * i]);
  const double length = std::sqrt(dot(e, e));
  const Vec t = (1 / length) * e;
  const Quaternion q = load_quaternion(&p.z[at(i)]);
  return {edge_data_[i],           q,           length, t, first_axis(q),
          rate - dot(t, rate) * t, dot(t, rate)};
}

CordeElasticity::Joint CordeElasticity::joint(const Placement& p,
                                              std::size_t j) const noexcept {
  const std::size_t after = at(behind(j));
  Joint joint{joint_data_[j], {}, load_quaternion(&p.z[after]), {}, {}, {}, {}, {}};
  joint.rate_behind = load_quaternion(&p.rate[after]);
  if (clamp(j)) {
    joint.before = nearer(joint.behind, quaternion_of(p.root.frame));
    joint.rate_before = rate_of(joint.before, p.root.omega);
  } else {
    joint.before = load_quaternion(&p.z[after - 4]);
    joint.rate_before = load_quaternion(&p.rate[after - 4]);
  }
  turn_gradient(joint.before, joint.behind, joint.gradient);
  const RodJoint& data = joint.data;
  const Vec rate = turn_between(joint.rate_before, joint.behind) +
                   turn_between(joint.before, joint.rate_behind);
  const Vec bent = turn_between(joint.before, joint.behind) - data.rest;
  store3(rate, joint.rate);
  store3({data.stiffness.x * bent.x + data.friction.x * rate.x,
          data.stiffness.y * bent.y + data.friction.y * rate.y,
          data.stiffness.z * bent.z + data.friction.z * rate.z},
         joint.stress);
  return joint;
}

void CordeElasticity::add_force(const Placement& p, InOut f) noexcept {
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    const Edge now = edge(p, i);
    const CordeEdge& data = now.data;
    const double tension = data.stretch * (now.length - data.length) +
                           data.stretch_friction * now.lengthening;
    const Vec off = now.axis - dot(now.axis, now.t) * now.t;
    const Vec force = tension * now.t - (data.coupling / now.length) * off;
    store3(load3(&f[3 * i]) - force, &f[3 * i]);
    store3(load3(&f[3 * i + 3]) + force, &f[3 * i + 3]);
    double slope[3][4];
    axis_gradient(now.q, slope);
    const double square = dot(now.q, now.q);
    const double swell = 2 * (data.coupling * square + data.norm * (square - 1));
    double q[4];
    store_quaternion(now.q, q);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec column{slope[0][k], slope[1][k], slope[2][k]};
      f[at(i) + k] += swell * q[k] - data.coupling * dot(column, now.t);
    }
  }
  for (std::size_t j = 0; j < joint_data_.size(); ++j) {
    const Joint now = joint(p, j);
    const std::size_t first = at(behind(j)) - 4;
    for (std::size_t k = clamp(j) ? 4 : 0; k < 8; ++k) {
      for (int m = 0; m < 3; ++m) f[first + k] += now.stress[m] * now.gradient[m][k];
    }
  }
}

/// Over (e, q). With P = 1 - t t^T and a the axis, a . t has the derivatives P a/L and
/// -(a t^T + t a^T + (a . t)(1 - 3 t t^T))/L^2 by e.
void CordeElasticity::edge_tangent(const Edge& now, double pos, double vel,
                                   double (&h)[7][7]) const noexcept {
  const CordeEdge& data = now.data;
  const double length = now.length, along = dot(now.axis, now.t);
  const double across =
      pos *
      (data.stretch * (length - data.length) + data.stretch_friction * now.lengthening) /
      length;
  const double coupling = pos * data.coupling;
  const double bend = coupling / (length * length);
  double t[3], a[3], drift[3];
  store3(now.t, t);
  store3(now.axis, a);
  store3(now.across, drift);
  double slope[3][4];
  axis_gradient(now.q, slope);
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      const double other = (k == l ? 1 : 0) - t[k] * t[l];
      h[k][l] = (pos * data.stretch + vel * data.stretch_friction) * t[k] * t[l] +
                pos * data.stretch_friction / length * t[k] * drift[l] + across * other +
                bend * (a[k] * t[l] + t[k] * a[l] + along * (other - 2 * t[k] * t[l]));
    }
    for (int l = 0; l < 4; ++l) {
      const double t_slope = t[0] * slope[0][l] + t[1] * slope[1][l] + t[2] * slope[2][l];
      h[k][3 + l] = h[3 + l][k] = -coupling / length * (slope[k][l] - t_slope * t[k]);
    }
  }
  const double square = dot(now.q, now.q);
  const double swell = 2 * (coupling * square + pos * data.norm * (square - 1));
  const double pair = 4 * (coupling + pos * data.norm);
  double q[4];
  store_quaternion(now.q, q);
  for (int k = 0; k < 4; ++k) {
    // The second derivative of a . t is the matrix of a quadratic form in q.
    Quaternion unit{0, {}};
    (k == 0 ? unit.w : k == 1 ? unit.v.x : k == 2 ? unit.v.y : unit.v.z) = 1;
    double of_unit[3][4];
    axis_gradient(unit, of_unit);
    for (int l = 0; l < 4; ++l) {
      const double form =
          t[0] * of_unit[0][l] + t[1] * of_unit[1][l] + t[2] * of_unit[2][l];
      h[3 + k][3 + l] = (k == l ? swell : 0) + pair * q[k] * q[l] - coupling * form;
    }
  }
}

/// Over the quaternions before and behind.
void CordeElasticity::joint_tangent(const Joint& now, double pos, double vel,
                                    double (&h)[8][8]) const noexcept {
  const RodJoint& data = now.data;
  const double stiffness[3] = {data.stiffness.x, data.stiffness.y, data.stiffness.z};
  const double friction[3] = {data.friction.x, data.friction.y, data.friction.z};
  double slope_of_rate[3][8];
  turn_gradient(now.rate_before, now.rate_behind, slope_of_rate);
  for (int k = 0; k < 8; ++k) {
    for (int l = 0; l < 8; ++l) {
      h[k][l] = 0;
      for (int m = 0; m < 3; ++m) {
        h[k][l] += now.gradient[m][k] *
                   ((pos * stiffness[m] + vel * friction[m]) * now.gradient[m][l] +
                    pos * friction[m] * slope_of_rate[m][l]);
      }
    }
  }
  // stress . turn_between(p, q) = 2 p^T form q.
  const auto& s = now.stress;
  const double form[4][4] = {{0, s[0], s[1], s[2]},
                             {-s[0], 0, -s[2], s[1]},
                             {-s[1], s[2], 0, -s[0]},
                             {-s[2], -s[1], s[0], 0}};
  for (int k = 0; k < 4; ++k) {
    for (int l = 0; l < 4; ++l) {
      h[k][4 + l] += 2 * pos * form[k][l];
      h[4 + l][k] += 2 * pos * form[k][l];
    }
  }
}

void CordeElasticity::add_tangent(const Placement& p, double pos, double vel,
                                  GroupSum& s) noexcept {
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    double h[7][7], m[10][10];
    edge_tangent(edge(p, i), pos, vel, h);
    if (walled_ && i == 0) {
      double of_joint[8][8];
      joint_tangent(joint(p, 0), pos, vel, of_joint);
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) h[3 + k][3 + l] += of_joint[4 + k][4 + l];
      }
    }
    to_nodes<4>(h, m);
    s.add(i, &m[0][0]);
  }
  for (std::size_t j = walled_ ? 1 : 0; j < joint_data_.size(); ++j) {
    double h[8][8];
    joint_tangent(joint(p, j), pos, vel, h);
    s.add(edge_data_.size() + behind(j) - 1, &h[0][0]);
  }
}

double CordeElasticity::energy(const Placement& p) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    const Vec e = load3(&p.z[3 * i + 3]) - load3(&p.z[3 * i]);
    sum += edge_energy(edge_data_[i], e, load_quaternion(&p.z[at(i)]));
  }
  for (std::size_t j = 0; j < joint_data_.size(); ++j) {
    const Joint now = joint(p, j);
    sum += joint_energy(joint_data_[j], now.before, now.behind);
  }
  return sum;
}

double CordeElasticity::power(const Placement& p) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    const Edge now = edge(p, i);
    sum -= now.data.stretch_friction * now.lengthening * now.lengthening;
  }
  for (std::size_t j = 0; j < joint_data_.size(); ++j) {
    const Joint now = joint(p, j);
    const double friction[3] = {now.data.friction.x, now.data.friction.y,
                                now.data.friction.z};
    for (int m = 0; m < 3; ++m) sum -= friction[m] * now.rate[m] * now.rate[m];
    if (clamp(j)) {
      const Vec by_clamp = turn_between(now.rate_before, now.behind);
      sum += dot({now.stress[0], now.stress[1], now.stress[2]}, by_clamp);
    }
  }
  return sum;
}

/// A world rotation w moves q by w q/2.
Vec CordeElasticity::spin(const Placement& p, In inertia) noexcept {
  Vec sum;
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    const Quaternion q = load_quaternion(&p.z[at(i)]);
    const Quaternion conjugate{q.w, -1.0 * q.v};
    sum = sum + inertia[4 * i] / 2 * (load_quaternion(&p.rate[at(i)]) * conjugate).v;
  }
  return sum;
}

}  // namespace tress
