#include "models/maximal/der_elasticity.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tress {
namespace {

Vec entrywise(const Vec& a, const Vec& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// h over (e, theta) of two neighbouring edges becomes a matrix over three nodes and two
/// angles.
void to_nodes(const double (&h)[8][8], double (&m)[11][11]) {
  // Nodes at the ends have one edge, the one between both.
  double half[8][11];
  const auto row = [](const auto& from, auto&& to) {
    for (int k = 0; k < 3; ++k) {
      to(k, -from(k));
      to(3 + k, from(k) - from(4 + k));
      to(6 + k, from(4 + k));
    }
    to(9, from(3));
    to(10, from(7));
  };
  for (int i = 0; i < 8; ++i) {
    row([&](int k) { return h[i][k]; }, [&](int k, double x) { half[i][k] = x; });
  }
  for (int j = 0; j < 11; ++j) {
    row([&](int k) { return half[k][j]; }, [&](int k, double x) { m[k][j] = x; });
  }
}

}  // namespace

DerElasticity::DerElasticity(std::vector<EdgeData> edges, std::vector<RodJoint> joints,
                             bool walled, Tangent tangent)
    : edges_at_start_(std::move(edges)),
      edge_data_(edges_at_start_),
      joint_data_(std::move(joints)),
      walled_(walled),
      tangent_(tangent),
      friction_(std::ranges::any_of(
          joint_data_,
          [](const RodJoint& j) { return dot(j.friction, j.friction) > 0; })),
      angles_(3 * (edge_data_.size() + 1)),
      edges_(edge_data_.size()),
      joints_(joint_data_.size()) {}

std::vector<std::vector<int>> DerElasticity::groups() const {
  std::vector<std::vector<int>> all;
  const auto nodes_and_angles = [&](std::size_t first, int nodes) {
    std::vector<int> group(static_cast<std::size_t>(4 * nodes - 1));
    const auto angle = group.begin() + 3 * nodes;
    std::iota(group.begin(), angle, static_cast<int>(3 * first));
    std::iota(angle, group.end(), static_cast<int>(angles_ + first));
    return group;
  };
  for (std::size_t i = 0; i < edges_.size(); ++i) all.push_back(nodes_and_angles(i, 2));
  for (std::size_t i = 0; i + 1 < edges_.size(); ++i) {
    all.push_back(nodes_and_angles(i, 3));
  }
  return all;
}

void DerElasticity::place(const Placement& p) noexcept {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Vec e = load3(&p.z[3 * i + 3]) - load3(&p.z[3 * i]);
    const Vec rate = load3(&p.rate[3 * i + 3]) - load3(&p.rate[3 * i]);
    Edge& edge = edges_[i];
    edge.turn = EdgeTurn(edge_data_[i].reference.e0, e);
    edge.frame = edge_frame(edge_data_[i].reference, e, theta(p.z, i));
    edge.spin = edge.turn.spin(rate, theta(p.rate, i));
    edge.moment = {};
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const RodJoint& data = joint_data_[j];
    Joint& joint = joints_[j];
    Edge& behind = edges_[after(j)];
    joint.strain = JointStrain(frame_before(p, j), behind.frame);
    const Vec relative = behind.spin - (clamp(j) ? p.root.omega : edges_[before(j)].spin);
    const JointStrain& s = joint.strain;
    joint.rate = {dot(s.twist, relative), dot(s.curvature1, relative),
                  dot(s.curvature2, relative)};
    joint.stress = entrywise(data.stiffness, s.value - data.rest) +
                   entrywise(data.friction, joint.rate);
    const Vec moment = joint.stress.x * s.twist + joint.stress.y * s.curvature1 +
                       joint.stress.z * s.curvature2;
    behind.moment = behind.moment + moment;
    if (!clamp(j)) edges_[before(j)].moment = edges_[before(j)].moment - moment;
  }
}

void DerElasticity::add_force(const Placement& p, InOut f) noexcept {
  place(p);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    const EdgeData& data = edge_data_[i];
    const Vec force = edge.turn.force(edge.moment) +
                      (data.stretch * (edge.turn.length - data.length)) * edge.turn.t;
    store3(load3(&f[3 * i]) - force, &f[3 * i]);
    store3(load3(&f[3 * i + 3]) + force, &f[3 * i + 3]);
    f[angles_ + i] += dot(edge.moment, edge.turn.t);
  }
}

/// Over the coordinates (e, theta) before and behind the joint; of the clamp's joint only
/// what is behind.
void DerElasticity::joint_tangent(const Placement& p, std::size_t joint, double pos,
                                  double vel, Square& s) const noexcept {
  const RodJoint& data = joint_data_[joint];
  const JointStrain& strain = joints_[joint].strain;
  const Frame& minus = frame_before(p, joint);
  const Edge& behind = edges_[after(joint)];
  const Edge* edges[2] = {clamp(joint) ? nullptr : &edges_[before(joint)], &behind};

  // turn[k]: spin of the side of coordinate k; a clamp does not follow from any.
  Vec turn[8];
  for (int k = 0; k < 8; ++k) {
    if (edges[k / 4] != nullptr) turn[k] = edges[k / 4]->turn.column(k % 4);
  }
  const Vec slope[3] = {strain.twist, strain.curvature1, strain.curvature2};
  const double stiffness[3] = {data.stiffness.x, data.stiffness.y, data.stiffness.z};
  const double friction[3] = {data.friction.x, data.friction.y, data.friction.z};
  double gradient[3][8];
  for (int m = 0; m < 3; ++m) {
    for (int k = 0; k < 8; ++k) {
      gradient[m][k] = (k < 4 ? -1 : 1) * dot(slope[m], turn[k]);
    }
    const double weight = pos * stiffness[m] + vel * friction[m];
    for (int k = 0; k < 8; ++k) {
      for (int l = 0; l < 8; ++l) s[k][l] += weight * gradient[m][k] * gradient[m][l];
    }
  }
  if (tangent_ == Tangent::stiff || pos == 0) return;

  // form . (turn of l), side by side.
  const auto pulled = [&](const TwoVectorForm& form, int side, const Vec& w,
                          Vec(&out)[2]) {
    const double x[3] = {w.x, w.y, w.z};
    double y[6] = {};
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 3; ++j) y[i] += form.m[i][3 * side + j] * x[j];
    }
    out[0] = {y[0], y[1], y[2]};
    out[1] = {y[3], y[4], y[5]};
  };
  const TwoVectorForm form = strain.second(minus, behind.frame, joints_[joint].stress);
  for (int l = 0; l < 8; ++l) {
    Vec of[2];
    pulled(form, l / 4, turn[l], of);
    for (int k = 0; k < 8; ++k) s[k][l] += pos * dot(turn[k], of[k / 4]);
  }
  if (!friction_) return;
  // The rate of a strain changes with the place: second derivative along the motion.
  const Vec spins[2] = {clamp(joint) ? p.root.omega : edges[0]->spin, behind.spin};
  for (int m = 0; m < 3; ++m) {
    if (friction[m] == 0) continue;
    const TwoVectorForm own = strain.second(
        minus, behind.frame, {m == 0 ? 1.0 : 0, m == 1 ? 1.0 : 0, m == 2 ? 1.0 : 0});
    Vec along[2] = {};
    for (int side = 0; side < 2; ++side) {
      Vec of[2];
      pulled(own, side, spins[side], of);
      along[0] = along[0] + of[0];
      along[1] = along[1] + of[1];
    }
    double slope_of_rate[8];
    for (int k = 0; k < 8; ++k) slope_of_rate[k] = dot(turn[k], along[k / 4]);
    for (int side = 0; side < 2; ++side) {
      if (edges[side] == nullptr) continue;
      const std::size_t edge = side == 0 ? before(joint) : after(joint);
      double h[4][4] = {};
      edges[side]->turn.add_second(side == 0 ? -1 : 1, slope[m], h);
      const Vec de = load3(&p.rate[3 * edge + 3]) - load3(&p.rate[3 * edge]);
      const double y[4] = {de.x, de.y, de.z, theta(p.rate, edge)};
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) slope_of_rate[4 * side + k] += h[k][l] * y[l];
      }
    }
    for (int k = 0; k < 8; ++k) {
      for (int l = 0; l < 8; ++l) {
        s[k][l] += pos * friction[m] * gradient[m][k] * slope_of_rate[l];
      }
    }
  }
}

/// Stretching, and what the moments of its joints do on the second-order turn.
void DerElasticity::edge_tangent(std::size_t i, double pos,
                                 double (&h)[4][4]) const noexcept {
  const EdgeTurn& turn = edges_[i].turn;
  const EdgeData& data = edge_data_[i];
  const double tension = data.stretch * (turn.length - data.length) / turn.length;
  const bool exact = tangent_ == Tangent::exact;
  const double across = exact ? pos * tension : 0;
  const double along = pos * data.stretch - across;
  const double t[3] = {turn.t.x, turn.t.y, turn.t.z};
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) h[k][l] += along * t[k] * t[l] + (k == l ? across : 0);
  }
  if (exact) turn.add_second(pos, edges_[i].moment, h);
}

void DerElasticity::add_tangent(const Placement& p, double pos, double vel,
                                GroupSum& s) noexcept {
  place(p);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    double h[4][4] = {};
    edge_tangent(i, pos, h);
    if (walled_ && i == 0) {
      Square of_joint = {};
      joint_tangent(p, 0, pos, vel, of_joint);
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) h[k][l] += of_joint[4 + k][4 + l];
      }
    }
    double m[7][7];
    to_nodes<1>(h, m);
    s.add(i, &m[0][0]);
  }
  for (std::size_t j = walled_ ? 1 : 0; j < joints_.size(); ++j) {
    Square h = {};
    joint_tangent(p, j, pos, vel, h);
    double m[11][11];
    to_nodes(h, m);
    s.add(edges_.size() + before(j), &m[0][0]);
  }
}

bool DerElasticity::end_frame(const Placement& p, Frame& frame) noexcept {
  const std::size_t last = edges_.size() - 1;
  const Vec e = load3(&p.z[3 * last + 3]) - load3(&p.z[3 * last]);
  frame = edge_frame(edge_data_[last].reference, e, theta(p.z, last));
  return true;
}

double DerElasticity::energy(const Placement& p) noexcept {
  place(p);
  double e = 0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const double longer = edges_[i].turn.length - edge_data_[i].length;
    e += edge_data_[i].stretch / 2 * longer * longer;
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Vec bent = joints_[j].strain.value - joint_data_[j].rest;
    e += dot(joint_data_[j].stiffness, entrywise(bent, bent)) / 2;
  }
  return e;
}

double DerElasticity::power(const Placement& p) noexcept {
  place(p);
  double sum = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Joint& joint = joints_[j];
    sum -= dot(joint_data_[j].friction, entrywise(joint.rate, joint.rate));
  }
  if (walled_) {
    const Joint& joint = joints_[0];
    const JointStrain& s = joint.strain;
    sum -= dot(joint.stress.x * s.twist + joint.stress.y * s.curvature1 +
                   joint.stress.z * s.curvature2,
               p.root.omega);
  }
  return sum;
}

bool DerElasticity::rebase(InOut z, InOut rate) {
  bool moved = false;
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    const Vec e = load3(&z[3 * i + 3]) - load3(&z[3 * i]);
    const Vec de = load3(&rate[3 * i + 3]) - load3(&rate[3 * i]);
    moved |= renew_reference(edge_data_[i].reference, e, de, z[angles_ + i],
                             rate[angles_ + i]);
  }
  return moved;
}

std::vector<double> DerElasticity::memory() const {
  std::vector<double> references(9 * edge_data_.size());
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    store9(edge_data_[i].reference, &references[9 * i]);
  }
  return references;
}

void DerElasticity::recall(In memory) {
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    edge_data_[i].reference = load9(&memory[9 * i]);
  }
}

}  // namespace tress
