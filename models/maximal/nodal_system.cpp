#include "models/maximal/nodal_system.h"

#include <algorithm>
#include <numeric>

#include "linear/finite.h"
#include "linear/sparse_pattern.h"
#include "models/strand/not_finite.h"

namespace tress::models {
namespace {

/// A fourth difference couples a joint with two on either side.
constexpr int reach = 2;

Pattern pattern(int joints, Jacobian jacobian) {
  const int n = 3 * joints;
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(n));
  for (int j = 0; j < n; ++j) {
    std::vector<int>& column = columns[static_cast<std::size_t>(j)];
    if (jacobian == Jacobian::exact) {
      column.resize(static_cast<std::size_t>(n));
      std::iota(column.begin(), column.end(), 0);
    } else {  // twist and curvatures do not mix
      for (int i = j - 3 * reach; i <= j + 3 * reach; i += 3) {
        if (i >= 0 && i < n) column.push_back(i);
      }
    }
  }
  return pattern_of(n, std::move(columns));
}

/// (block) x, row-major.
template <class T>
Vec3<T> times(const double* block, const Vec3<T>& x) {
  return {block[0] * x.x + block[1] * x.y + block[2] * x.z,
          block[3] * x.x + block[4] * x.y + block[5] * x.z,
          block[6] * x.x + block[7] * x.y + block[8] * x.z};
}

/// The derivatives of x without its value.
template <class Number>
Vec3<Number> variation(Vec3<Number> x) {
  for (Number* part : {&x.x, &x.y, &x.z}) part->value = 0;
  return x;
}

/// The edge whose direction a node has.
std::size_t edge_of(std::size_t node, std::size_t nodes) {
  return std::min(node, nodes - 2);
}

}  // namespace

NodalSystem::NodalSystem(NodalParts parts)
    : parts_(std::move(parts)),
      held_contacts_(parts_.effects, parts_.rod.mass.size(),
                     [this](double t, In q, In v) {
                       place(t, q, v);
                       return points(needs_);
                     }),
      needs_(needs(parts_.effects)),
      motion_(parts_.rod),
      moved_(parts_.rod),
      pattern_(pattern(static_cast<int>(parts_.rod.edges()), parts_.jacobian)) {
  const std::size_t n = parts_.start.size(), nodes = motion_.x.size();
  for (auto* numbers : {&q_, &v_, &a_}) numbers->resize(n);
  for (auto* x : {&x_, &u_, &tangent_, &load_}) x->resize(3 * nodes);
  for (auto* slopes : {&load_by_x_, &load_by_v_, &load_by_t_}) slopes->resize(9 * nodes);
  zero_.resize(n);
  values_.resize(static_cast<std::size_t>(pattern_.nonzeros()));
  const bool dense = parts_.jacobian == Jacobian::exact;
  solver_ =
      make_linear_solver(dense ? LinearKind::dense : LinearKind::automatic, pattern_);
  if (!dense) find_leading_terms();
}

void NodalSystem::initial_state(Out q, Out v) const {
  std::ranges::copy(parts_.start, q.begin());
  std::ranges::fill(v, 0.0);
}

void NodalSystem::scale(Out q_typ, Out v_typ) const {
  std::ranges::fill(q_typ, parts_.curvature);
  std::ranges::fill(v_typ, parts_.curvature * parts_.rate);
}

void NodalSystem::place(double t, In q, In v) noexcept {
  pose_ = parts_.root.at(t);
  motion_.place(parts_.rod, pose_, q, v);
}

Points NodalSystem::points(Needs wanted) noexcept {
  Points p{count(), {}, {}, {}, parts_.rod.mass, parts_.node_length};
  p.held = 2;  // the first edge is clamped
  p.arc = parts_.node_arc;
  p.longest = parts_.node_arc.back();
  p.since = parts_.root.since;
  const std::size_t nodes = motion_.x.size();
  const auto fill = [nodes](std::vector<double>& to, auto&& of_node) {
    for (std::size_t i = 0; i < nodes; ++i) store3(of_node(i), &to[3 * i]);
    return In(to);
  };
  if (wanted.position) p.x = fill(x_, [this](std::size_t i) { return motion_.x[i]; });
  if (wanted.velocity) p.v = fill(u_, [this](std::size_t i) { return motion_.v[i]; });
  if (wanted.tangent) {
    p.tangent = fill(tangent_, [this, nodes](std::size_t i) {
      return motion_.tangent(edge_of(i, nodes));
    });
  }
  return p;
}

/// Loads of the effects on the nodes as they are placed.
void NodalSystem::load(double t) noexcept {
  if (parts_.effects.empty()) return;
  const Points p = points(needs_);
  std::ranges::fill(load_, 0.0);
  for (const auto& effect : parts_.effects) effect->add_load(t, p, load_);
  for (std::size_t i = 0; i < motion_.load.size(); ++i) {
    motion_.load[i] = load3(&load_[3 * i]);
  }
}

void NodalSystem::load_slopes(double t) noexcept {
  if (!needs_.derivatives && !needs_.directions) return;
  const Points p = points(needs_);
  std::ranges::fill(load_by_x_, 0.0);
  std::ranges::fill(load_by_v_, 0.0);
  std::ranges::fill(load_by_t_, 0.0);
  for (const auto& effect : parts_.effects) {
    effect->add_derivatives(t, p, 1, 0, load_by_x_);
    effect->add_derivatives(t, p, 0, 1, load_by_v_);
    if (needs_.directions) effect->add_direction_derivatives(t, p, 1, load_by_t_);
  }
}

Status NodalSystem::acceleration(double t, In q, In v, Out a) noexcept {
  place(t, q, v);
  load(t);
  motion_.accelerate(parts_.rod, pose_, a);
  return all_finite(a) ? Status::ok : Status::retry;
}

Status NodalSystem::residual(double t, In q, In v, In a, Out r) noexcept {
  const Status s = acceleration(t, q, v, r);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = a[i] - r[i];
  return s;
}

/// a_ of q_ and v_, with the loads and slopes as they stand.
void NodalSystem::differentiate(const StaggeredRod& rod, const RootPose& root) noexcept {
  moved_.place(rod, root, std::span<const Number>(q_), std::span<const Number>(v_));
  for (std::size_t i = 0; i < moved_.load.size(); ++i) {
    moved_.load[i] = Vec3<Number>(motion_.load[i]) +
                     times(&load_by_x_[9 * i], variation(moved_.x[i])) +
                     times(&load_by_v_[9 * i], variation(moved_.v[i]));
  }
  if (needs_.directions) {
    for (std::size_t i = 0, nodes = moved_.load.size(); i < nodes; ++i) {
      const Vec3<Number> turned = variation(moved_.tangent(edge_of(i, nodes)));
      moved_.load[i] = moved_.load[i] + times(&load_by_t_[9 * i], turned);
    }
  }
  moved_.accelerate(rod, root, std::span(a_));
}

void NodalSystem::exact_tangent(double t, In q, In v, Weights w) noexcept {
  place(t, q, v);
  load(t);
  load_slopes(t);
  const std::size_t n = q.size();
  std::ranges::copy(q, q_.begin());
  std::ranges::copy(v, v_.begin());
  for (std::size_t first = 0; first < n; first += directions) {
    const std::size_t last = std::min(first + directions, n);
    for (std::size_t j = first; j < last; ++j) {
      q_[j].part[j - first] = w.pos;
      v_[j].part[j - first] = w.vel;
    }
    differentiate(parts_.rod, pose_);
    for (std::size_t j = first; j < last; ++j) {
      double* column = &values_[n * j];
      for (std::size_t i = 0; i < n; ++i) column[i] = -a_[i].part[j - first];
      column[j] += w.acc;
      q_[j] = q[j];
      v_[j] = v[j];
    }
  }
}

/// The linear equations of the straight strand at rest without loads. Joints five apart
/// share no equation: one direction of derivatives serves them all.
void NodalSystem::find_leading_terms() {
  StaggeredRod straight = parts_.rod;
  for (RodJoint& joint : straight.joints) joint.rest = {};
  const std::size_t n = q_.size();
  constexpr std::size_t period = 3 * (2 * reach + 1);
  leading_by_q_.resize(values_.size());
  leading_by_v_.resize(values_.size());
  for (const bool rates : {false, true}) {
    std::vector<double>& leading = rates ? leading_by_v_ : leading_by_q_;
    for (std::size_t first = 0; first < period; first += directions) {
      const auto direction = [first](std::size_t j) { return j % period - first; };
      std::ranges::fill(q_, Number(0.0));
      std::ranges::fill(v_, Number(0.0));
      for (std::size_t j = 0; j < n; ++j) {
        if (direction(j) < directions) (rates ? v_ : q_)[j].part[direction(j)] = 1;
      }
      differentiate(straight, RootPose{});
      for (std::size_t j = 0; j < n; ++j) {
        if (direction(j) >= directions) continue;
        for (int k = pattern_.start[j]; k < pattern_.start[j + 1]; ++k) {
          const auto place = static_cast<std::size_t>(k);
          const auto row = static_cast<std::size_t>(pattern_.row[place]);
          leading[place] = -a_[row].part[direction(j)];
        }
      }
    }
  }
}

/// Factors the constant stiff tangent; repeats that for other weights only.
Status NodalSystem::stiff_tangent(Weights w) noexcept {
  const Weights& last = factored_;
  if (w.acc == last.acc && w.vel == last.vel && w.pos == last.pos) return Status::ok;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    values_[k] = w.pos * leading_by_q_[k] + w.vel * leading_by_v_[k];
  }
  for (std::size_t j = 0; j < q_.size(); ++j) {
    const auto column = pattern_.row.begin();
    const auto diagonal = std::lower_bound(
        column + pattern_.start[j], column + pattern_.start[j + 1], static_cast<int>(j));
    values_[static_cast<std::size_t>(diagonal - column)] += w.acc;
  }
  const Status s = solver_->factor(values_);
  factored_ = s == Status::ok ? w : Weights{};
  return s;
}

Status NodalSystem::linearize(double t, In q, In v, In, Weights w) noexcept {
  if (parts_.jacobian == Jacobian::elastic) return stiff_tangent(w);
  exact_tangent(t, q, v, w);
  return all_finite(values_) ? solver_->factor(values_) : Status::retry;
}

Status NodalSystem::solve(In b, Out x) noexcept {
  std::ranges::copy(b, x.begin());
  return solver_->solve(x);
}

Energy NodalSystem::energy(double t, In q, In v) {
  place(t, q, v);
  const StaggeredRod& rod = parts_.rod;
  Energy e;
  for (std::size_t i = 0; i < rod.mass.size(); ++i) {
    e.kinetic += rod.mass[i] / 2 * dot(motion_.v[i], motion_.v[i]);
  }
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    e.kinetic += rod.rotor[j] / 2 * motion_.roll(j) * motion_.roll(j);
    const Vec strain = motion_.strain(j) - rod.joints[j].rest;
    const Vec& k = rod.joints[j].stiffness;
    e.potential += (k.x * strain.x * strain.x + k.y * strain.y * strain.y +
                    k.z * strain.z * strain.z) /
                   2;
  }
  const Points p =
      points({.position = true, .velocity = true, .tangent = needs_.tangent});
  for (const auto& effect : parts_.effects) e.potential += effect->potential(t, p);
  return e;
}

double NodalSystem::power(double t, In q, In v) {
  std::vector<double> a(q.size());
  if (acceleration(t, q, v, a) != Status::ok) return std::nan("");
  const StaggeredRod& rod = parts_.rod;
  double sum = 0;
  for (std::size_t j = 0; j < rod.edges(); ++j) {
    const Vec &rate = motion_.strain_rate(j), &c = rod.joints[j].friction;
    sum -= c.x * rate.x * rate.x + c.y * rate.y * rate.y + c.z * rate.z * rate.z;
  }
  const Points p =
      points({.position = true, .velocity = true, .tangent = needs_.tangent});
  for (const auto& effect : parts_.effects) sum += effect->power(t, p);
  // The clamp moves node 0 on its path and rotates against the moment of joint 0.
  const Vec force = rod.mass[0] * pose_.a - motion_.load[0] - motion_.root_force();
  return sum + dot(force, pose_.v) -
         dot(pose_.frame * motion_.root_moment(), pose_.omega);
}

void NodalSystem::positions(double t, In q, Out x) {
  place(t, q, zero_);
  for (std::size_t i = 0; i < motion_.x.size(); ++i) store3(motion_.x[i], &x[3 * i]);
}

void NodalSystem::velocities(double t, In q, In v, Out u) {
  place(t, q, v);
  for (std::size_t i = 0; i < motion_.v.size(); ++i) store3(motion_.v[i], &u[3 * i]);
}

std::string NodalSystem::not_finite(double t, In q, In v) {
  const auto of_joints = [](In x, std::string_view what) {
    return not_finite_place(x, 3, std::string(what) + " of element");
  };
  return first_words([&] { return of_joints(q, "coordinates"); },
                     [&] { return of_joints(v, "rates"); },
                     [&] {
                       place(t, q, v);
                       return not_finite_clamp(pose_.x, pose_.v, pose_.a);
                     },
                     [&] { return not_finite_load(parts_.effects, t, points(needs_)); },
                     [&] {  // tension couples all entries: one does not locate the cause
                       std::vector<double> a(q.size());
                       static_cast<void>(acceleration(t, q, v, a));
                       return of_joints(a, "inertia or elasticity");
                     });
}

}  // namespace tress::models
