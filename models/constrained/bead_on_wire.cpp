#include "models/constrained/bead_on_wire.h"

#include <cmath>

#include "contract/input_error.h"

namespace tress::models {

/// Position and motion of the bead; effects see x, u and tangent.
struct BeadOnWire::State {
  CurvePoint p;
  double x[3];
  double u[3];        // x' (m/s)
  double tangent[3];  // c'/|c'|

  /// Spans point into this state, so it must outlive them.
  Points points(const Setup& setup, Needs needs) const {
    Points seen;
    seen.count = 1;
    seen.x = x;
    if (needs.velocity) seen.v = u;
    if (needs.tangent) seen.tangent = tangent;
    seen.mass = {&setup.mass, 1};
    seen.length = {&setup.length, 1};
    return seen;
  }
};

BeadOnWire::BeadOnWire(Setup setup, Effects effects)
    : setup_(std::move(setup)), effects_(std::move(effects)), needs_(needs(effects_)) {
  const CurvePoint p = setup_.curve->at(setup_.start);
  const double metric = dot(p.d1, p.d1);
  if (!std::isfinite(setup_.mass) || setup_.mass <= 0 || !std::isfinite(metric) ||
      metric == 0) {
    throw InputError("mass is not positive or the curve stands still at the start",
                     "bead on wire", "give mass > 0 and a curve with c' != 0");
  }
}

void BeadOnWire::initial_state(Out q, Out v) const {
  const CurvePoint p = setup_.curve->at(setup_.start);
  q[0] = setup_.start;
  v[0] = setup_.start_speed / std::sqrt(dot(p.d1, p.d1));
}

void BeadOnWire::scale(Out q_typ, Out v_typ) const {
  q_typ[0] = 1;
  v_typ[0] = setup_.typical_speed / setup_.extent;
}

BeadOnWire::State BeadOnWire::state(In q, In v) const noexcept {
  State at;
  at.p = setup_.curve->at(q[0]);
  store3(at.p.c, at.x);
  store3(v[0] * at.p.d1, at.u);
  if (needs_.tangent)
    store3((1 / std::sqrt(dot(at.p.d1, at.p.d1))) * at.p.d1, at.tangent);
  return at;
}

Vec BeadOnWire::load(double t, const State& at) const noexcept {
  double f[3] = {};
  const Points p = at.points(setup_, needs_);
  for (const auto& effect : effects_) effect->add_load(t, p, f);
  return load3(f);
}

Status BeadOnWire::residual(double t, In q, In v, In a, Out r) noexcept {
  const State at = state(q, v);
  const Vec inertia = setup_.mass * (a[0] * at.p.d1 + v[0] * v[0] * at.p.d2);
  r[0] = dot(at.p.d1, inertia - load(t, at));
  return Status::ok;
}

double BeadOnWire::tangent(double t, In q, In v, In a, Weights w) const noexcept {
  const State at = state(q, v);
  const auto& [c, d1, d2, d3] = at.p;
  const double m = setup_.mass;
  double s = w.acc * m * dot(d1, d1);
  if (setup_.jacobian == Jacobian::exact) {
    s += w.vel * 2 * m * dot(d1, d2) * v[0];
    s += w.pos * m * (2 * dot(d1, d2) * a[0] + (dot(d2, d2) + dot(d1, d3)) * v[0] * v[0]);
  }
  s -= w.pos * dot(d2, load(t, at));
  if (!needs_.derivatives && !needs_.directions) return s;
  // d(load)/ds' = D_v c',  d(load)/ds = D_x c' + D_v c'' s' + D_t dt/ds, t = c'/|c'|
  const Points p = at.points(setup_, needs_);
  double by_place[9] = {};
  double by_velocity[9] = {};
  double by_tangent[9] = {};
  for (const auto& effect : effects_) {
    effect->add_derivatives(t, p, 1, 0, by_place);
    effect->add_derivatives(t, p, 0, 1, by_velocity);
    effect->add_direction_derivatives(t, p, 1, by_tangent);
  }
  const auto apply = [](const double* d, const Vec& u) {
    return Vec{dot(load3(d), u), dot(load3(d + 3), u), dot(load3(d + 6), u)};
  };
  s -= w.vel * dot(d1, apply(by_velocity, d1));
  s -= w.pos * dot(d1, apply(by_place, d1) + apply(by_velocity, v[0] * d2));
  const Vec turned = (1 / norm(d1)) * (d2 - (dot(d1, d2) / dot(d1, d1)) * d1);
  s -= w.pos * dot(d1, apply(by_tangent, turned));
  return s;
}

Status BeadOnWire::linearize(double t, In q, In v, In a, Weights w) noexcept {
  tangent_ = tangent(t, q, v, a, w);
  return tangent_ == 0 || !std::isfinite(tangent_) ? Status::retry : Status::ok;
}

Status BeadOnWire::solve(In b, Out x) noexcept {
  x[0] = b[0] / tangent_;
  return Status::ok;
}

Status BeadOnWire::values(double t, In q, In v, In a, Weights w, Out s) noexcept {
  s[0] = tangent(t, q, v, a, w);
  return Status::ok;
}

Status BeadOnWire::acceleration(double t, In q, In v, Out a) noexcept {
  const State at = state(q, v);
  const double metric = dot(at.p.d1, at.p.d1);
  if (metric == 0) return Status::retry;
  const double push = dot(at.p.d1, load(t, at)) / setup_.mass;
  a[0] = (push - v[0] * v[0] * dot(at.p.d1, at.p.d2)) / metric;
  return Status::ok;
}

Energy BeadOnWire::energy(double t, In q, In v) {
  const State at = state(q, v);
  const Points p = at.points(setup_, needs_);
  Energy energy;
  energy.kinetic = setup_.mass / 2 * dot(load3(at.u), load3(at.u));
  for (const auto& effect : effects_) energy.potential += effect->potential(t, p);
  return energy;
}

double BeadOnWire::power(double t, In q, In v) {
  const State at = state(q, v);
  const Points p = at.points(setup_, needs_);
  double sum = 0;
  for (const auto& effect : effects_) sum += effect->power(t, p);
  return sum;
}

void BeadOnWire::positions(double, In q, Out x) {
  store3(setup_.curve->at(q[0]).c, &x[0]);
}

void BeadOnWire::velocities(double, In q, In v, Out u) {
  store3(v[0] * setup_.curve->at(q[0]).d1, &u[0]);
}

}  // namespace tress::models
