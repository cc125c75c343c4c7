// The transposed elimination of der_elasticity.h.
#include <algorithm>

#include "math/instructions.h"
#include "models/maximal/der_elasticity.h"

namespace tress::models {

namespace {

Vec entry_products(const Vec& a, const Vec& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

}  // namespace

/// substitute() for S^T. Edge::sigma becomes what elimination leaves out of it, times
/// this solution. Returns the largest relative rotation.
double DerElasticity::substitute_transposed(double sign, InOut x) noexcept {
  Edges& edges = factored_.edges;
  Vec node, omega;
  double most = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    Edge& e = edges[i];
    const auto own = Exact::change_transposed(e, exact_factors_[i], i == 0, node, omega);
    const Vec relative = own.omega - e.turn.back(omega);
    omega = own.omega;
    e.relative = e.relative + sign * relative;
    e.lengthening += sign * own.sigma;
    e.sigma = dot(e.by_lengthening.own, relative);
    if (i > 0) edges[i - 1].sigma += dot(e.by_lengthening.before, relative);
    most = std::max(most, norm(relative));
    node = node + e.change(omega, own.sigma);
    store3(load3(&x[3 * i]) + sign * node, &x[3 * i]);
    x[3 * edges.size() + i] += sign * dot(e.p, omega);
  }
  return most;
}

/// With the corrections of correct().
TRESS_FLATTEN void DerElasticity::solve_transposed(In b, Out x) noexcept {
  constexpr double enough = 1e-9;
  constexpr int most_corrections = 8;
  Edges& edges = factored_.edges;
  for (Edge& e : edges) {
    e.relative = {};
    e.lengthening = 0;
  }
  std::ranges::fill(x, 0.0);
  double sign = 1, first = 0;
  for (int k = 0; k <= most_corrections; ++k) {
    Vec f_x, f_omega;
    for (std::size_t i = edges.size(); i-- > 0;) {
      const Edge& e = edges[i];
      const Vec force = k == 0 ? load3(&b[3 * i]) : Vec{};
      const double torque = k == 0 ? b[3 * edges.size() + i] : 0,
                   tension = k == 0 ? 0 : e.sigma;
      Exact::reduce_transposed(e, exact_factors_[i], force, torque * e.p, tension, f_x,
                               f_omega);
      f_omega = e.turn * f_omega;
    }
    const double left = substitute_transposed(sign, x);
    if (k == 0) first = left;
    if (!friction_ || !(left > enough * first)) return;
    sign = -sign;
  }
}

void DerElasticity::place_transposed(const Placement& p, In x) noexcept {
  place(p, {0, 0, 1}, factored_);
  Edges& edges = factored_.edges;
  Vec from, before;  // of the node, of the edge before
  for (std::size_t i = 0; i < edges.size(); ++i) {
    Edge& e = edges[i];
    const Vec to = load3(&x[3 * i]), along = to - from;
    const double two = -e.inverse_length * dot(along, e.frame.e2),
                 three = e.inverse_length * dot(along, e.frame.e1);
    const Vec omega{x[3 * edges.size() + i] - two * e.p.y - three * e.p.z, two, three};
    e.relative = omega - e.turn.back(before);
    e.lengthening = dot(along, e.frame.e0);
    before = omega;
    from = to;
  }
}

std::vector<double> DerElasticity::constants() const {
  std::vector<double> all = of_joints(joint_data_, &RodJoint::stiffness);
  const std::vector<double> rest = of_joints(joint_data_, &RodJoint::rest);
  all.insert(all.end(), rest.begin(), rest.end());
  for (const RodJoint& joint : joint_data_) all.push_back(joint.friction.x);
  for (const EdgeData& edge : edge_data_) all.push_back(edge.stretch);
  return all;
}

void DerElasticity::add_by_constants(InOut by) noexcept {
  const Edges& edges = factored_.edges;
  const std::size_t joints = joint_data_.size();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& e = edges[i];
    by[7 * joints + i] += (e.length - edge_data_[i].length) * e.lengthening;
    if (joint(i) == nullptr) continue;
    const auto j = static_cast<std::size_t>(joint(i) - joint_data_.data());
    const Vec change = e.strain_change();
    const auto add = [&](std::size_t at, const Vec& x) {
      store3(load3(&by[at]) + x, &by[at]);
    };
    add(3 * j, entry_products(e.strain, change));
    add(3 * (joints + j), -1.0 * entry_products(joint(i)->stiffness, change));
    by[6 * joints + j] += dot(e.rate, change);
  }
}

Vec DerElasticity::Edge::strain_change() const {
  const DerJoint<double> joint(turn);
  return {dot(joint.twist, relative), dot(joint.curvature1, relative),
          dot(joint.curvature2, relative)};
}

/// Friction alone depends on rates, and its derivative by them is symmetric.
TRESS_FLATTEN void DerElasticity::add_by_rates(InOut f) noexcept {
  if (!friction_) return;
  const Edges& edges = factored_.edges;
  Vec behind;  // moment of the joint behind an edge on that edge
  for (std::size_t i = edges.size(); i-- > 0;) {
    const Edge& e = edges[i];
    Vec moment;
    if (const RodJoint* of = joint(i); of != nullptr) {
      const DerJoint<double> strain(e.turn);
      const auto rubbed = [&](const Vec& slope) {
        return (of->friction.x * dot(slope, e.relative)) * slope;
      };
      moment =
          rubbed(strain.twist) + rubbed(strain.curvature1) + rubbed(strain.curvature2);
    }
    const Vec on_it = moment - behind;
    behind = e.turn * moment;
    Vec force = e.force_by(on_it) - e.tension * e.frame.e0;
    store3(load3(&f[3 * i]) - force, &f[3 * i]);
    store3(load3(&f[3 * i + 3]) + force, &f[3 * i + 3]);
    f[angles_ + i] += on_it.x;
  }
}

}  // namespace tress::models
