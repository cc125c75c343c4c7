#include "models/turning/turning_system.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace tress::models {
namespace {

InOut column(Eigen::MatrixXd& of, std::size_t k) {
  return {of.col(static_cast<Eigen::Index>(k)).data(),
          static_cast<std::size_t>(of.rows())};
}

/// Step of differences along a motion, over the typical coordinates: the cube root of the
/// rounding.
constexpr double motion_step = 6e-6;

}  // namespace

TurningSystem::TurningSystem(std::unique_ptr<System> strand,
                             std::vector<const TurningBody*> bodies)
    : strand_(std::move(strand)),
      bodies_(std::move(bodies)),
      points_(strand_->material_points()),
      strand_size_(static_cast<std::size_t>(strand_->layout().coordinates)),
      all_(strand_size_ + bodies_.size()),
      linear_points_(points_ != nullptr && points_->mean(points_->count() - 1)),
      lu_(std::ssize(bodies_)) {
  refuse_if(strand_->layout().constraints > 0,
            "a turning body and a strand with constraints", "effect body",
            "use a model without constraints, such as super_helix or der, and no rigid "
            "supports");
  refuse_if(strand_->contact_form() != nullptr,
            "a turning body and exact contact, whose response leaves out the body's "
            "motion",
            "effect body", "use friction_law = \"regularised\" for all bodies");
  const auto n = static_cast<Eigen::Index>(strand_size_), m = std::ssize(bodies_);
  for (Eigen::MatrixXd* border : {&column_, &responses_, &row_}) border->setZero(n, m);
  own_.setZero(m);
  inner_.setZero(m, m);
  inner_x_.setZero(m);
  for (auto* x : {&q_typ_, &zero_, &r_, &base_, &shifted_, &ahead_, &behind_}) {
    x->assign(strand_size_, 0.0);
  }
  strand_->scale(q_typ_, r_);
  for (std::size_t i = 0; i < strand_size_; ++i) {
    rate_ = std::max(rate_, r_[i] / q_typ_[i]);
  }
}

void TurningSystem::place(In q, In v) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    bodies_[k]->turn_to(q[strand_size_ + k], v[strand_size_ + k]);
  }
}

void TurningSystem::initial_state(Out q, Out v) const {
  strand_->initial_state(of_strand(q), of_strand(v));
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    q[strand_size_ + k] = 0;
    v[strand_size_ + k] = bodies_[k]->bearing().speed;
  }
  place(q, v);
}

void TurningSystem::scale(Out q_typ, Out v_typ) const {
  strand_->scale(of_strand(q_typ), of_strand(v_typ));
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    q_typ[strand_size_ + k] = 1;
    v_typ[strand_size_ + k] = std::max(rate_, std::abs(bodies_[k]->bearing().speed));
  }
}

/// Calls act(), a residual of the strand, while the bodies record their loads.
template <class Act>
Status TurningSystem::recorded(const Act& act) noexcept {
  for (const TurningBody* body : bodies_) body->record();
  const Status s = act();
  for (const TurningBody* body : bodies_) body->act();
  return s;
}

/// The moment on body k, N m: of the recorded loads, the bearing and the prescribed one.
double TurningSystem::driving_moment(std::size_t k, double speed) const {
  const Bearing& bearing = bodies_[k]->bearing();
  return bodies_[k]->moment() + bearing.moment - bearing.damping * speed;
}

Status TurningSystem::residual(double t, In q, In v, In a, Out r) noexcept {
  place(q, v);
  const Status s = recorded([&] {
    return strand_->residual(t, of_strand(q), of_strand(v), of_strand(a), of_strand(r));
  });
  if (s != Status::ok) return s;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const std::size_t i = strand_size_ + k;
    r[i] = bodies_[k]->bearing().inertia * a[i] - driving_moment(k, v[i]);
    if (!std::isfinite(r[i])) return Status::retry;
  }
  return Status::ok;
}

/// to = J^T loads, which replace those of body k. base_ has the residual without any.
Status TurningSystem::pull(double t, In q, std::size_t k, In loads, Out to) noexcept {
  bodies_[k]->replace(loads, 1);
  const Status s = strand_->residual(t, q, zero_, zero_, to);
  bodies_[k]->replace({}, 0);
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = base_[i] - to[i];
  return s;
}

/// Adds (d(J v)/dq)^T h to the row of body k, with h = slopes_.rate. It is the change of
/// J^T h along the motion, since J is dx/dq.
Status TurningSystem::add_turning_points(double t, In q, In v, std::size_t k) noexcept {
  double fastest = 0;
  for (std::size_t i = 0; i < strand_size_; ++i) {
    fastest = std::max(fastest, std::abs(v[i]) / q_typ_[i]);
  }
  if (fastest == 0) return Status::ok;
  const double step = motion_step / fastest;
  const InOut to = column(row_, k);
  for (const double side : {-1.0, 1.0}) {
    for (std::size_t i = 0; i < strand_size_; ++i) {
      shifted_[i] = q[i] + side * step * v[i];
    }
    for (const double sign : {-1.0, 1.0}) {
      bodies_[k]->replace(slopes_.rate, sign);
      const Status s = strand_->residual(t, shifted_, zero_, zero_, r_);
      if (s != Status::ok) return s;
      for (std::size_t i = 0; i < strand_size_; ++i) {
        to[i] -= side * sign * r_[i] / (4 * step);
      }
    }
  }
  bodies_[k]->replace({}, 0);
  return Status::ok;
}

/// Computes the border at this state.
Status TurningSystem::border(double t, In q, In v, Weights w) noexcept {
  const In q_s = of_strand(q), v_s = of_strand(v);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const Bearing& bearing = bodies_[k]->bearing();
    own_[static_cast<Eigen::Index>(k)] =
        w.acc * bearing.inertia + w.vel * bearing.damping;
  }
  bordered_ = false;
  if (w.vel == 0 && w.pos == 0) return Status::ok;
  Status s = recorded([&] { return strand_->residual(t, q_s, v_s, zero_, r_); });
  bordered_ = std::ranges::any_of(bodies_, &TurningBody::touched);
  if (s != Status::ok || !bordered_) return s;
  column_.setZero();
  row_.setZero();
  for (const TurningBody* body : bodies_) body->replace({}, 0);
  s = strand_->residual(t, q_s, zero_, zero_, base_);
  for (std::size_t k = 0; k < bodies_.size() && s == Status::ok; ++k) {
    if (!bodies_[k]->touched()) continue;
    bodies_[k]->slopes(t, w, slopes_);
    own_[static_cast<Eigen::Index>(k)] += slopes_.own;
    s = pull(t, q_s, k, slopes_.by_turn, column(column_, k));
    column_.col(static_cast<Eigen::Index>(k)) *= -1;
    if (s == Status::ok) s = pull(t, q_s, k, slopes_.moment, column(row_, k));
    if (s == Status::ok && w.pos != 0 && !linear_points_) {
      s = add_turning_points(t, q_s, v_s, k);
    }
  }
  for (const TurningBody* body : bodies_) body->act();
  return s;
}

Status TurningSystem::linearize(double t, In q, In v, In a, Weights w) noexcept {
  place(q, v);
  Status s = strand_->linearize(t, of_strand(q), of_strand(v), of_strand(a), w);
  if (s == Status::ok) s = border(t, q, v, w);
  inner_ = own_.asDiagonal();
  if (s != Status::ok || !bordered_) return s;
  for (std::size_t k = 0; k < bodies_.size() && s == Status::ok; ++k) {
    s = strand_->solve(column(column_, k), column(responses_, k));
  }
  if (s != Status::ok) return s;
  inner_.noalias() -= row_.transpose() * responses_;
  return inner_.allFinite() && lu_.factor(inner_) > 0 ? Status::ok : Status::retry;
}

Status TurningSystem::solve(In b, Out x) noexcept {
  for (Eigen::Index k = 0; k < inner_x_.size(); ++k) {
    inner_x_[k] = b[strand_size_ + static_cast<std::size_t>(k)];
  }
  const Status s = strand_->solve(of_strand(b), of_strand(x));
  if (s != Status::ok) return s;
  Eigen::Map<Eigen::VectorXd> own(x.data(), static_cast<Eigen::Index>(strand_size_));
  if (bordered_) {
    inner_x_.noalias() -= row_.transpose() * own;
    lu_.solve(inner_x_);
    own.noalias() -= responses_ * inner_x_;
  } else {
    inner_x_.array() /= own_.array();
  }
  for (Eigen::Index k = 0; k < inner_x_.size(); ++k) {
    x[strand_size_ + static_cast<std::size_t>(k)] = inner_x_[k];
  }
  return Status::ok;
}

Status TurningSystem::acceleration(double t, In q, In v, Out a) noexcept {
  place(q, v);
  const Status s = recorded([&] {
    return strand_->explicit_form()->acceleration(t, of_strand(q), of_strand(v),
                                                  of_strand(a));
  });
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const std::size_t i = strand_size_ + k;
    a[i] = driving_moment(k, v[i]) / bodies_[k]->bearing().inertia;
  }
  return s;
}

Energy TurningSystem::energy(double t, In q, In v) {
  place(q, v);
  Energy sum = strand_->energetics()->energy(t, of_strand(q), of_strand(v));
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const double speed = v[strand_size_ + k];
    sum.kinetic += bodies_[k]->bearing().inertia * speed * speed / 2;
  }
  return sum;
}

double TurningSystem::power(double t, In q, In v) {
  place(q, v);
  return strand_->energetics()->power(t, of_strand(q), of_strand(v));
}

void TurningSystem::positions(double t, In q, Out x) {
  points_->positions(t, of_strand(q), x);
}

void TurningSystem::velocities(double t, In q, In v, Out u) {
  points_->velocities(t, of_strand(q), of_strand(v), u);
}

/// Points do not move with the bodies: the last columns are 0.
bool TurningSystem::jacobian(double t, In q, Out j) {
  const std::size_t rows = 3 * static_cast<std::size_t>(points_->count());
  if (!points_->jacobian(t, of_strand(q), j.first(rows * strand_size_))) return false;
  for (std::size_t row = rows; row-- > 0;) {
    const InOut own = j.subspan(row * all_, all_);
    std::copy_backward(j.begin() + std::ptrdiff_t(row * strand_size_),
                       j.begin() + std::ptrdiff_t((row + 1) * strand_size_),
                       own.begin() + std::ptrdiff_t(strand_size_));
    std::ranges::fill(own.subspan(strand_size_), 0.0);
  }
  return true;
}

/// Effects that are read at this state see the bodies where they are.
bool TurningSystem::accept(double t, InOut q, InOut v) {
  place(q, v);
  return strand_->accept(t, of_strand(q), of_strand(v));
}

void TurningSystem::reset() {
  strand_->reset();
  for (const TurningBody* body : bodies_) body->turn_to(0, body->bearing().speed);
}

std::vector<double> TurningSystem::memory() const { return strand_->memory(); }

void TurningSystem::recall(In memory) { strand_->recall(memory); }

std::unique_ptr<System> with_turning_bodies(std::unique_ptr<System> strand,
                                            const Effects& effects) {
  std::vector<const TurningBody*> bodies = turning_bodies(effects);
  if (bodies.empty()) return strand;
  return std::make_unique<TurningSystem>(std::move(strand), std::move(bodies));
}

}  // namespace tress::models
