#include "models/held/taken_contacts.h"

#include <algorithm>
#include <limits>

namespace tress::models {
namespace {

// As between strands (strand_friction.cpp); contacts that need more sweeps are those of a
// state that is far from the solution.
constexpr double proximal = 1e-2;
constexpr int most_sweeps = 100;

}  // namespace

TakenContacts::TakenContacts(ContactForm& form,
                             std::span<const std::shared_ptr<Effect>> held,
                             PointsAt points_at)
    : form_(form), held_(held), points_at_(std::move(points_at)) {}

std::size_t TakenContacts::take(double t, In q, In v, In q_next, In v_next) noexcept {
  if (before_.empty()) before_ = form_.multipliers();
  Points p = points_at_(t, q_next, v_next);
  for (const auto& effect : held_) effect->multipliers()->take(t, p);
  p = points_at_(t, q, v);
  t_ = t;
  since_ = p.since;
  q_.assign(q.begin(), q.end());
  v_.assign(v.begin(), v.end());
  taken_.clear();
  for (const auto& effect : held_) {
    Multipliers* const of = effect->multipliers();
    of->take(t, p);
    touches_.clear();
    of->touches(t, p, touches_);
    for (const RigidTouch& touch : touches_) {
      const Mat3 axes = axes_about(touch.normal);
      taken_.push_back({of, touch.point, axes, load3(&p.v[3 * touch.point]),
                        axes * touch.force, touch.friction});
    }
  }
  return taken_.size();
}

void TakenContacts::forces(Out f) const noexcept {
  for (std::size_t i = 0; i < taken_.size(); ++i) store3(taken_[i].force, &f[3 * i]);
}

void TakenContacts::set_forces(In f) noexcept {
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    const Taken& contact = taken_[i];
    const Vec force = load3(&f[3 * i]);
    contact.of->set_force(t_, since_, contact.point, force.x,
                          force.y * contact.axes.r1 + force.z * contact.axes.r2);
  }
}

void TakenContacts::velocities(double t, In q, In v, Out u) noexcept {
  const Points p = points_at_(t, q, v);
  touches_.clear();
  for (const auto& effect : held_) effect->multipliers()->touches(t, p, touches_);
  if (touches_.size() != taken_.size()) {  // points whose places are not finite
    std::ranges::fill(u, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    store3(taken_[i].axes * touches_[i].velocity, &u[3 * i]);
    // The normal turns with the point: a slide has a part along that of before.
    u[3 * i] = dot(touches_[i].normal, touches_[i].velocity);
  }
}

void TakenContacts::responses(In dv, Out du) noexcept {
  v_changed_.resize(dv.size());
  for (std::size_t i = 0; i < dv.size(); ++i) v_changed_[i] = v_[i] + dv[i];
  const Points p = points_at_(t_, q_, v_changed_);
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    const Taken& contact = taken_[i];
    const Vec change = load3(&p.v[3 * contact.point]) - contact.velocity;
    store3(contact.axes * change, &du[3 * i]);
  }
}

double TakenContacts::balance(In w, In u, double tolerance, InOut f) noexcept {
  const std::size_t count = taken_.size();
  blocks_.resize(w.size());
  for (std::size_t on = 0; on < count; ++on) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double* const column = &w[3 * count * (3 * on + k)];
      for (std::size_t of = 0; of < count; ++of) {
        for (std::size_t j = 0; j < 3; ++j) {
          blocks_[9 * (count * on + of) + 3 * j + k] = column[3 * of + j];
        }
      }
    }
  }
  compliance_.set(blocks_);
  problem_.clear();
  const int body = problem_.add_body(compliance_);
  for (std::size_t i = 0; i < count; ++i) {
    Vec free = load3(&u[3 * i]);
    for (std::size_t on = 0; on < count; ++on) {
      for (std::size_t k = 0; k < 3; ++k) {
        free = free - f[3 * on + k] * load3(&w[3 * count * (3 * on + k) + 3 * i]);
      }
    }
    ContactProblem::Contact contact;
    contact.ends = {{{body, static_cast<int>(i), 1}}};
    contact.friction = taken_[i].friction;
    contact.axes = identity();
    contact.free = free;
    contact.force = load3(&f[3 * i]);
    problem_.add(contact);
  }
  const auto outcome = problem_.solve(proximal, tolerance, most_sweeps);
  for (std::size_t i = 0; i < count; ++i) {
    store3(problem_.contacts()[i].force, &f[3 * i]);
  }
  return outcome.violation;
}

void TakenContacts::let_go(bool found) noexcept {
  const Points p = points_at_(t_, q_, v_);
  if (!found) form_.set_multipliers(before_);
  before_.clear();
  for (const auto& effect : held_) effect->multipliers()->give_back(p);
}

}  // namespace tress::models
