#include "models/effects/exact_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "contract/input_error.h"
#include "models/effects/obstacle.h"

namespace tress::models {
namespace {

// The first penalty, over the mass of a point per time: a free point is brought within a
// hundredth of the law by one solution, and stays well scaled beside its inertia.
constexpr double first_penalty = 100;
// Penalties rise by this where a solution has not brought the violation down by as much,
// up to a factor at which rounding errors of the gap still leave 1e-9 of a force.
constexpr double rise = 10, largest_rise = 1e5;

constexpr std::size_t per_point = 10;

// The law's solution does not depend on the penalty, but whether Newton's method finds
// one does, without a rule: where it has failed, these are tried in turn, over the first
// one.
constexpr std::array<double, 4> other_penalties = {1, 100, 10, 0.01};

// Before the points in values_: how the last solutions ended, the penalty over its first
// value, how often the multipliers were improved, and how many solutions have failed
// since the last that did not.
enum Header : std::size_t { phase, stiffer, improved, failed, header };
constexpr double not_begun = 0, unsettled = 1, settled = 2;  // of phase
// Errors of multipliers that fall by less are not of one kind.
constexpr double most_left = 0.5;
// Largest violation (m/s) after which what is left of gaps is due to the tolerance.
constexpr double settled_below = 1e-6;

// Of points that are looked at wherever they are, and of those that are not.
constexpr double everywhere = std::numeric_limits<double>::infinity();
constexpr double nowhere = -everywhere;

}  // namespace

ExactBody::ExactBody(BodyShape shape, const StrandPlace& place, const ExactContact& law,
                     std::optional<RootMotion> head)
    : body_(std::make_shared<RigidBody>(std::move(shape), place, law.compliance.offset,
                                        std::move(head))),
      law_(law) {
  check(law.compliance, law.friction);
  if (!(law.restitution >= 0 && law.restitution <= 1)) {
    throw InputError("its restitution is outside [0, 1]", "effect body",
                     "give a restitution from 0 to 1");
  }
  if (law.restitution > 0 && !law.rigid) {
    throw InputError("restitution belongs to a rigid surface", "effect body",
                     "set normal = \"rigid\", or damping_s_m for a compliant one");
  }
}

std::unique_ptr<Effect> ExactBody::for_strand(std::size_t points) const {
  auto own = std::make_unique<ExactBody>(*this);
  own->values_.assign(header + per_point * points, 0.0);
  own->penalties_.assign(points, {});
  own->open_.assign(points, true);
  own->rest_gaps_.assign(points, 0.0);
  own->taken_.assign(points, false);
  own->leaves_.assign(points, 0.0);
  own->change_.assign(points, {});
  own->change_before_.assign(points, {});
  return own;
}

std::shared_ptr<const Obstacle> ExactBody::obstacle() const {
  if (!law_.rigid || law_.restitution > 0) return {};
  return std::make_shared<Obstacle>(body_, law_.compliance.offset, law_.friction);
}

ExactContact::Penalty ExactBody::penalty(const Points& p, std::size_t point) const {
  ExactContact::Penalty own;
  if (!values_.empty()) own = penalties_[point];
  own.length = p.length[point];
  return own;
}

bool ExactBody::touchable(const Points& p, std::size_t point) {
  return point >= static_cast<std::size_t>(p.held) && p.length[point] > 0;
}

double ExactBody::reach(const Points& p, std::size_t point) const {
  if (!touchable(p, point)) return nowhere;
  return law_.reach(held(point), penalty(p, point));
}

HeldContact ExactBody::held(std::size_t point) const {
  if (values_.empty()) return {};
  const double* at = &values_[header + per_point * point];
  return {at[0], load3(at + 1), at[4], at[5], at[6], load3(at + 7)};
}

void ExactBody::hold(std::size_t point, const HeldContact& contact) {
  double* at = &values_[header + per_point * point];
  at[0] = contact.normal;
  store3(contact.tangential, at + 1);
  at[4] = contact.rest_gap;
  at[5] = contact.gap;
  at[6] = contact.leaves;
  store3(contact.slide, at + 7);
}

/// After a failure: the next one that is not the one of now.
double ExactBody::other_penalty() noexcept {
  const double now = values_[stiffer];
  double next = now;
  while (next == now) {
    const auto at = static_cast<std::size_t>(values_[failed]++);
    next = other_penalties[at % other_penalties.size()];
  }
  return next;
}

void ExactBody::set_penalties(const Points& p) noexcept {
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    penalties_[i].rho = values_[stiffer] * first_penalty * p.mass[i] / penalties_[i].tau;
  }
}

Vec ExactBody::place(const BodyPose& now, const Points& p, std::size_t point) {
  return now.frame.back(load3(&p.x[3 * point]) - now.x);
}

void ExactBody::places(double t, const Points& p, Out x) const noexcept {
  const BodyPose now = body_->pose(t, p.since);
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    store3(place(now, p, i), &x[3 * i]);
  }
}

void ExactBody::slides(double t, const Points& p, Out u) const noexcept {
  const BodyPose now = body_->pose(t, p.since);
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    const Vec surface = now.surface_velocity(load3(&p.x[3 * i]));
    const Vec along = now.frame.back(load3(&p.v[3 * i]) - surface);
    const HeldContact contact = held(i);
    store3(contact.normal > 0 ? contact.slide : along, &u[3 * i]);
  }
}

void ExactBody::begin(double t, double tau, const Points& p, In x0) noexcept {
  const double state = std::exchange(values_[phase], unsettled);
  const double improvements = std::exchange(values_[improved], 0.0);
  if (state == not_begun) {
    values_[stiffer] = 1;
  } else if (improvements == 0) {  // the last solution failed
    values_[stiffer] = other_penalty();
  } else {
    values_[failed] = 0;
    values_[stiffer] =
        std::max(1.0, improvements == 1 ? values_[stiffer] / rise : values_[stiffer]);
  }
  violation_ = 0;
  change_.assign(change_.size(), {});
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    open_[i] = held(i).normal == 0;
    leaves_[i] = held(i).leaves;
    rest_gaps_[i] = held(i).rest_gap;
    penalties_[i] = {};
    penalties_[i].tau = tau;
    penalties_[i].from = load3(&x0[3 * i]);
  }
  set_penalties(p);
  if (!law_.rigid) return;
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    HeldContact contact = held(i);
    if (!open_[i] && state == settled) contact.rest_gap = contact.gap;
    if (open_[i]) contact.rest_gap = 0;  // unless it overlaps still, below
    hold(i, contact);
  }
  body_->for_near<RigidBody::With::velocity>(
      body_->pose(t - tau, p.since), p,
      [&](std::size_t) {
        return law_.restitution > 0 ? everywhere : law_.compliance.offset;
      },
      [&](const RigidBody::Near& at) {
        const double gap = at.to.value - law_.compliance.offset;
        if (open_[at.point]) {
          HeldContact contact = held(at.point);
          const double deepest = state == not_begun ? gap : rest_gaps_[at.point];
          contact.rest_gap = std::min(0.0, std::max(deepest, gap));
          hold(at.point, contact);
        }
        const double away = dot(at.to.gradient, at.u);
        if (law_.restitution > 0 && away < 0 && gap + tau * away < 0) {
          penalties_[at.point].rebound = -law_.restitution * away;
        }
      });
}

double ExactBody::improve(double t, const Points& p) noexcept {
  const double before = violation_;
  violation_ = 0;
  ++values_[improved];
  std::size_t next = 0;
  change_.swap(change_before_);
  const auto take = [&](std::size_t point, const HeldContact& found) {
    const HeldContact was = held(point);
    change_[point] = {found.normal - was.normal, found.tangential - was.tangential};
    hold(point, found);
  };
  const BodyPose now = body_->pose(t, p.since);
  const auto slide = [&](std::size_t point) {
    const ExactContact::Penalty& from = penalties_[point];
    return (1 / from.tau) * (place(now, p, point) - from.from);
  };
  const auto open_until = [&](std::size_t point) {  // what is out of reach holds nothing
    for (; next < point; ++next)
      take(next, {0, {}, std::min(0.0, held(next).rest_gap), 0, 0, slide(next)});
  };
  for_touching<RigidBody::With::velocity>(
      now, p, [&](const RigidBody::Near& at, const ExactContact::State& state) {
        open_until(at.point);
        next = at.point + 1;
        violation_ = std::max(violation_, state.violation());
        take(at.point, {state.normal(), state.tangential(), held(at.point).rest_gap,
                        state.gap(), held(at.point).leaves, state.along()});
      });
  open_until(penalties_.size());
  if (violation_ <= settled_below) values_[phase] = settled;
  if (before > 0 && violation_ > before / rise && values_[stiffer] < largest_rise) {
    values_[stiffer] *= rise;
    set_penalties(p);
    leaves_.assign(leaves_.size(), 0.0);
    change_.assign(change_.size(), {});
  }
  return violation_;
}

double ExactBody::drive() const noexcept {
  double fastest = 0;
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    const HeldContact contact = held(i);
    const double most = law_.friction * contact.normal;
    if (!(most > 0)) continue;
    fastest = std::max(fastest, dot(contact.tangential, contact.slide) / most);
  }
  return fastest;
}

/// Extrapolates the multipliers. An improvement leaves a part r of the error of a
/// contact's multipliers, which depends on the contact's stiffness. Where lambda became
/// f, the law is satisfied near f + r/(1 - r) (f - lambda) [Aitken's process]. If the
/// second of two changes of multipliers is s times the first, r is s (1 - r) more than
/// was assumed between them. The first r of a step is kept for later ones, whose errors
/// are smaller.
void ExactBody::extrapolate() noexcept {
  for (std::size_t i = 0; i < change_.size(); ++i) {
    HeldContact contact = held(i);
    if (contact.normal == 0) continue;
    const Change& now = change_[i];
    const double size = change_before_[i].times(change_before_[i]);
    double& r = leaves_[i];
    if (size > 0) {
      const double s = now.times(change_before_[i]) / size;
      const double more = r + s * (1 - r);
      const bool first = r == 0;
      r = std::abs(s) < most_left && more > 0 && more < most_left ? more : 0;
      if (first) contact.leaves = r;
    }
    const double further = r / (1 - r);
    contact.normal = std::max(0.0, contact.normal + further * now.normal);
    contact.tangential = contact.tangential + further * now.tangential;
    hold(i, contact);
  }
}

double ExactBody::approach(double t, const Points& p) noexcept {
  if (!law_.rigid) return 0;
  double fastest = 0;
  body_->for_near<RigidBody::With::velocity>(
      body_->pose(t, p.since), p,
      [&](std::size_t point) { return held(point).normal > 0 ? everywhere : nowhere; },
      [&](const RigidBody::Near& at) {
        fastest = std::max(fastest, -dot(at.to.gradient, at.u));
      });
  return fastest;
}

/// The least force marks a closed contact.
void ExactBody::release() noexcept {
  for (std::size_t i = 0; i < penalties_.size(); ++i) {
    HeldContact contact = held(i);
    contact.normal = contact.normal > 0 ? std::numeric_limits<double>::min() : 0;
    contact.tangential = {};
    hold(i, contact);
    penalties_[i] = {};
  }
}

void ExactBody::take(double t, const Points& p) noexcept {
  for (ExactContact::Penalty& penalty : penalties_) penalty.rho = 0;
  body_->for_near<RigidBody::With::position>(
      body_->pose(t, p.since), p,
      [&](std::size_t point) {
        if (taken_[point] || !touchable(p, point)) return nowhere;
        const HeldContact contact = held(point);
        if (contact.normal > 0 || penalties_[point].rebound) return everywhere;
        return law_.compliance.offset + contact.rest_gap;
      },
      [&](const RigidBody::Near& at) { taken_[at.point] = true; });
}

void ExactBody::touches(double t, const Points& p,
                        std::vector<RigidTouch>& to) const noexcept {
  const BodyPose now = body_->pose(t, p.since);
  body_->for_near<RigidBody::With::velocity>(
      now, p, [&](std::size_t point) { return taken_[point] ? everywhere : nowhere; },
      [&](const RigidBody::Near& at) {
        const HeldContact contact = held(at.point);
        const ExactContact::Penalty penalty = this->penalty(p, at.point);
        const ExactContact::State state(law_, contact, penalty, at.to, at.x, at.u);
        to.push_back({at.point, now.frame * state.outwards(), now.frame * state.excess(),
                      now.frame * state.load(), law_.friction});
      });
}

void ExactBody::set_force(double t, double since, std::size_t point, double normal,
                          const Vec& tangential) noexcept {
  HeldContact contact = held(point);
  contact.normal = normal;
  contact.tangential = body_->pose(t, since).frame.back(tangential);
  hold(point, contact);
}

void ExactBody::give_back(const Points& p) noexcept {
  taken_.assign(taken_.size(), false);
  set_penalties(p);
}

template <RigidBody::With with, class See>
void ExactBody::for_touching(const BodyPose& now, const Points& p, See see) const {
  body_->for_near<with>(
      now, p, [&](std::size_t point) { return reach(p, point); },
      [&](const RigidBody::Near& at) {
        const HeldContact contact = held(at.point);
        const ExactContact::Penalty penalty = this->penalty(p, at.point);
        see(at, ExactContact::State(law_, contact, penalty, at.to, at.x, at.u));
      });
}

void ExactBody::add_load(double t, const Points& p, InOut f) const noexcept {
  const BodyPose now = body_->pose(t, p.since);
  for_touching<RigidBody::With::velocity>(
      now, p, [&](const RigidBody::Near& at, const ExactContact::State& state) {
        double* load = &f[3 * at.point];
        store3(load3(load) + now.frame * state.load(), load);
      });
}

void ExactBody::add_derivatives(double t, const Points& p, double pos, double vel,
                                InOut blocks) const noexcept {
  const BodyPose now = body_->pose(t, p.since);
  const Mat3 spin = cross_matrix(now.frame.back(now.omega));
  for_touching<RigidBody::With::curvature>(
      now, p, [&](const RigidBody::Near& at, const ExactContact::State& state) {
        const auto [by_x, by_u] = state.slopes(at.curvature);
        const Mat3 block = pos * (by_x - by_u * spin) + vel * by_u;  // as in Body
        add9(turned(now.frame, block), &blocks[9 * at.point]);
      });
}

double ExactBody::potential(double t, const Points& p) const noexcept {
  if (law_.rigid) return 0;
  double sum = 0;
  body_->for_near<RigidBody::With::position>(
      body_->pose(t, p.since), p, [&](std::size_t) { return law_.compliance.offset; },
      [&](const RigidBody::Near& at) {
        sum += p.length[at.point] * law_.compliance.energy(at.to);
      });
  return sum;
}

double ExactBody::power(double t, const Points& p) const noexcept {
  const BodyPose now = body_->pose(t, p.since);
  double sum = 0;
  for_touching<RigidBody::With::velocity>(
      now, p, [&](const RigidBody::Near& at, const ExactContact::State& state) {
        const Vec v = now.frame.back(load3(&p.v[3 * at.point]));
        sum += dot(state.load(), v);
        if (law_.rigid) return;
        sum -= p.length[at.point] * dot(law_.compliance.elastic_load(at.to), at.u);
      });
  return sum;
}

}  // namespace tress::models
