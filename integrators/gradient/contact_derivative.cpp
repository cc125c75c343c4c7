#include "integrators/gradient/contact_derivative.h"

#include <algorithm>
#include <cmath>

#include "linear/finite.h"
#include "linear/largest_size.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Of a direction's length over System::scale, as ResidualDerivative.
constexpr double distance = 1e-5;
/// A point slides where its force of friction is that of the cone up to rounding.
constexpr double cone_rounding = 1e-12;

}  // namespace

ContactDerivative::ContactDerivative(Dynamics& dynamics,
                                     std::span<const VariedSystem> varied)
    : dynamics_(dynamics),
      varied_(varied),
      tracked_(dynamics.system().contact_form()->tracked()),
      own_(dynamics.system()),
      none_(size(dynamics.n())),
      q_(none_),
      v_(none_),
      q0_(none_),
      v0_(none_),
      x0_(tracked_),
      x_(tracked_) {
  for (const VariedSystem& one : varied) {
    auto& contacts = others_.emplace_back();
    for (const auto& system : one.systems) contacts.emplace_back(*system);
  }
}

void ContactDerivative::begin() {
  own_.let_go();
  for (auto& one : others_) {
    for (ClosedContacts& contacts : one) contacts.let_go();
  }
  cases_.clear();
}

bool ContactDerivative::hold(const WatchedSystem::Motion& end) {
  end_ = &end;
  own_.hold(end);
  bool all_same = find_cases();
  for (auto& one : others_) {
    for (ClosedContacts& contacts : one) {
      contacts.hold(end);
      all_same = all_same && contacts.same(own_);
    }
  }
  return all_same;
}

/// False: what the laws are about is not finite.
bool ContactDerivative::find_cases() {
  own_.values(end_->t, end_->q, end_->v, at_);
  cases_.clear();
  rows_ = 0;
  for (std::size_t k = 0; k < own_.count(); ++k) {
    const double* const f = &at_.f[3 * k];
    const double most = at_.mu[k] * f[0];
    const bool slides = most > 0 && std::hypot(f[1], f[2]) >= most * (1 - cone_rounding);
    cases_.push_back({own_[k].id, slides, own_[k].rebounds});
    rows_ += at_.mu[k] > 0 ? 3 : 1;
  }
  return all_finite(at_.u);
}

void ContactDerivative::combine(const Values& change, Out g) const {
  std::size_t row = 0;
  for (std::size_t k = 0; k < cases_.size(); ++k) {
    const double *u = &at_.u[3 * k], *f = &at_.f[3 * k];
    const double *du = &change.u[3 * k], *df = &change.f[3 * k];
    g[row++] = du[0];
    const double mu = at_.mu[k];
    if (mu == 0) continue;
    if (!cases_[k].slides) {
      g[row++] = du[1];
      g[row++] = du[2];
      continue;
    }
    const double size = std::hypot(f[1], f[2]);
    const double along[] = {f[1] / size, f[2] / size};
    const auto part = [&](const double* x) { return along[0] * x[1] + along[1] * x[2]; };
    const auto aside = [&](const double* x) { return along[0] * x[2] - along[1] * x[1]; };
    g[row++] = part(df) - change.mu[k] * f[0] - mu * df[0];
    g[row++] = std::hypot(u[1], u[2]) * aside(df) + mu * f[0] * aside(du);
  }
}

// Directions

/// By how much to go along it; 0: not at all.
double ContactDerivative::distance_along(const Direction& d) const {
  double length = 0;
  for (const In x : {d.q, d.q0}) {
    if (!x.empty()) length = std::max(length, scaled_norm(x, dynamics_.q_typ()));
  }
  for (const In x : {d.v, d.v0}) {
    if (!x.empty()) length = std::max(length, scaled_norm(x, dynamics_.v_typ()));
  }
  if (!d.x0.empty() && largest_size(d.x0) > 0) {
    length = std::max(length, largest_size(d.x0) / largest_size(end_->contact.x0));
  }
  return length > 0 ? distance / length : 0;
}

void ContactDerivative::hold_moved(double e, const Direction& d) {
  const WatchedSystem::Motion::Contact& from = end_->contact;
  shifted(q0_, from.q0, e, d.q0);
  shifted(v0_, from.v0, e, d.v0);
  shifted(x0_, from.x0, e, d.x0);
  own_.hold(*end_, q0_, v0_, x0_);
}

void ContactDerivative::values_moved(double e, const Direction& d, Values& found) {
  if (!d.q0.empty()) hold_moved(e, d);
  shifted(q_, end_->q, e, d.q);
  shifted(v_, end_->v, e, d.v);
  own_.values(end_->t, q_, v_, found);
  const bool same =
      std::ranges::all_of(cases_, [&, k = std::size_t{0}](const Case& one) mutable {
        return k < own_.count() && one.rebounds == own_[k++].rebounds;
      });
  if (!same) std::ranges::fill(found.u, std::nan(""));
}

void ContactDerivative::along(const Direction& d, Out g) {
  std::ranges::fill(g, 0.0);
  const double e = distance_along(d);
  if (e == 0) return;
  values_moved(e, d, plus_);
  values_moved(-e, d, minus_);
  if (!d.q0.empty()) own_.hold(*end_);
  change_.assign(cases_.size());
  change_.add(1 / (2 * e), plus_);
  change_.add(-1 / (2 * e), minus_);
  combine(change_, g);
}

void ContactDerivative::add_parameter(std::size_t k, Out g) {
  const Stencil& stencil = varied_[k].stencil;
  change_.assign(cases_.size());
  change_.add(stencil.base, at_);
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    others_[k][i].values(end_->t, end_->q, end_->v, plus_);
    change_.add(stencil.weight[i], plus_);
  }
  g_.resize(rows_);
  combine(change_, g_);
  add(g, 1, g_);
}

// Columns

void ContactDerivative::places(std::size_t k, In dq, Out dx) {
  std::ranges::fill(dx, 0.0);
  const WatchedSystem::Motion& from = *from_;
  const auto add_places = [&](double factor, System& system, In q) {
    system.contact_form()->places(from.t, q, from.v, x_);
    add(dx, factor, x_);
  };
  const double length = scaled_norm(dq, dynamics_.q_typ());
  if (length > 0) {
    for (const double e : {distance / length, -distance / length}) {
      shifted(q_, from.q, e, dq);
      add_places(1 / (2 * e), dynamics_.system(), q_);
    }
  }
  const Stencil& stencil = varied_[k].stencil;
  if (stencil.base != 0) add_places(stencil.base, dynamics_.system(), from.q);
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    add_places(stencil.weight[i], *varied_[k].systems[i], from.q);
  }
}

void ContactDerivative::begin_columns(In dq0, In dv0, In dx0) {
  dq0_.assign(dq0.begin(), dq0.end());
  dv0_.assign(dv0.begin(), dv0.end());
  dx0_.assign(dx0.begin(), dx0.end());
}

void ContactDerivative::laws(std::size_t k, In dq, In dv, Out g) {
  if (rows_ == 0) return;
  const std::size_t n = none_.size();
  along({dq, dv, In(dq0_).subspan(k * n, n), In(dv0_).subspan(k * n, n),
         In(dx0_).subspan(k * tracked_, tracked_)},
        g);
  add_parameter(k, g);
}

Status ContactDerivative::factor(Weights w) noexcept {
  w_ = w;
  if (rows_ == 0) return Status::ok;
  const std::size_t n = none_.size();
  std::vector<double> free(n), c(size(dynamics_.m())), dq(n), dv(n), g(rows_);
  const auto residual = [&](Out r) {
    return dynamics_.residual(end_->t, end_->q, end_->v, end_->a, end_->lambda, r, c);
  };
  own_.remove_forces();
  Status s = residual(free);
  responses_.assign(rows_ * n, 0.0);
  std::vector<double> equations(rows_ * rows_);
  std::size_t column = 0;
  for (std::size_t k = 0; k < cases_.size(); ++k) {
    const std::size_t components = at_.mu[k] > 0 ? 3 : 1;
    for (std::size_t j = 0; j < components && s == Status::ok; ++j, ++column) {
      const Out z = Out(responses_).subspan(column * n, n);
      own_.leave_unit(k, j);
      s = residual(z);
      if (s != Status::ok) break;
      add(z, -1, free);
      std::ranges::fill(c, 0.0);
      s = dynamics_.solve(z, c);
      change_.assign(cases_.size());
      change_.f[3 * k + j] = 1;
      const Out to = Out(equations).subspan(column * rows_, rows_);
      combine(change_, to);
      shifted(dq, none_, w.pos, z);
      shifted(dv, none_, w.vel, z);
      along({dq, dv, {}, {}, {}}, g);
      add(to, -1, g);
    }
  }
  own_.restore_forces();
  if (s != Status::ok) return s;
  return forces_.factor(equations, rows_) ? Status::ok : Status::retry;
}

void ContactDerivative::correct(In g, InOut x) {
  if (rows_ == 0) return;
  const std::size_t n = none_.size();
  std::vector<double> dq(n), dv(n), forces(rows_);
  shifted(dq, none_, w_.pos, x);
  shifted(dv, none_, w_.vel, x);
  along({dq, dv, {}, {}, {}}, forces);
  add(forces, -1, g);
  forces_.solve(forces);
  for (std::size_t j = 0; j < rows_; ++j) {
    add(x, forces[j], In(responses_).subspan(j * n, n));
  }
}

// Normal entries

void ContactDerivative::normal_along(double t, In q, double dt, In dq, Out dw) {
  std::ranges::fill(dw, 0.0);
  const double length = scaled_norm(dq, dynamics_.q_typ());
  if (length == 0) return;
  for (const double e : {distance / length, -distance / length}) {
    shifted(q_, q, e, dq);
    own_.values(t + e * dt, q_, none_, plus_);
    for (std::size_t k = 0; k < dw.size(); ++k) dw[k] += plus_.u[3 * k] / (2 * e);
  }
}

void ContactDerivative::normal_laws(std::size_t k, double t, In q, In dq, Out dw) {
  normal_along(t, q, 0, dq, dw);
  const Stencil& stencil = varied_[k].stencil;
  const auto add_entries = [&](double factor, ClosedContacts& of) {
    of.values(t, q, none_, plus_);
    for (std::size_t i = 0; i < dw.size(); ++i) dw[i] += factor * plus_.u[3 * i];
  };
  if (stencil.base != 0) add_entries(stencil.base, own_);
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    add_entries(stencil.weight[i], others_[k][i]);
  }
}

void ContactDerivative::normal_rates(double t, In q, In v, Out rate) {
  normal_along(t, q, 1, v, rate);
}

Status ContactDerivative::free_acceleration(double t, In q, In v, Out a) {
  own_.remove_forces();
  std::vector<double> lambda(size(dynamics_.m()));
  const Status s = dynamics_.accelerate(t, q, v, a, lambda);
  own_.restore_forces();
  return s;
}

}  // namespace tress::integrators
