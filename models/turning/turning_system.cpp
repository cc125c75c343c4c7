#include "models/turning/turning_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "models/joints/joined_system.h"

namespace tress::models {
namespace {

/// That of the bearing and the prescribed one, N m.
double moment_of(const Bearing& bearing, double speed) {
  return bearing.moment - bearing.damping * speed;
}

}  // namespace

TurningSystem::TurningSystem(std::unique_ptr<System> strand,
                             std::vector<const TurningBody*> bodies)
    : strand_(std::move(strand)),
      bodies_(std::move(bodies)),
      points_(strand_->material_points()),
      constrained_(bordered_form(*strand_)),
      supports_(tress::support_forces(*strand_)),
      joints_(tress::joint_forces(*strand_)),
      strand_size_(static_cast<std::size_t>(strand_->layout().coordinates)),
      all_(strand_size_ + bodies_.size()),
      linear_points_(points_ != nullptr && points_->mean(points_->count() - 1)),
      lu_(std::ssize(bodies_)) {
  refuse_if(strand_->contact_form() != nullptr,
            "a turning body and exact contact, whose response leaves out the body's "
            "motion",
            "effect body", "use friction_law = \"regularised\" for all bodies");
  if (strand_->layout().constraints > 0) rows_.emplace(*strand_, all_);
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

/// The moment on body k, N m: of the recorded loads, the bearing and the prescribed one.
double TurningSystem::driving_moment(std::size_t k, double speed) const {
  return bodies_[k]->moment() + moment_of(bodies_[k]->bearing(), speed);
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

Status TurningSystem::linearize_bordered(double t, In q, In v, In a, In lambda,
                                         Weights w) noexcept {
  if (rows_) {
    last_.t = t;
    last_.w = w;
    for (const auto& [to, from] :
         {std::pair{&last_.q, q}, std::pair{&last_.v, v}, std::pair{&last_.a, a},
          std::pair{&last_.lambda, lambda}}) {
      to->assign(from.begin(), from.end());
    }
    disturbed_ = false;
  }
  return factor(t, q, v, a, lambda, w);
}

Status TurningSystem::factor(double t, In q, In v, In a, In lambda, Weights w) noexcept {
  place(q, v);
  Status s = constrained_ == nullptr
                 ? strand_->linearize(t, of_strand(q), of_strand(v), of_strand(a), w)
                 : constrained_->linearize_bordered(t, of_strand(q), of_strand(v),
                                                    of_strand(a), lambda, w);
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
  if (disturbed_) {
    disturbed_ = false;
    const Status s = factor(last_.t, last_.q, last_.v, last_.a, last_.lambda, last_.w);
    if (s != Status::ok) return s;
  }
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

SparseForm* TurningSystem::sparse_form() {
  if (!rows_) return nullptr;
  if (!full_) full_.emplace(*this);
  return this;
}

Status TurningSystem::values(double t, In q, In v, In a, Weights w, Out s) noexcept {
  Linearized before = last_;
  const Status status = full_->values(t, q, v, a, w, s);
  last_ = std::move(before);
  disturbed_ = !last_.q.empty();
  return status;
}

Status TurningSystem::support_forces(double t, In q, In v, Out forces, Out moments) {
  if (supports_ == nullptr) return Status::ok;
  place(q, v);
  return supports_->support_forces(t, of_strand(q), of_strand(v), forces, moments);
}

void TurningSystem::support_motion(double t, Out x, Out u, Out omega) const {
  if (supports_ != nullptr) supports_->support_motion(t, x, u, omega);
}

double TurningSystem::moment_power(double t, In q, In v, const Vec& turning) {
  if (supports_ == nullptr) return 0;
  return supports_->moment_power(t, of_strand(q), of_strand(v), turning);
}

double TurningSystem::natural_power(double t, In q) {
  return supports_ == nullptr ? 0 : supports_->natural_power(t, of_strand(q));
}

NaturalWork TurningSystem::natural_work(double from, In q_from, double to, In q_to) {
  if (supports_ == nullptr) return {};
  return supports_->natural_work(from, of_strand(q_from), to, of_strand(q_to));
}

Status TurningSystem::joint_forces(double t, In q, In v, Out forces, Out moments) {
  if (joints_ == nullptr) return Status::ok;
  place(q, v);
  return joints_->joint_forces(t, of_strand(q), of_strand(v), forces, moments);
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

double TurningSystem::kinetic(In v) const {
  double sum = 0;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const double speed = v[strand_size_ + k];
    sum += bodies_[k]->bearing().inertia * speed * speed / 2;
  }
  return sum;
}

Energy TurningSystem::energy(double t, In q, In v) {
  place(q, v);
  Energy sum = strand_->energetics()->energy(t, of_strand(q), of_strand(v));
  sum.kinetic += kinetic(v);
  return sum;
}

TurningBodies::OfBodies TurningSystem::energy_of_bodies(double t, In q, In v) {
  place(q, v);
  static_cast<void>(recorded(
      [&] { return strand_->residual(t, of_strand(q), of_strand(v), zero_, r_); }));
  OfBodies all{.kinetic = kinetic(v)};
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const double speed = v[strand_size_ + k];
    all.rate += driving_moment(k, speed) * speed;
    all.from_strands += bodies_[k]->moment() * speed;
  }
  return all;
}

double TurningSystem::power(double t, In q, In v) {
  place(q, v);
  double sum = strand_->energetics()->power(t, of_strand(q), of_strand(v));
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    const double speed = v[strand_size_ + k];
    sum += moment_of(bodies_[k]->bearing(), speed) * speed;
  }
  return sum;
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
  if (strand->layout().constraints > 0 && bordered_form(*strand) == nullptr) {
    // Joined strands have the form; here it is one.
    std::vector<std::unique_ptr<SupportedSystem>> one;
    if (dynamic_cast<SupportedSystem*>(strand.get()) != nullptr) {
      one.emplace_back(static_cast<SupportedSystem*>(strand.release()));
    } else {
      one.push_back(
          std::make_unique<SupportedSystem>(std::move(strand), std::vector<Support>{}));
    }
    strand = std::make_unique<JoinedSystem>(std::move(one), std::vector<Joint>{},
                                            std::vector<std::string>{});
  }
  return std::make_unique<TurningSystem>(std::move(strand), std::move(bodies));
}

const StrandBlock* block_of(const System& system) {
  const auto* turning = dynamic_cast<const TurningSystem*>(&system);
  return dynamic_cast<const StrandBlock*>(turning == nullptr ? &system
                                                             : &turning->strand());
}

}  // namespace tress::models
