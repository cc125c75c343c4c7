#include "models/quaternion_rods/quaternion_rod.h"

#include <cmath>

#include "models/maximal/to_nodes.h"
#include "models/quaternion_rods/orientation_step.h"

namespace tress::models {
namespace {

/// Stores the clamp's frame as the quaternion before q, and its rate.
void store_wall(const RootPose& root, const Quaternion& q, double* x, double* rate) {
  const Quaternion wall = nearer(q, quaternion_of(root.frame));
  store_quaternion(wall, x);
  store_quaternion(rate_of(wall, root.omega), rate);
}

/// The state at which stresses of second order are.
Placement origin_of(const Placement& p) { return {p.origin->root, p.origin->z, p.rate}; }

}  // namespace

template <class Edge>
QuaternionRod<Edge>::QuaternionRod(std::vector<Edge> edges,
                                   std::vector<QuaternionJoint> joints, bool walled)
    : edges_(std::move(edges)),
      joints_(std::move(joints)),
      walled_(walled),
      quaternions_(3 * (edges_.size() + 1)),
      factors_(walled ? edges_.size() : 0) {}

template <class Edge>
std::vector<std::vector<int>> QuaternionRod<Edge>::groups() const {
  std::vector<std::vector<int>> all;
  const auto append = [&all](std::size_t first, int count) {
    for (int k = 0; k < count; ++k) all.back().push_back(static_cast<int>(first) + k);
  };
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    all.emplace_back();
    append(3 * i, 6);
    append(at(i), 4);
  }
  for (std::size_t i = 0; i + 1 < edges_.size(); ++i) {
    all.emplace_back();
    append(at(i), 8);
  }
  return all;
}

template <class Edge>
auto QuaternionRod<Edge>::edge(const Placement& p, std::size_t i) const noexcept
    -> Local<Edge> {
  Local<Edge> local;
  const auto fill = [&](In z, double* x) {
    store3(load3(&z[3 * i + 3]) - load3(&z[3 * i]), x);
    std::copy_n(&z[at(i)], 4, x + 3);
  };
  fill(p.z, local.x);
  fill(p.rate, local.rate);
  return local;
}

template <class Edge>
auto QuaternionRod<Edge>::joint(const Placement& p, std::size_t j) const noexcept
    -> Local<QuaternionJoint> {
  Local<QuaternionJoint> local;
  const std::size_t after = at(behind(j));
  std::copy_n(&p.z[after], 4, local.x + 4);
  std::copy_n(&p.rate[after], 4, local.rate + 4);
  if (clamp(j)) {
    store_wall(p.root, load_quaternion(&p.z[after]), local.x, local.rate);
  } else {
    std::copy_n(&p.z[after - 4], 4, local.x);
    std::copy_n(&p.rate[after - 4], 4, local.rate);
  }
  return local;
}

template <class Edge>
void QuaternionRod<Edge>::displace(const Displacement& by, InOut z, InOut rate) {
  const Quaternion turn = quaternion_of(by.turn);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Quaternion q = turn * load_quaternion(&z[at(i)]),
                     turned = turn * load_quaternion(&rate[at(i)]),
                     more = rate_of(q, by.spin());
    store_quaternion(q, &z[at(i)]);
    store_quaternion({turned.w + more.w, turned.v + more.v}, &rate[at(i)]);
  }
}

template <class Edge>
void QuaternionRod<Edge>::add_force(const Placement& p, InOut f) noexcept {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const auto now = edge(p, i);
    double force[7] = {};
    Strained(edges_[i], now.x, now.rate).add_force(force);
    store3(load3(&f[3 * i]) - load3(force), &f[3 * i]);
    store3(load3(&f[3 * i + 3]) + load3(force), &f[3 * i + 3]);
    for (std::size_t k = 0; k < 4; ++k) f[at(i) + k] += force[3 + k];
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto now = joint(p, j);
    double force[8] = {};
    Strained(joints_[j], now.x, now.rate).add_force(force);
    const std::size_t first = at(behind(j)) - 4;
    for (std::size_t k = clamp(j) ? 4 : 0; k < 8; ++k) f[first + k] += force[k];
  }
}

template <class Edge>
void QuaternionRod<Edge>::edge_tangent(const Placement& p, std::size_t i, double pos,
                                       double vel, double (&h)[7][7]) const noexcept {
  const auto now = edge(p, i);
  Strained strained(edges_[i], now.x, now.rate);
  if (p.origin != nullptr) strained.take_stresses(*p.origin, edge(origin_of(p), i).x);
  strained.tangent(pos, vel, h);
}

template <class Edge>
void QuaternionRod<Edge>::joint_tangent(const Placement& p, std::size_t j, double pos,
                                        double vel, double (&h)[8][8]) const noexcept {
  const auto now = joint(p, j);
  Strained strained(joints_[j], now.x, now.rate);
  if (p.origin != nullptr) strained.take_stresses(*p.origin, joint(origin_of(p), j).x);
  strained.tangent(pos, vel, h);
}

template <class Edge>
void QuaternionRod<Edge>::add_tangent(const Placement& p, double pos, double vel,
                                      GroupSum& s) noexcept {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    double h[7][7], m[10][10];
    edge_tangent(p, i, pos, vel, h);
    if (walled_ && i == 0) {
      double of_joint[8][8];
      joint_tangent(p, 0, pos, vel, of_joint);
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) h[3 + k][3 + l] += of_joint[4 + k][4 + l];
      }
    }
    to_nodes<4>(h, m);
    s.add(i, &m[0][0]);
  }
  for (std::size_t j = walled_ ? 1 : 0; j < joints_.size(); ++j) {
    double h[8][8];
    joint_tangent(p, j, pos, vel, h);
    s.add(edges_.size() + behind(j) - 1, &h[0][0]);
  }
}

template <class Edge>
bool QuaternionRod<Edge>::factor(const Placement& p, Weights w,
                                 const Others& others) noexcept {
  using Elimination = QuaternionElimination<double>;
  typename Elimination::Beyond beyond;
  StrandPivots pivots;
  for (std::size_t i = edges_.size(); i-- > 0;) {
    typename Elimination::Own own;
    edge_tangent(p, i, w.pos, w.vel, own.edge);
    joint_tangent(p, i, w.pos, w.vel, own.joint);
    for (std::size_t k = 0; k < 4; ++k) {
      own.edge[3 + k][3 + k] += w.acc * others.inertia[4 * i + k];
    }
    const double mass = w.acc * others.mass[i + 1];
    beyond.add_block({{{mass, 0, 0}, {0, mass, 0}, {0, 0, mass}}});
    if (!others.blocks.empty()) add_block(&others.blocks[9 * (i + 1)], beyond);
    auto& f = factors_[i];
    Elimination::eliminate(own, i == 0, beyond, f);
    for (int k = 0; k < Elimination::size; ++k) {
      for (int l = 0; l < k; ++l) pivots(1, f.matrix[k][l]);
    }
  }
  return pivots.kept();
}

template <class Edge>
void QuaternionRod<Edge>::solve(In b, Out x) noexcept {
  using Elimination = QuaternionElimination<double>;
  const std::size_t n = edges_.size();
  typename Elimination::Right right;
  for (std::size_t i = n; i-- > 0;) {
    store3(load3(right.force) + load3(&b[3 * i]), right.force);
    double own[Elimination::size] = {};
    std::copy_n(&b[3 * n + 4 * i], 4, own + 3);
    Elimination::reduce(own, {}, i == 0, factors_[i], right);
  }
  double before[Elimination::size] = {}, y[Elimination::size];
  for (std::size_t i = 0; i < n; ++i) {
    Elimination::change(factors_[i], i == 0, before, y);
    store3(load3(before) + load3(y), before);
    std::copy_n(y + 3, 4, before + 3);
    std::copy_n(before, 3, &x[3 * i]);
    std::copy_n(before + 3, 4, &x[3 * n + 4 * i]);
  }
}

template <class Edge>
double QuaternionRod<Edge>::energy(const Placement& p) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    sum += strain_energy(edges_[i], edge(p, i).x);
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    sum += strain_energy(joints_[j], joint(p, j).x);
  }
  return sum;
}

template <class Edge>
double QuaternionRod<Edge>::power(const Placement& p) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const auto now = edge(p, i);
    sum += Strained(edges_[i], now.x, now.rate).friction_power();
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const auto local = joint(p, j);
    const Strained now(joints_[j], local.x, local.rate);
    sum += now.friction_power();
    if (!clamp(j)) continue;
    for (int m = 0; m < 3; ++m) {
      for (int k = 0; k < 4; ++k) {
        sum += now.stress[m] * now.gradient[m][k] * local.rate[k];
      }
    }
  }
  return sum;
}

template <class Edge>
std::optional<Frame> QuaternionRod<Edge>::end_frame(const Placement& p) noexcept {
  const Quaternion q = load_quaternion(&p.z[at(edges_.size() - 1)]);
  return axes((1 / std::sqrt(dot(q, q))) * q);
}

/// A world rotation w moves q by w q/2.
template <class Edge>
Vec QuaternionRod<Edge>::spin(const Placement& p, In inertia) noexcept {
  Vec sum;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Quaternion q = load_quaternion(&p.z[at(i)]);
    const Quaternion conjugate{q.w, -1.0 * q.v};
    sum = sum + inertia[4 * i] / 2 * (load_quaternion(&p.rate[at(i)]) * conjugate).v;
  }
  return sum;
}

/// Joint and edge in turn, from the wall or the first edge.
template <class Edge>
std::vector<ComplianceForm::Block> QuaternionRod<Edge>::strain_blocks() const {
  const auto range = [](std::vector<int>& all, std::size_t first, int count) {
    for (int k = 0; k < count; ++k) all.push_back(static_cast<int>(first) + k);
  };
  std::vector<ComplianceForm::Block> blocks;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (walled_ || i > 0) {
      const std::size_t j = walled_ ? i : i - 1;
      std::vector<int> quaternions;
      if (clamp(j)) {
        range(quaternions, at(i), 4);
      } else {
        range(quaternions, at(i) - 4, 8);
      }
      blocks.push_back(strain_block(joints_[j], std::move(quaternions)));
    }
    std::vector<int> of_edge;
    range(of_edge, 3 * i, 6);
    range(of_edge, at(i), 4);
    blocks.push_back(strain_block(edges_[i], std::move(of_edge)));
  }
  return blocks;
}

template <class Edge>
std::vector<ComplianceForm::Orientation> QuaternionRod<Edge>::orientations() const {
  std::vector<ComplianceForm::Orientation> all;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    auto& [coordinates, own] = all.emplace_back();
    for (std::size_t k = 0; k < 6; ++k)
      coordinates.push_back(static_cast<int>(3 * i + k));
    own = i > 0 ? 10 : 6;
    const std::size_t end = i + 1 < edges_.size() ? at(i) + 8 : at(i) + 4;
    for (std::size_t k = i > 0 ? at(i) - 4 : at(i); k < end; ++k) {
      coordinates.push_back(static_cast<int>(k));
    }
  }
  return all;
}

template <class Edge>
void QuaternionRod<Edge>::orient(std::size_t i, const RootPose& root, double h,
                                 const double* origin, const double* z,
                                 double* q) noexcept {
  const std::size_t own = i > 0 ? 10 : 6;
  double x[8], rate[8];
  store3(load3(z + 3) - load3(z), x);
  Quaternion now = load_quaternion(z + own);
  now = (1 / std::sqrt(dot(now, now))) * now;
  store_quaternion(now, x + 3);
  OrientationStep step(now, edges_[i].pull(x));
  const auto moving = [&](std::size_t from, std::size_t to) {
    std::copy_n(z + from, 4, x + to);
    for (std::size_t k = 0; k < 4; ++k)
      rate[to + k] = (z[from + k] - origin[from + k]) / h;
  };
  if (walled_ || i > 0) {
    moving(own, 4);
    if (i > 0) {
      moving(own - 4, 0);
    } else {
      store_wall(root, now, x, rate);
    }
    step.add(joints_[before(i)], h, x, rate, OrientationStep::Side::behind);
  }
  if (i + 1 < edges_.size()) {
    moving(own, 0);
    moving(own + 4, 4);
    step.add(joints_[before(i + 1)], h, x, rate, OrientationStep::Side::before);
  }
  store_quaternion(step.taken(), q);
}

template <class Edge>
void QuaternionRod<Edge>::strain(std::size_t k, const RootPose& root, const double* z,
                                 ComplianceForm::Value& value) noexcept {
  std::ranges::fill(value.drift, 0.0);
  const std::size_t place = walled_ ? k : k + 1;  // joints even, edges odd
  if (place % 2 == 1) {
    edge_strain(place / 2, z, value);
  } else if (walled_ && k == 0) {
    wall_strain(root, z, value);
  } else {
    const QuaternionJoint& joint = joints_[walled_ ? place / 2 : place / 2 - 1];
    double g[3][8];
    joint.strain(z, value.c);
    joint.gradient(z, g);
    for (int m = 0; m < 3; ++m) std::copy_n(g[m], 8, value.gradient[m]);
  }
}

template <class Edge>
void QuaternionRod<Edge>::add_second(std::size_t k, const RootPose& /*root*/,
                                     const double* z, In stress,
                                     ComplianceForm::Second& second) noexcept {
  const std::size_t place = walled_ ? k : k + 1;  // joints even, edges odd
  if (place % 2 == 1) {
    double x[7], h[7][7] = {}, of_nodes[10][10];
    store3(load3(z + 3) - load3(z), x);
    std::copy_n(z + 6, 4, x + 3);
    edges_[place / 2].add_second(x, stress.data(), h);
    to_nodes<4>(h, of_nodes);
    for (int i = 0; i < 10; ++i) {
      for (int j = 0; j < 10; ++j) second[i][j] += of_nodes[i][j];
    }
    return;
  }
  if (walled_ && k == 0) return;  // linear in the only quaternion that moves
  double h[8][8] = {};
  joints_[before(place / 2)].add_second(z, stress.data(), h);
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) second[i][j] += h[i][j];
  }
}

template <class Edge>
void QuaternionRod<Edge>::wall_strain(const RootPose& root, const double* z,
                                      ComplianceForm::Value& value) const noexcept {
  double g[3][8], x[8], wall_rate[4];
  store_wall(root, load_quaternion(z), x, wall_rate);
  std::copy_n(z, 4, x + 4);
  joints_[0].strain(x, value.c);
  joints_[0].gradient(x, g);
  for (int m = 0; m < 3; ++m) {
    for (int l = 0; l < 4; ++l) value.drift[m] += g[m][l] * wall_rate[l];
    std::copy_n(g[m] + 4, 4, value.gradient[m]);
  }
}

template <class Edge>
void QuaternionRod<Edge>::edge_strain(std::size_t i, const double* z,
                                      ComplianceForm::Value& value) const noexcept {
  double g[Edge::strains][7], x[7];
  store3(load3(z + 3) - load3(z), x);
  std::copy_n(z + 6, 4, x + 3);
  edges_[i].strain(x, value.c);
  edges_[i].gradient(x, g);
  for (int m = 0; m < Edge::strains; ++m) {
    store3(-1.0 * load3(g[m]), value.gradient[m]);
    std::copy_n(g[m], 7, value.gradient[m] + 3);
  }
}

template class QuaternionRod<CordeEdge>;
template class QuaternionRod<CosseratEdge>;
}  // namespace tress::models
