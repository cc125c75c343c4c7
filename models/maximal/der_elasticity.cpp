#include "models/maximal/der_elasticity.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

Vec entrywise(const Vec& a, const Vec& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// Converts a matrix over (e, theta) of neighbouring edges, one pack per row and edge, to
/// one over (x, theta) of their nodes. The last node has no angle: its row 3 is
/// unchanged.
template <int edges>
void to_nodes(const Pack (&h)[4 * edges][edges], Pack (&m)[4 * (edges + 1)][edges + 1]) {
  // An edge is the node at its end less the one at its start.
  const Pack start(-1, -1, -1, 1), end(1, 1, 1, 0);
  Pack half[4 * edges][edges + 1];
  for (int i = 0; i < 4 * edges; ++i) {
    for (int node = 0; node <= edges; ++node) {
      half[i][node] = Pack(0);
      if (node < edges) half[i][node] += start * h[i][node];
      if (node > 0) half[i][node] += end * h[i][node - 1];
    }
  }
  for (int node = 0; node <= edges; ++node) {
    for (int j = 0; j <= edges; ++j) {
      for (int k = 0; k < 3; ++k) {
        Pack& to = m[4 * node + k][j];
        to = Pack(0);
        if (node < edges) to -= half[4 * node + k][j];
        if (node > 0) to += half[4 * (node - 1) + k][j];
      }
      if (node < edges) m[4 * node + 3][j] = half[4 * node + 3][j];
    }
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
      stiff_(std::ranges::any_of(edge_data_,
                                 [](const EdgeData& edge) { return edge.stretch > 0; })),
      angles_(3 * (edge_data_.size() + 1)),
      edges_(edge_data_.size()),
      joints_(joint_data_.size()),
      placed_z_(4 * edge_data_.size() + 3),
      placed_rate_(placed_z_.size()) {
  forget_turns();
}

void DerElasticity::forget_turns() {
  twist_.clear();
  for (const RodJoint& joint : joint_data_) twist_.push_back(joint.rest.x);
}

std::vector<std::vector<int>> DerElasticity::groups() const {
  std::vector<std::vector<int>> all;
  // (x, theta) of nodes, the last without its angle.
  const auto nodes_and_angles = [&](std::size_t first, std::size_t nodes) {
    std::vector<int>& group = all.emplace_back();
    for (std::size_t node = first; node < first + nodes; ++node) {
      for (std::size_t k = 0; k < 3; ++k) group.push_back(static_cast<int>(3 * node + k));
      if (node + 1 < first + nodes) group.push_back(static_cast<int>(angles_ + node));
    }
  };
  nodes_and_angles(0, 2);
  for (std::size_t i = 0; i + 1 < edges_.size(); ++i) nodes_and_angles(i, 3);
  return all;
}

bool DerElasticity::placed_at(const Placement& p) noexcept {
  const auto same = [](const Vec& a, const Vec& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  };
  const Frame &now = p.root.frame, &then = placed_root_.frame;
  if (placed_ && std::ranges::equal(p.z, placed_z_) &&
      std::ranges::equal(p.rate, placed_rate_) &&
      same(p.root.omega, placed_root_.omega) && same(now.e0, then.e0) &&
      same(now.e1, then.e1) && same(now.e2, then.e2)) {
    return true;
  }
  std::ranges::copy(p.z, placed_z_.begin());
  std::ranges::copy(p.rate, placed_rate_.begin());
  placed_root_ = p.root;
  placed_ = true;
  return false;
}

void DerElasticity::reset() {
  edge_data_ = edges_at_start_;
  forget_turns();
  placed_ = false;
}

void DerElasticity::place(const Placement& p) noexcept {
  if (placed_at(p)) return;
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
    joint.strain.value.x = wound(joint.strain.value.x, twist_[j]);
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

/// T^T F T, with T the rotations of the two sides by (e, theta) before and behind the
/// joint, and F the second derivative by those rotations; for the clamp's joint only the
/// side behind.
void DerElasticity::joint_tangent(const Placement& p, std::size_t joint, double pos,
                                  double vel, Matrix& s) const noexcept {
  const RodJoint& data = joint_data_[joint];
  const JointStrain& strain = joints_[joint].strain;
  const Frame& minus = frame_before(p, joint);
  const Edge& behind = edges_[after(joint)];
  const Edge* edges[2] = {clamp(joint) ? nullptr : &edges_[before(joint)], &behind};
  const bool exact = tangent_ == Tangent::exact && pos != 0;

  TwoVectorForm f = exact
                        ? strain.second(minus, behind.frame, pos * joints_[joint].stress)
                        : TwoVectorForm{};
  const Vec slope[3] = {strain.twist, strain.curvature1, strain.curvature2};
  const Vec weight = pos * data.stiffness + vel * data.friction;
  f.add_relative(weight.x, slope[0]);
  f.add_relative(weight.y, slope[1]);
  f.add_relative(weight.z, slope[2]);

  // A clamp does not follow from any coordinate.
  std::array<Pack, 3> turn[2] = {};
  for (int side = 0; side < 2; ++side) {
    if (edges[side] != nullptr) turn[side] = edges[side]->turn.rows();
  }
  Pack turned[6][2];
  for (int i = 0; i < 6; ++i) {
    for (int side = 0; side < 2; ++side) {
      const Pack& row = f.rows[i][side];
      const auto& t = turn[side];
      turned[i][side] = row[0] * t[0] + row[1] * t[1] + row[2] * t[2];
    }
  }
  for (int i = 0; i < 8; ++i) {
    const auto& t = turn[i / 4];
    const Pack(*of_side)[2] = &turned[3 * (i / 4)];
    for (int side = 0; side < 2; ++side) {
      s[i][side] = t[0][i % 4] * of_side[0][side] + t[1][i % 4] * of_side[1][side] +
                   t[2][i % 4] * of_side[2][side];
    }
  }
  if (exact && friction_) add_slope_of_friction(p, joint, pos, s);
}

/// The rate of a strain changes with the place: second derivative along the motion.
void DerElasticity::add_slope_of_friction(const Placement& p, std::size_t joint,
                                          double pos, Matrix& s) const noexcept {
  const JointStrain& strain = joints_[joint].strain;
  const Frame& minus = frame_before(p, joint);
  const Edge& behind = edges_[after(joint)];
  const Edge* edges[2] = {clamp(joint) ? nullptr : &edges_[before(joint)], &behind};
  const Vec slope[3] = {strain.twist, strain.curvature1, strain.curvature2};
  const Vec& given = joint_data_[joint].friction;
  const double friction[3] = {given.x, given.y, given.z};
  const Vec before_spin = clamp(joint) ? p.root.omega : edges[0]->spin;
  const double spins[6] = {before_spin.x, before_spin.y, before_spin.z,
                           behind.spin.x, behind.spin.y, behind.spin.z};
  for (int m = 0; m < 3; ++m) {
    if (friction[m] == 0) continue;
    const TwoVectorForm own = strain.second(
        minus, behind.frame, {m == 0 ? 1.0 : 0, m == 1 ? 1.0 : 0, m == 2 ? 1.0 : 0});
    Vec along[2];
    for (int i = 0; i < 6; ++i) {
      double sum = 0;
      for (int j = 0; j < 6; ++j) sum += own.at(i, j) * spins[j];
      double* of[3] = {&along[i / 3].x, &along[i / 3].y, &along[i / 3].z};
      *of[i % 3] = sum;
    }
    double gradient[8] = {}, slope_of_rate[8] = {};
    for (int side = 0; side < 2; ++side) {
      if (edges[side] == nullptr) continue;
      const EdgeTurn& turn = edges[side]->turn;
      const double sign = side == 0 ? -1 : 1;
      Pack h[4] = {};
      turn.add_second(sign, slope[m], h);
      const std::size_t edge = side == 0 ? before(joint) : after(joint);
      const Vec de = load3(&p.rate[3 * edge + 3]) - load3(&p.rate[3 * edge]);
      const double y[4] = {de.x, de.y, de.z, theta(p.rate, edge)};
      for (int k = 0; k < 4; ++k) {
        const Vec column = turn.column(k);
        gradient[4 * side + k] = sign * dot(slope[m], column);
        double& rate = slope_of_rate[4 * side + k];
        rate = dot(column, along[side]);
        rate += sum(h[k] * Pack::load(y));
      }
    }
    for (int k = 0; k < 8; ++k) {
      for (int side = 0; side < 2; ++side) {
        s[k][side] +=
            pos * friction[m] * gradient[k] * Pack::load(&slope_of_rate[4 * side]);
      }
    }
  }
}

double DerElasticity::tension(const Placement& p, std::size_t i) const noexcept {
  const EdgeTurn& turn = edges_[i].turn;
  const EdgeData& data = edge_data_[i];
  if (p.origin == nullptr) return data.stretch * (turn.length - data.length);
  const Vec e = load3(&p.origin->z[3 * i + 3]) - load3(&p.origin->z[3 * i]);
  const double length = norm(e);
  return p.origin->stress(data.stretch, length - data.length,
                          turn.length * dot(turn.t, e) / length - length);
}

/// Stretching, and the moments of the edge's joints times its second-order rotation.
void DerElasticity::add_edge_tangent(const Placement& p, std::size_t i, double pos,
                                     Pack (&h)[4]) const noexcept {
  const EdgeTurn& turn = edges_[i].turn;
  const EdgeData& data = edge_data_[i];
  const bool exact = tangent_ == Tangent::exact;
  const double across = exact ? pos * tension(p, i) / turn.length : 0;
  const Vec along = (pos * data.stretch - across) * turn.t;
  const Pack t(turn.t.x, turn.t.y, turn.t.z, 0);
  h[0] += along.x * t + Pack(across, 0, 0, 0);
  h[1] += along.y * t + Pack(0, across, 0, 0);
  h[2] += along.z * t + Pack(0, 0, across, 0);
  if (exact) turn.add_second(pos, edges_[i].moment, h);
}

/// Each joint with the edge behind it; the first edge, with its clamp, alone.
void DerElasticity::add_tangent(const Placement& p, double pos, double vel,
                                GroupSum& s) noexcept {
  place(p);
  Matrix joint;
  // The lower right quarter, of the edge behind.
  const auto behind = [&](int k) -> Pack& { return joint[4 + k][1]; };
  const auto add_edge = [&](std::size_t edge) {
    Pack h[4] = {behind(0), behind(1), behind(2), behind(3)};
    add_edge_tangent(p, edge, pos, h);
    for (int k = 0; k < 4; ++k) behind(k) = h[k];
  };
  for (int k = 0; k < 4; ++k) behind(k) = Pack(0);
  if (walled_) joint_tangent(p, 0, pos, vel, joint);
  add_edge(0);
  const Pack first[4][1] = {{behind(0)}, {behind(1)}, {behind(2)}, {behind(3)}};
  Pack of_first[8][2];
  to_nodes<1>(first, of_first);
  s.add(0, of_first);
  for (std::size_t j = walled_ ? 1 : 0; j < joints_.size(); ++j) {
    joint_tangent(p, j, pos, vel, joint);
    add_edge(after(j));
    Pack m[12][3];
    to_nodes<2>(joint, m);
    s.add(1 + before(j), m);
  }
}

Vec DerElasticity::spin(const Placement& p, In inertia) noexcept {
  place(p);
  Vec sum;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Vec& t = edges_[i].turn.t;
    sum = sum + (inertia[i] * dot(edges_[i].spin, t)) * t;
  }
  return sum;
}

std::optional<Frame> DerElasticity::end_frame(const Placement& p) noexcept {
  const std::size_t last = edges_.size() - 1;
  const Vec e = load3(&p.z[3 * last + 3]) - load3(&p.z[3 * last]);
  return edge_frame(edge_data_[last].reference, e, theta(p.z, last));
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

bool DerElasticity::rebase(const RootPose& root, InOut z, InOut rate) {
  // The forces of the step have placed its joints near enough to count turns.
  if (!placed_) place({root, z, rate});
  for (std::size_t j = 0; j < joints_.size(); ++j) twist_[j] = joints_[j].strain.value.x;
  replaced_.clear();
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    const Vec e = load3(&z[3 * i + 3]) - load3(&z[3 * i]);
    const Vec de = load3(&rate[3 * i + 3]) - load3(&rate[3 * i]);
    const Frame before = edge_data_[i].reference;
    if (renew_reference(edge_data_[i].reference, e, de, z[angles_ + i],
                        rate[angles_ + i])) {
      replaced_.push_back({i, before});
    }
  }
  placed_ = placed_ && replaced_.empty();
  return !replaced_.empty();
}

void DerElasticity::carry(InOut z, InOut rate, InOut second) const {
  const auto edge = [](In x, std::size_t i) {
    return load3(&x[3 * i + 3]) - load3(&x[3 * i]);
  };
  for (const auto& [i, before] : replaced_) {
    refer(before, edge_data_[i].reference, edge(z, i), edge(rate, i), edge(second, i),
          z[angles_ + i], rate[angles_ + i], second[angles_ + i]);
  }
}

std::vector<double> DerElasticity::memory() const {
  std::vector<double> all(9 * edge_data_.size());
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    store9(edge_data_[i].reference, &all[9 * i]);
  }
  all.insert(all.end(), twist_.begin(), twist_.end());
  return all;
}

void DerElasticity::recall(In memory) {
  placed_ = false;
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    edge_data_[i].reference = load9(&memory[9 * i]);
  }
  std::ranges::copy(memory.subspan(9 * edge_data_.size()), twist_.begin());
}

}  // namespace tress::models
