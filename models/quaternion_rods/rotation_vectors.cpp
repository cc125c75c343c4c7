#include "models/quaternion_rods/rotation_vectors.h"

#include <algorithm>
#include <cmath>

namespace tress::models {
namespace {

Quaternion conjugate(const Quaternion& q) { return {q.w, -1.0 * q.v}; }
Quaternion plus(const Quaternion& p, const Quaternion& q) {
  return {p.w + q.w, p.v + q.v};
}
Quaternion minus(const Quaternion& p, const Quaternion& q) { return plus(p, -1.0 * q); }

}  // namespace

RotationVectors::RotationVectors(std::unique_ptr<System> rod, std::size_t edges,
                                 double renewal, LinearKind solver)
    : rod_(std::move(rod)),
      strains_(natural_strains(*rod_)),
      accelerations_(point_accelerations(*rod_)),
      sections_(tress::sections(*rod_)),
      points_(rod_->material_points()),
      first_(static_cast<std::size_t>(rod_->layout().coordinates) - 4 * edges),
      renewal_(4 * std::tan(renewal / 4)),
      reference_(edges),
      rotations_(edges) {
  for (auto* x : {&q_, &v_, &a_, &force_, &free_, &origin_})
    x->resize(first_ + 4 * edges);
  rod_->initial_state(q_, v_);
  for (std::size_t e = 0; e < edges; ++e) {
    reference_[e] = load_quaternion(&q_[in_rod(e)]);
  }
  at_start_ = replaced_ = reference_;
  couple(rod_->sparse_form()->pattern());
  solver_ = make_definite_solver(solver, pattern_);
}

Quaternion RotationVectors::relative(In x, std::size_t edge) const {
  return conjugate(reference_[edge]) * load_quaternion(&x[in_rod(edge)]);
}

void RotationVectors::place(In q) noexcept {
  std::copy_n(q.begin(), first_, q_.begin());
  for (std::size_t e = 0; e < edges(); ++e) {
    rotations_[e] = ConformalRotation(load3(&q[at(e)]));
    store_quaternion(reference_[e] * rotations_[e].value(), &q_[in_rod(e)]);
  }
}

void RotationVectors::place(In q, In v) noexcept {
  place(q);
  std::copy_n(v.begin(), first_, v_.begin());
  for (std::size_t e = 0; e < edges(); ++e) {
    store_quaternion(reference_[e] * rotations_[e].slope(load3(&v[at(e)])),
                     &v_[in_rod(e)]);
  }
}

void RotationVectors::place(In q, In v, In a) noexcept {
  place(q, v);
  std::copy_n(a.begin(), first_, a_.begin());
  for (std::size_t e = 0; e < edges(); ++e) {
    const Vec rate = load3(&v[at(e)]);
    const Quaternion second =
        plus(rotations_[e].slope(load3(&a[at(e)])), rotations_[e].second(rate, rate));
    store_quaternion(reference_[e] * second, &a_[in_rod(e)]);
  }
}

void RotationVectors::pull_back(In from, Out to) const noexcept {
  std::copy_n(from.begin(), first_, to.begin());
  for (std::size_t e = 0; e < edges(); ++e) {
    store3(rotations_[e].pull_back(relative(from, e)), &to[at(e)]);
  }
}

void RotationVectors::rod_coordinates(In q, Out of_rod) {
  place(q);
  std::ranges::copy(q_, of_rod.begin());
}

void RotationVectors::initial_state(Out q, Out v) const {
  std::vector<double> of_rod(q_.size()), rate(of_rod);
  rod_->initial_state(of_rod, rate);
  std::copy_n(of_rod.begin(), first_, q.begin());
  std::copy_n(rate.begin(), first_, v.begin());
  for (std::size_t e = 0; e < edges(); ++e) {
    store3(Vec{}, &q[at(e)]);
    const Quaternion turning =
        conjugate(at_start_[e]) * load_quaternion(&rate[in_rod(e)]);
    store3(ConformalRotation().rate(turning), &v[at(e)]);
  }
}

void RotationVectors::scale(Out q_typ, Out v_typ) const {
  std::vector<double> of_rod(q_.size()), rate(of_rod);
  rod_->scale(of_rod, rate);
  for (const auto& [from, to] : {std::pair{&of_rod, q_typ}, {&rate, v_typ}}) {
    std::copy_n(from->begin(), first_, to.begin());
    for (std::size_t e = 0; e < edges(); ++e) {
      std::copy_n(&(*from)[in_rod(e)], 3, &to[at(e)]);
    }
  }
}

Status RotationVectors::residual(double t, In q, In v, In a, Out r) noexcept {
  place(q, v, a);
  const Status s = rod_->residual(t, q_, v_, a_, force_);
  pull_back(force_, r);
  return s;
}

Status RotationVectors::linearize(double t, In q, In v, In a, Weights w) noexcept {
  const Status s = values(t, q, v, a, w, values_);
  return s == Status::ok ? solver_->factor(values_) : s;
}

Status RotationVectors::solve(In b, Out x) noexcept {
  if (x.data() != b.data()) std::ranges::copy(b, x.begin());
  return solver_->solve(x);
}

/// M of a quaternion is a multiple of the unit matrix: of the acceleration of the rod
/// without constraints, the part tangential to norm 1 is that with them.
Status RotationVectors::acceleration(double t, In q, In v, Out a) noexcept {
  place(q, v);
  const Status s = rod_->explicit_form()->acceleration(t, q_, v_, free_);
  std::copy_n(free_.begin(), first_, a.begin());
  for (std::size_t e = 0; e < edges(); ++e) {
    const Vec rate = load3(&v[at(e)]);
    const Quaternion less = minus(relative(free_, e), rotations_[e].second(rate, rate));
    store3(rotations_[e].rate(less), &a[at(e)]);
  }
  return s;
}

void RotationVectors::take_stresses(double t, In q, Stresses stresses) noexcept {
  place(q);
  rod_->stress_form()->take_stresses(t, q_, stresses);
  std::ranges::copy(q_, origin_.begin());
  stresses_ = stresses;
}

bool RotationVectors::accept(double /*t*/, InOut q, InOut v) {
  bool far = false;
  for (std::size_t e = 0; e < edges(); ++e) {
    far = far || norm(load3(&q[at(e)])) > renewal_;
  }
  if (!far) return false;
  place(q, v);
  replaced_ = reference_;
  for (std::size_t e = 0; e < edges(); ++e) {
    const Quaternion now = load_quaternion(&q_[in_rod(e)]);
    reference_[e] = (1 / std::sqrt(dot(now, now))) * now;
    store3(Vec{}, &q[at(e)]);
    store3(ConformalRotation().rate(relative(v_, e)), &v[at(e)]);
  }
  return true;
}

bool RotationVectors::carry(double /*t*/, InOut q, InOut v, InOut a) const {
  for (std::size_t e = 0; e < edges(); ++e) {
    const ConformalRotation old(load3(&q[at(e)]));
    const Vec rate = load3(&v[at(e)]);
    Quaternion change = conjugate(reference_[e]) * replaced_[e];
    change = nearer(conjugate(old.value()), change);  // within half a turn
    const Vec c = ConformalRotation::vector(change * old.value());
    const ConformalRotation now(c);
    const Quaternion second =
        change * plus(old.slope(load3(&a[at(e)])), old.second(rate, rate));
    const Vec new_rate = now.rate(change * old.slope(rate));
    store3(c, &q[at(e)]);
    store3(new_rate, &v[at(e)]);
    store3(now.rate(minus(second, now.second(new_rate, new_rate))), &a[at(e)]);
  }
  return true;
}

double RotationVectors::next_teleport(double t) const {
  return teleports(*rod_)->next_teleport(t);
}

void RotationVectors::follow(double t) { teleports(*rod_)->follow(t); }

/// References turn with the rod, so that rotation vectors stay as they are.
void RotationVectors::teleport(double t, InOut q, InOut v) {
  place(q, v);
  const std::vector<double> before = q_;
  teleports(*rod_)->teleport(t, q_, v_);
  std::copy_n(q_.begin(), first_, q.begin());
  std::copy_n(v_.begin(), first_, v.begin());
  for (std::size_t e = 0; e < edges(); ++e) {
    const Quaternion turned = load_quaternion(&q_[in_rod(e)]) *
                              conjugate(load_quaternion(&before[in_rod(e)])) *
                              reference_[e];
    reference_[e] = (1 / std::sqrt(dot(turned, turned))) * turned;
    store3(rotations_[e].rate(relative(v_, e)), &v[at(e)]);
  }
}

std::vector<double> RotationVectors::memory() const {
  std::vector<double> all(4 * edges());
  for (std::size_t e = 0; e < edges(); ++e) store_quaternion(reference_[e], &all[4 * e]);
  return all;
}

void RotationVectors::recall(In memory) {
  for (std::size_t e = 0; e < edges(); ++e)
    reference_[e] = load_quaternion(&memory[4 * e]);
}

}  // namespace tress::models
