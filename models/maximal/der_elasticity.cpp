#include "models/maximal/der_elasticity.h"

#include <algorithm>
#include <cmath>

#include "math/instructions.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/to_nodes.h"

namespace tress::models {
namespace {

Vec entrywise(const Vec& a, const Vec& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

using Rows = std::array<Pack, 3>;

Pack row(const Vec& of_e, double of_theta) {
  return Pack(of_e.x, of_e.y, of_e.z, of_theta);
}

/// Rotation of an edge, in components of its frame, by (e, theta).
Rows rotation_of(const DerPlaced<double>& e) {
  const Vec one = -e.inverse_length * e.frame.e2, two = e.inverse_length * e.frame.e1;
  return {row(-e.p.y * one - e.p.z * two, 1), row(one, 0), row(two, 0)};
}

Pack combined(const Vec& weights, const Rows& rows) {
  return weights.x * rows[0] + weights.y * rows[1] + weights.z * rows[2];
}

/// a^T f b.
void add_product(const Rows& a, const Matrix3<double>& f, const Rows& b, Pack (&h)[4]) {
  const Rows turned{combined(f.row[0], b), combined(f.row[1], b), combined(f.row[2], b)};
  for (int i = 0; i < 4; ++i) {
    h[i] += a[0][i] * turned[0] + a[1][i] * turned[1] + a[2][i] * turned[2];
  }
}

/// x y^T.
void add_dyad(const Pack& x, const Pack& y, Pack (&h)[4]) {
  for (int i = 0; i < 4; ++i) h[i] += x[i] * y;
}

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
                             bool walled, Jacobian jacobian)
    : edges_at_start_(std::move(edges)),
      edge_data_(edges_at_start_),
      joint_data_(std::move(joints)),
      walled_(walled),
      jacobian_(jacobian),
      friction_(std::ranges::any_of(
          joint_data_,
          [](const RodJoint& j) { return dot(j.friction, j.friction) > 0; })),
      stiff_(std::ranges::any_of(edge_data_,
                                 [](const EdgeData& edge) { return edge.stretch > 0; })),
      angles_(3 * (edge_data_.size() + 1)),
      factored_(edge_data_.size()),
      now_(edge_data_.size()),
      stiff_factors_(jacobian == Jacobian::exact ? 0 : edge_data_.size()),
      exact_factors_(jacobian == Jacobian::exact ? edge_data_.size() : 0) {
  forget_turns();
}

void DerElasticity::forget_turns() {
  twist_.clear();
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    twist_.push_back(joint(i) == nullptr ? 0 : joint(i)->rest.x);
  }
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
  for (std::size_t i = 0; i + 1 < edge_data_.size(); ++i) nodes_and_angles(i, 3);
  return all;
}

void DerElasticity::forget() {
  factored_.at.forget();
  now_.at.forget();
  latest_ = nullptr;
}

void DerElasticity::reset() {
  edge_data_ = edges_at_start_;
  forget_turns();
  forget();
}

template <bool with_tangent, bool exact>
TRESS_FLATTEN void DerElasticity::place_as(const Placement& p, Weights w,
                                           Placed& to) noexcept {
  using Forces = DerForces<double, exact>;
  const Frame* frame_before = &p.root.frame;
  DerMotion<double> before{p.root.frame.back(p.root.omega), 0};
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    const EdgeData& data = edge_data_[i];
    Edge& e = to.edges[i];
    const auto along = [i](In x) { return load3(&x[3 * i + 3]) - load3(&x[3 * i]); };
    e.motion =
        Forces::edge(data.reference.e0, data.reference.e1, theta(p.z, i), along(p.z),
                     along(p.rate), theta(p.rate, i), data.stretch, data.length, e);
    if (const RodJoint* of = joint(i); of != nullptr) {
      DerJoint<double> strain = Forces::strain(*frame_before, e);
      e.twist = strain.value.x = wound(strain.value.x, twist_[i]);
      e.strain = strain.value - of->rest;
      const Vec relative = e.motion.spin - e.turn.back(before.spin);
      e.rate = {dot(strain.twist, relative), dot(strain.curvature1, relative),
                dot(strain.curvature2, relative)};
      e.by_lengthening = {};
      const auto joint_at = [&](auto... left_out) {
        Forces::template joint<with_tangent>(
            strain, e.strain, of->stiffness, of->friction.x, friction_, w, e.motion,
            before, i > 0 ? &to.edges[i - 1] : nullptr, e, left_out...);
      };
      if constexpr (exact) {
        joint_at(&e.by_lengthening);
      } else {
        joint_at();
      }
    }
    frame_before = &e.frame;
    before = e.motion;
  }
}

void DerElasticity::place(const Placement& p, Weights w, Placed& to) noexcept {
  if (jacobian_ == Jacobian::exact) {
    place_as<true, true>(p, w, to);
  } else {
    place_as<true, false>(p, w, to);
  }
  to.at.take(p);
  latest_ = &to;
}

const DerElasticity::Edges& DerElasticity::place(const Placement& p) noexcept {
  if (factored_.at.is(p)) {
    latest_ = &factored_;
  } else if (!now_.at.is(p)) {
    place_as<false, false>(p, {}, now_);
    now_.at.take(p);
    latest_ = &now_;
  }
  return latest_->edges;
}

Vec DerElasticity::moment(const Edges& edges, std::size_t i) const {
  if (i + 1 == edges.size()) return edges[i].moment;
  return edges[i].moment - edges[i + 1].turn * edges[i + 1].moment;
}

void DerElasticity::add_force(const Placement& p, InOut f) noexcept {
  const Edges& edges = place(p);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec on_it = moment(edges, i), force = edges[i].force_by(on_it);
    store3(load3(&f[3 * i]) - force, &f[3 * i]);
    store3(load3(&f[3 * i + 3]) + force, &f[3 * i + 3]);
    f[angles_ + i] += on_it.x;
  }
}

/// By (e, theta) before and behind the joint before edge i; for the clamp's joint only
/// the side behind.
void DerElasticity::joint_tangent(const Edges& edges, std::size_t i,
                                  Matrix& s) const noexcept {
  const Edge& e = edges[i];
  const Rows own = rotation_of(e);
  const bool exact = jacobian_ == Jacobian::exact;
  const auto add = [&](const Rows& a, const Matrix3<double>& f, const Rows& b, int side_a,
                       int side_b) {
    Pack h[4] = {};
    add_product(a, f, b, h);
    for (int k = 0; k < 4; ++k) s[4 * side_a + k][side_b] += h[k];
  };
  const auto add_column = [&](const Vec& moment, const Rows& rows, const Edge& lengthened,
                              int side_a, int side_b) {
    Pack h[4] = {};
    add_dyad(combined(moment, rows), row(lengthened.frame.e0, 0), h);
    for (int k = 0; k < 4; ++k) s[4 * side_a + k][side_b] += h[k];
  };
  const bool rubbed = exact && friction_;
  const Matrix3<double> stiff = full(e.stiff);
  if (rubbed) add_column(e.by_lengthening.own, own, e, 1, 1);
  add(own, exact ? e.ww : stiff, own, 1, 1);
  if (i == 0) return;
  // The rotation of the edge before, in components of this edge.
  const Rows its = rotation_of(edges[i - 1]);
  const Rows before{combined(e.turn.column(0), its), combined(e.turn.column(1), its),
                    combined(e.turn.column(2), its)};
  add(own, exact ? e.wo : -1.0 * stiff, before, 1, 0);
  add(before, exact ? e.ow : -1.0 * stiff, own, 0, 1);
  add(before, exact ? e.oo : stiff, before, 0, 0);
  if (!rubbed) return;
  const Vec &by_own = e.by_lengthening.own, &by_before = e.by_lengthening.before;
  add_column(-1.0 * by_own, before, e, 0, 1);
  add_column(by_before, own, edges[i - 1], 1, 0);
  add_column(-1.0 * by_before, before, edges[i - 1], 0, 0);
}

/// Stretching, and the moments of the edge's joints times its second-order rotation.
void DerElasticity::add_edge_tangent(const Placement& p, const Edges& edges,
                                     std::size_t i, double pos,
                                     Pack (&h)[4]) const noexcept {
  const Edge& e = edges[i];
  const Pack lengthening = row(e.frame.e0, 0);
  add_dyad(pos * edge_data_[i].stretch * lengthening, lengthening, h);
  if (jacobian_ != Jacobian::exact) return;
  const DerEdgeForm<double> second(e.p, e.inverse_length, pos * moment(edges, i));
  Matrix3<double> by_omega = full(second.omega);
  const double pull = pos * tension(p, edges, i) * e.length;
  by_omega.row[1].y += pull;
  by_omega.row[2].z += pull;
  const Rows own = rotation_of(e);
  add_product(own, by_omega, own, h);
  const Pack across = combined(second.sigma, own);
  add_dyad(lengthening, across, h);
  add_dyad(across, lengthening, h);
}

template <class Elimination>
TRESS_FLATTEN bool DerElasticity::eliminate(
    const Placement& p, Weights w, const Others& others,
    std::vector<typename Elimination::Factor>& factors) noexcept {
  const Edges& edges = factored_.edges;
  typename Elimination::Beyond beyond;
  StrandPivots pivots;
  for (std::size_t i = edges.size(); i-- > 0;) {
    beyond.add_inertia(w.acc * others.mass[i + 1]);
    if (!others.blocks.empty() && !add_block(&others.blocks[9 * (i + 1)], beyond)) {
      return false;
    }
    const double along = w.pos * edge_data_[i].stretch,
                 turning = w.acc * others.inertia[i];
    if constexpr (std::is_same_v<Elimination, Exact>) {
      Elimination::eliminate(edges[i], i == 0, w.pos, along, turning, moment(edges, i),
                             tension(p, edges, i), beyond, factors[i], pivots);
    } else {
      Elimination::eliminate(edges[i], i == 0, along, turning, beyond, factors[i],
                             pivots);
    }
  }
  return pivots.kept();
}

bool DerElasticity::factor(const Placement& p, Weights w, const Others& others) noexcept {
  place(p, w, factored_);
  return jacobian_ == Jacobian::exact ? eliminate<Exact>(p, w, others, exact_factors_)
                                      : eliminate<Stiff>(p, w, others, stiff_factors_);
}

/// x += sign times the solution for the right sides in `factors`. Returns the largest
/// lengthening.
template <class Elimination>
double DerElasticity::substitute(std::vector<typename Elimination::Factor>& factors,
                                 double sign, InOut x) noexcept {
  Edges& edges = factored_.edges;
  Vec node, omega;
  double most = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    Edge& e = edges[i];
    const auto own = der_change(e, factors[i], i == 0, node, omega);
    omega = own.omega;
    e.sigma = own.sigma;
    most = std::max(most, std::abs(own.sigma));
    node = node + e.change(omega, own.sigma);
    store3(load3(&x[3 * i]) + sign * node, &x[3 * i]);
    x[3 * edges.size() + i] += sign * dot(e.p, omega);
  }
  return most;
}

template <class Elimination>
TRESS_FLATTEN void DerElasticity::solve_by(
    std::vector<typename Elimination::Factor>& factors, In b, Out x) noexcept {
  const Edges& edges = factored_.edges;
  Vec f_x, f_omega;
  for (std::size_t i = edges.size(); i-- > 0;) {
    Elimination::reduce(edges[i], factors[i], load3(&b[3 * i]),
                        b[3 * edges.size() + i] * edges[i].p, 0, f_x, f_omega);
    f_omega = edges[i].turn * f_omega;
  }
  std::ranges::fill(x, 0.0);
  const double most = substitute<Elimination>(factors, 1, x);
  if constexpr (std::is_same_v<Elimination, Exact>) {
    if (friction_) correct(most, x);
  }
}

/// The solution x, with lengthenings of `most` at most, corrected by what elimination
/// leaves out (ByLengthening): x - S^-1 R x + (S^-1 R)^2 x - ...
TRESS_FLATTEN void DerElasticity::correct(double most, InOut x) noexcept {
  constexpr double enough = 1e-9;
  constexpr int most_corrections = 8;
  const Edges& edges = factored_.edges;
  double sign = 1, left = most;
  for (int k = 0; k < most_corrections && left > enough * most; ++k) {
    sign = -sign;
    Vec f_x, f_omega;
    for (std::size_t i = edges.size(); i-- > 0;) {
      const Edge& e = edges[i];
      Vec on_it = e.sigma * e.by_lengthening.own;
      if (i > 0) on_it = on_it + edges[i - 1].sigma * e.by_lengthening.before;
      Exact::reduce(e, exact_factors_[i], {}, on_it, 0, f_x, f_omega);
      f_omega = e.turn * (f_omega - on_it);
    }
    left = substitute<Exact>(exact_factors_, sign, x);
  }
}

void DerElasticity::solve(In b, Out x) noexcept {
  if (jacobian_ == Jacobian::exact) {
    solve_by<Exact>(exact_factors_, b, x);
  } else {
    solve_by<Stiff>(stiff_factors_, b, x);
  }
}

/// Each joint with the edge behind it; the first edge, with its clamp, alone.
void DerElasticity::add_tangent(const Placement& p, double pos, double vel,
                                GroupSum& s) noexcept {
  place(p, {0, vel, pos}, now_);
  const Edges& edges = now_.edges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    Matrix h = {};
    if (joint(i) != nullptr) joint_tangent(edges, i, h);
    Pack behind[4] = {};
    add_edge_tangent(p, edges, i, pos, behind);
    for (int k = 0; k < 4; ++k) h[4 + k][1] += behind[k];
    if (i == 0) {
      const Pack first[4][1] = {{h[4][1]}, {h[5][1]}, {h[6][1]}, {h[7][1]}};
      Pack of_first[8][2];
      to_nodes<1>(first, of_first);
      s.add(0, of_first);
    } else {
      Pack m[12][3];
      to_nodes<2>(h, m);
      s.add(i, m);
    }
  }
}

Vec DerElasticity::spin(const Placement& p, In inertia) noexcept {
  Vec sum;
  const Edges& edges = place(p);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    sum = sum + (inertia[i] * edges[i].motion.spin.x) * edges[i].frame.e0;
  }
  return sum;
}

std::optional<Frame> DerElasticity::end_frame(const Placement& p) noexcept {
  const std::size_t last = edge_data_.size() - 1;
  const Vec e = load3(&p.z[3 * last + 3]) - load3(&p.z[3 * last]);
  return edge_frame(edge_data_[last].reference, e, theta(p.z, last));
}

double DerElasticity::energy(const Placement& p) noexcept {
  const Edges& edges = place(p);
  double sum = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double longer = edges[i].length - edge_data_[i].length;
    sum += edge_data_[i].stretch / 2 * longer * longer;
    if (joint(i) == nullptr) continue;
    const Vec& bent = edges[i].strain;
    sum += dot(joint(i)->stiffness, entrywise(bent, bent)) / 2;
  }
  return sum;
}

double DerElasticity::power(const Placement& p) noexcept {
  const Edges& edges = place(p);
  double sum = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (joint(i) == nullptr) continue;
    sum -= dot(joint(i)->friction, entrywise(edges[i].rate, edges[i].rate));
  }
  if (walled_) sum -= dot(edges[0].frame * edges[0].moment, p.root.omega);
  return sum;
}

bool DerElasticity::rebase(const RootPose& root, InOut z, InOut rate) {
  // The forces of the step have placed its joints near enough to count turns.
  if (latest_ == nullptr) place({root, z, rate});
  for (std::size_t i = 0; i < twist_.size(); ++i) twist_[i] = latest_->edges[i].twist;
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
  if (!replaced_.empty()) forget();
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

void DerElasticity::displace(const Displacement& by, InOut z, InOut rate) {
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    models::displace(by, load3(&z[3 * i + 3]) - load3(&z[3 * i]), edge_data_[i].reference,
                     rate[angles_ + i]);
  }
  forget();
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
  forget();
  for (std::size_t i = 0; i < edge_data_.size(); ++i) {
    edge_data_[i].reference = load9(&memory[9 * i]);
  }
  std::ranges::copy(memory.subspan(9 * edge_data_.size()), twist_.begin());
}

}  // namespace tress::models
