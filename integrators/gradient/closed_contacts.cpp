#include "integrators/gradient/closed_contacts.h"

#include <algorithm>
#include <cmath>

#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Of bodies.
constexpr double largest_friction = 1000;

}  // namespace

void ClosedContacts::Values::assign(std::size_t contacts) {
  u.assign(3 * contacts, 0.0);
  f.assign(3 * contacts, 0.0);
  mu.assign(contacts, 0.0);
}

void ClosedContacts::Values::add(double factor, const Values& other) {
  tress::add(u, factor, other.u);
  tress::add(f, factor, other.f);
  tress::add(mu, factor, other.mu);
}

ClosedContacts::ClosedContacts(System& system)
    : form_(*system.contact_form()),
      v_typ_(static_cast<std::size_t>(system.layout().coordinates)),
      law_(*form_.complementarity()) {
  std::vector<double> q_typ(v_typ_.size());
  system.scale(q_typ, v_typ_);
}

void ClosedContacts::hold(const WatchedSystem::Motion& end) {
  hold(end, end.contact.q0, end.contact.v0, end.contact.x0);
}

/// The multipliers are those of the solution before take(), which makes them constant.
void ClosedContacts::hold(const WatchedSystem::Motion& end, In q0, In v0, In x0) {
  let_go();
  form_.set_multipliers(end.contact.multipliers);
  form_.begin(end.t, end.contact.tau, q0, v0, x0);
  form_.set_multipliers(end.contact.multipliers);
  forces_.resize(3 * law_.take(end.t, end.q, end.v, end.q, end.v));
  law_.forces(forces_);
  held_ = true;
  closed_.clear();
  index_.clear();
  for (std::size_t i = 0; 3 * i < forces_.size(); ++i) {
    if (!(forces_[3 * i] > 0)) continue;
    index_.push_back(i);
    closed_.push_back({});
  }
  if (closed_.empty()) return;
  find_frictions();
  find_multipliers();
  if (form_.rebounds()) find_rebounds(end);
}

/// The friction over the pressure of contacts of unit compliance, that are pressed with
/// 1 N and slide faster than friction stops.
void ClosedContacts::find_frictions() {
  constexpr double exactly = 1e-15;
  const std::size_t n = forces_.size();
  std::vector<double> w(n * n), u(n), f(n);
  for (std::size_t i = 0; i < n; ++i) w[i * n + i] = 1;
  for (std::size_t i = 0; i < n; i += 3) {
    u[i] = -1;
    u[i + 1] = 2 * largest_friction;
  }
  law_.balance(w, u, exactly, f);
  for (std::size_t k = 0; k < count(); ++k) {
    const double* const own = &f[3 * index_[k]];
    closed_[k].friction = std::hypot(own[1], own[2]) / own[0];
  }
}

/// The places of the normal forces among the multipliers, which change with them.
void ClosedContacts::find_multipliers() {
  given_ = forces_;
  for (std::size_t i = 0; i < given_.size(); i += 3) given_[i] *= 2;
  restore_forces();
  const std::vector<double> before = form_.multipliers();
  law_.set_forces(given_);
  const std::vector<double> after = form_.multipliers();
  restore_forces();
  std::size_t k = 0;
  for (std::size_t i = 0; i < before.size() && k < count(); ++i) {
    if (before[i] != after[i]) closed_[k++].id = i;
  }
}

/// The law of a rebound is about velocities, all others about positions.
void ClosedContacts::find_rebounds(const WatchedSystem::Motion& end) {
  v_.resize(end.v.size());
  for (std::size_t i = 0; i < v_.size(); ++i) {
    v_[i] = end.v[i] + std::cos(static_cast<double>(i)) * v_typ_[i];
  }
  values(end.t, end.q, end.v, minus_);
  values(end.t, end.q, v_, plus_);
  for (std::size_t k = 0; k < count(); ++k) {
    closed_[k].rebounds = plus_.u[3 * k] != minus_.u[3 * k];
  }
}

void ClosedContacts::let_go() {
  if (held_) law_.let_go(false);
  held_ = false;
}

bool ClosedContacts::same(const ClosedContacts& other) const {
  return std::ranges::equal(closed_, other.closed_, [](const auto& one, const auto& two) {
    return one.id == two.id && one.rebounds == two.rebounds;
  });
}

void ClosedContacts::values(double t, In q, In v, Values& found) {
  all_.resize(forces_.size());
  law_.velocities(t, q, v, all_);
  found.assign(count());
  for (std::size_t k = 0; k < count(); ++k) {
    std::copy_n(&all_[3 * index_[k]], 3, &found.u[3 * k]);
    std::copy_n(&forces_[3 * index_[k]], 3, &found.f[3 * k]);
    found.mu[k] = closed_[k].friction;
  }
}

void ClosedContacts::remove_forces() {
  given_.assign(forces_.size(), 0.0);
  law_.set_forces(given_);
}

void ClosedContacts::leave_unit(std::size_t contact, std::size_t component) {
  given_.assign(forces_.size(), 0.0);
  given_[3 * index_[contact] + component] = 1;
  law_.set_forces(given_);
}

void ClosedContacts::restore_forces() { law_.set_forces(forces_); }

}  // namespace tress::integrators
