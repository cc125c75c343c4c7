#include "models/maximal/maximal_system.h"

#include <algorithm>
#include <numeric>

#include "linear/finite.h"
#include "linear/sparse_pattern.h"
#include "models/maximal/strand_elimination.h"

namespace tress::models {
namespace {

std::vector<int> coordinates_of(const NodeMean& mean) {
  std::vector<int> all(3 * static_cast<std::size_t>(mean.nodes));
  std::iota(all.begin(), all.end(), 3 * mean.first);
  return all;
}

std::vector<std::vector<int>> groups_of_mass(const MaximalStrand& strand) {
  std::vector<std::vector<int>> groups;
  for (const auto& point : strand.mass) groups.push_back(coordinates_of(point.at));
  return groups;
}

std::vector<NodeMean> places_of_mass(const MaximalStrand& strand) {
  std::vector<NodeMean> places;
  for (const auto& point : strand.mass) places.push_back(point.at);
  return places;
}

std::vector<std::vector<int>> groups_of_others(const MaximalStrand& strand) {
  std::vector<std::vector<int>> groups;
  for (std::size_t i = 3 * static_cast<std::size_t>(strand.nodes); i < strand.z.size();
       ++i) {
    groups.push_back({static_cast<int>(i)});
  }
  return groups;
}

void spread(const NodeMean& at, const Vec& force, InOut onto_nodes) {
  for (int k = 0; k < at.nodes; ++k) {
    double* f = &onto_nodes[3 * static_cast<std::size_t>(at.first + k)];
    store3(load3(f) + at.weight[static_cast<std::size_t>(k)] * force, f);
  }
}

/// Whether mass point i is node i.
bool nodal(const std::vector<MaximalStrand::MassPoint>& mass) {
  int node = 0;
  return std::ranges::all_of(mass, [&](const MaximalStrand::MassPoint& point) {
    return point.at.nodes == 1 && point.at.weight[0] == 1 && point.at.first == node++;
  });
}

}  // namespace

MaximalSystem::MaximalSystem(MaximalStrand strand)
    : strand_(std::move(strand)),
      held_contacts_(strand_.effects, strand_.mass.size(),
                     [this](double t, In q, In v) {
                       place(t, q, v);
                       return points(needs_);
                     }),
      needs_(needs(strand_.effects)),
      nodal_(nodal(strand_.mass)),
      elastic_(strand_.elasticity->groups(), static_cast<int>(held())),
      massive_(groups_of_mass(strand_), static_cast<int>(held())),
      inert_(groups_of_others(strand_), static_cast<int>(held())),
      directions_(places_of_mass(strand_), static_cast<int>(held())),
      origin_{{}, strand_.z},
      z_(strand_.z),
      rate_(strand_.rate),
      force_(z_.size()) {
  regular_mass_ =
      std::ranges::all_of(strand_.inertia, [](double inertia) { return inertia > 0; });
  build_pattern();
  solver_ = make_definite_solver(strand_.solver, pattern_);
  const std::size_t count = strand_.mass.size();
  for (auto* x : {&x_, &v_, &tangent_, &load_}) x->resize(3 * count);
  for (const auto& point : strand_.mass) {
    mass_.push_back(point.mass);
    length_.push_back(point.length);
    arc_.push_back(point.arc);
  }
  blocks_.resize(9 * count);
  scratch_.resize(static_cast<std::size_t>(pattern_.rows));
  // Constraints need the matrix, and directed loads couple neighbouring nodes. A solver
  // that is asked for by name solves the assembled equations.
  if (nodal_ && strand_.clamped && !strand_.constraints && !directed() &&
      strand_.solver == LinearKind::automatic) {
    elimination_ = strand_.elasticity->elimination();
  }
  if (!needs_.couplings) return;
  std::vector<Mean> means;
  for (const auto& point : strand_.mass) means.push_back(mean_of(point.at));
  coupled_solver_ = std::make_unique<CoupledSolver>(
      std::vector<const Pattern*>{&pattern_}, std::move(means));
}

void MaximalSystem::build_pattern() {
  std::vector<std::vector<int>> columns(z_.size() - held());
  for (const Groups* groups : {&elastic_, &massive_, &inert_}) groups->couple(columns);
  if (directed()) directions_.couple(columns);
  if (strand_.constraints) strand_.constraints->couple(columns);
  const auto rows = static_cast<int>(columns.size());
  pattern_ = pattern_of(rows, std::move(columns));
  for (Groups* groups : {&elastic_, &massive_, &inert_}) groups->bind(pattern_);
  if (directed()) directions_.bind(pattern_);
  if (strand_.constraints) strand_.constraints->bind(pattern_);
  values_.resize(static_cast<std::size_t>(pattern_.nonzeros()));
}

Layout MaximalSystem::layout() const {
  return {pattern_.rows, strand_.constraints ? strand_.constraints->rows() : 0};
}

Traits MaximalSystem::traits() const {
  return {.constant_mass = true, .regular_mass = regular_mass_};
}

void MaximalSystem::initial_state(Out q, Out v) const {
  std::ranges::copy(In(strand_.z).subspan(held()), q.begin());
  std::ranges::copy(In(strand_.rate).subspan(held()), v.begin());
}

void MaximalSystem::scale(Out q_typ, Out v_typ) const {
  std::ranges::copy(In(strand_.z_typ).subspan(held()), q_typ.begin());
  std::ranges::copy(In(strand_.z_rate).subspan(held()), v_typ.begin());
}

void MaximalSystem::look_at(double t) noexcept {
  if (t == pose_time_) return;
  pose_ = strand_.root.at(t);
  pose_time_ = t;
}

void MaximalSystem::take_stresses(double t, In q, Stresses stresses) noexcept {
  origin_.root = t == pose_time_ ? pose_ : strand_.root.at(t);
  std::ranges::copy(q, origin_.z.begin() + static_cast<std::ptrdiff_t>(held()));
  if (strand_.clamped) store3(origin_.root.x, origin_.z.data());
  origin_.stresses = stresses;
  displaced_ = true;
}

void MaximalSystem::place(double t, In q) noexcept {
  std::ranges::copy(q, z_.begin() + static_cast<std::ptrdiff_t>(held()));
  look_at(t);
  if (strand_.clamped) store3(pose_.x, z_.data());
}

void MaximalSystem::place(double t, In q, In v) noexcept {
  place(t, q);
  std::ranges::copy(v, rate_.begin() + static_cast<std::ptrdiff_t>(held()));
  if (strand_.clamped) store3(pose_.v, rate_.data());
}

Points MaximalSystem::points(Needs wanted) noexcept {
  Points p{static_cast<int>(mass_.size()), {}, {}, {}, mass_, length_};
  p.arc = arc_;
  p.longest = strand_.length;
  p.since = strand_.root.since;
  p.held = strand_.clamped && strand_.mass.front().at.nodes == 1 ? 1 : 0;
  const auto fill = [&](In of_nodes, std::vector<double>& to) {
    for (std::size_t i = 0; i < strand_.mass.size(); ++i) {
      store3(strand_.mass[i].at.of(of_nodes), &to[3 * i]);
    }
    return In(to);
  };
  if (wanted.position || wanted.tangent) p.x = fill(z_, x_);
  if (wanted.velocity) p.v = fill(rate_, v_);
  if (wanted.tangent) {
    directions_.tangents(x_, tangent_);
    p.tangent = tangent_;
  }
  return p;
}

/// load_ = loads of the effects on the mass points.
void MaximalSystem::loads(double t) noexcept {
  if (strand_.effects.empty()) return;
  std::ranges::fill(load_, 0.0);
  const Points p = points(needs_);
  for (const auto& effect : strand_.effects) effect->add_load(t, p, load_);
}

/// force_ = M z'' + dE/dz + friction - loads over all coordinates.
void MaximalSystem::forces(double t, In a) noexcept {
  std::ranges::fill(force_, 0.0);
  loads(t);
  for (std::size_t i = 0; i < strand_.mass.size(); ++i) {
    const auto& point = strand_.mass[i];
    const auto of_node = [&](std::size_t k) {
      const std::size_t node = 3 * (static_cast<std::size_t>(point.at.first) + k);
      return node < held() ? pose_.a : load3(&a[node - held()]);
    };
    if (nodal_) {
      store3(point.mass * of_node(0) - load3(&load_[3 * i]), &force_[3 * i]);
      continue;
    }
    Vec acceleration;
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.at.nodes); ++k) {
      acceleration = acceleration + point.at.weight[k] * of_node(k);
    }
    spread(point.at, point.mass * acceleration - load3(&load_[3 * i]), force_);
  }
  const std::size_t others = z_.size() - strand_.inertia.size();
  for (std::size_t i = 0; i < strand_.inertia.size(); ++i) {
    force_[others + i] += strand_.inertia[i] * a[others + i - held()];
  }
  strand_.elasticity->add_force(placement(), force_);
}

Status MaximalSystem::residual(double t, In q, In v, In a, Out r) noexcept {
  place(t, q, v);
  forces(t, a);
  std::ranges::copy(In(force_).subspan(held()), r.begin());
  return all_finite(r) ? Status::ok : Status::retry;
}

/// sum += w.acc M, and blocks_ of the effects as they stand.
void MaximalSystem::add_mass(Weights w, GroupSum& sum) noexcept {
  std::array<double, 144> matrix;  // of up to four nodes
  for (std::size_t i = 0; i < strand_.mass.size(); ++i) {
    const NodeMean& at = strand_.mass[i].at;
    double block[9];
    std::copy_n(&blocks_[9 * i], 9, block);
    for (const std::size_t k : {0, 4, 8}) block[k] += w.acc * mass_[i];
    const auto size = 3 * static_cast<std::size_t>(at.nodes);
    for (std::size_t r = 0; r < size; ++r) {
      for (std::size_t c = 0; c < size; ++c) {
        matrix[size * r + c] =
            at.weight[r / 3] * at.weight[c / 3] * block[3 * (r % 3) + c % 3];
      }
    }
    sum.add(i, matrix.data());
  }
}

/// s += change of the loads due to rotation of the tangents at points p. Overwrites
/// blocks_.
void MaximalSystem::add_directions(double t, const Points& p, double pos,
                                   Out s) noexcept {
  std::ranges::fill(blocks_, 0.0);
  for (const auto& effect : strand_.effects) {
    effect->add_direction_derivatives(t, p, -pos, blocks_);
  }
  directions_.add_tangent(x_, tangent_, blocks_, s);
}

/// blocks_ = derivatives of the loads. `coupled_apart`: without those of effects that
/// have couplings.
void MaximalSystem::find_blocks(double t, Weights w, bool coupled_apart) noexcept {
  if (!needs_.derivatives && !directed()) return;  // they are 0 for good
  std::ranges::fill(blocks_, 0.0);
  if (w.pos == 0 && w.vel == 0) return;
  const Points p = points(needs_);
  for (const auto& effect : strand_.effects) {
    if (coupled_apart && effect->needs().couplings) continue;
    effect->add_derivatives(t, p, -w.pos, -w.vel, blocks_);
  }
}

Status MaximalSystem::assemble(double t, In q, In v, Weights w, Out s,
                               bool coupled_apart) noexcept {
  place(t, q, v);
  std::ranges::fill(s, 0.0);
  find_blocks(t, w, coupled_apart);
  GroupSum of_mass(massive_, s), of_others(inert_, s), elastic(elastic_, s);
  add_mass(w, of_mass);
  for (std::size_t i = 0; i < strand_.inertia.size(); ++i) {
    const double inertia = w.acc * strand_.inertia[i];
    of_others.add(i, &inertia);
  }
  if (w.pos != 0 || w.vel != 0) {
    Placement here = placement();
    if (displaced_) here.origin = &origin_;
    strand_.elasticity->add_tangent(here, w.pos, w.vel, elastic);
  }
  displaced_ = false;
  if (directed() && w.pos != 0) add_directions(t, points(needs_), w.pos, s);
  return all_finite(s) ? Status::ok : Status::retry;
}

bool MaximalSystem::eliminate(double t, Weights w) noexcept {
  find_blocks(t, w, true);
  Placement here = placement();
  if (displaced_) here.origin = &origin_;
  const In blocks = needs_.derivatives ? In(blocks_) : In();
  if (!elimination_->factor(here, w, {mass_, strand_.inertia, blocks})) return false;
  displaced_ = false;
  return true;
}

Status MaximalSystem::linearize(double t, In q, In v, In, Weights w) noexcept {
  place(t, q, v);
  contacts_.clear();
  if (coupled_solver_) {
    const Points p = points(needs_);
    for (const auto& effect : strand_.effects) effect->add_couplings(t, p, contacts_);
  }
  eliminated_ = elimination_ != nullptr && contacts_.empty() && eliminate(t, w);
  if (eliminated_) return Status::ok;
  const Status s = assemble(t, q, v, w, values_, true);
  if (s != Status::ok) return s;
  if (contacts_.empty()) return solver_->factor(values_);
  coupled_solver_->touch(contacts_, points_of);
  coupled_solver_->clear();
  coupled_solver_->add(0, values_);
  for (const Coupling& contact : contacts_) coupled_solver_->add(contact, w);
  return coupled_solver_->factor();
}

Status MaximalSystem::solve(In b, Out x) noexcept {
  if (eliminated_) {
    elimination_->solve(b, x);
    return all_finite(x) ? Status::ok : Status::retry;
  }
  std::ranges::copy(b, x.begin());
  return contacts_.empty() ? solver_->solve(x) : coupled_solver_->solve(x);
}

bool MaximalSystem::accept(double t, InOut q, InOut v) {
  place(t, q, v);
  const bool smooth = strand_.elasticity->jumps().count == 0;
  const bool moved = strand_.elasticity->rebase(pose_, z_, rate_);
  if (smooth && strand_.elasticity->jumps().count > 0) jumped_at_ = t;
  if (!moved) return false;
  std::ranges::copy(In(z_).subspan(held()), q.begin());
  std::ranges::copy(In(rate_).subspan(held()), v.begin());
  return true;
}

std::string MaximalSystem::not_smooth() const {
  const Elasticity::Jumps jumps = strand_.elasticity->jumps();
  if (jumps.count == 0) return {};
  return "forces at joints jumped " + std::to_string(jumps.count) +
         " times, first at joint " + std::to_string(jumps.joint) +
         " at t = " + std::to_string(jumped_at_) +
         " s, where an angle lost its direction";
}

bool MaximalSystem::carry(double t, InOut q, InOut v, InOut a) const {
  std::array<std::vector<double>, 3> all;
  const RootPose root = strand_.root.at(t);
  const std::array of_root{root.x, root.v, root.a};
  const std::array motion{q, v, a};
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (strand_.clamped) all[k] = {of_root[k].x, of_root[k].y, of_root[k].z};
    all[k].insert(all[k].end(), motion[k].begin(), motion[k].end());
  }
  strand_.elasticity->carry(all[0], all[1], all[2]);
  for (std::size_t k = 0; k < all.size(); ++k) {
    std::ranges::copy(In(all[k]).subspan(held()), motion[k].begin());
  }
  return true;
}

void MaximalSystem::teleport(double t, InOut q, InOut v) {
  const Displacement by = displacement(strand_.root, t);
  place(just_before(t), q, v);
  for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(strand_.nodes); i += 3) {
    const Vec x = load3(&z_[i]);
    store3(by.velocity(x, load3(&rate_[i])), &rate_[i]);
    store3(by.place(x), &z_[i]);
  }
  strand_.elasticity->displace(by, z_, rate_);
  std::ranges::copy(In(z_).subspan(held()), q.begin());
  std::ranges::copy(In(rate_).subspan(held()), v.begin());
  follow(t);
}

void MaximalSystem::follow(double t) {
  strand_.root.since = t;
  pose_time_ = std::numeric_limits<double>::quiet_NaN();
  if (strand_.constraints) strand_.constraints->follow(t);
}

ExplicitForm* MaximalSystem::explicit_form() {
  return regular_mass_ && !strand_.constraints ? this : nullptr;
}

Status MaximalSystem::acceleration(double t, In q, In v, Out a) noexcept {
  std::ranges::fill(a, 0.0);
  const Status s = residual(t, q, v, a, scratch_);
  if (s != Status::ok) return s;
  if (!mass_solver_) {
    // M is constant: factored once.
    mass_solver_ = make_definite_solver(strand_.solver, pattern_);
    const Status mass = values(t, q, v, a, {1, 0, 0}, values_);
    if (mass != Status::ok) return mass;
    if (const Status f = mass_solver_->factor(values_); f != Status::ok) return f;
  }
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = -scratch_[i];
  return mass_solver_->solve(a);
}

}  // namespace tress::models
