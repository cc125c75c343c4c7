#include "models/driven/driven_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "models/joints/joined_system.h"

namespace tress::models {
DrivenSystem::DrivenSystem(std::unique_ptr<System> strand,
                           const std::vector<const DrivenBody*>& bodies,
                           const Vec& gravity)
    : strand_(std::move(strand)),
      joined_(dynamic_cast<JoinedSystem*>(strand_.get())),
      points_(strand_->material_points()),
      constrained_(bordered_form(*strand_)),
      supports_(tress::support_forces(*strand_)),
      joints_(tress::joint_forces(*strand_)),
      strand_size_(static_cast<std::size_t>(strand_->layout().coordinates)),
      all_(strand_size_),
      linear_points_(points_ != nullptr && points_->mean(points_->count() - 1)),
      lu_(0) {
  refuse_if(strand_->contact_form() != nullptr,
            "a body that strands drive and exact contact, whose response leaves out the "
            "body's motion",
            "effect body", "use friction_law = \"regularised\" for all bodies");
  const TypicalMotion typical = typical_motion(*strand_);
  std::size_t columns = 0;
  for (const DrivenBody* effect : bodies) {
    const auto member = joined_ == nullptr ? std::nullopt : joined_->member_of(*effect);
    BodySystem* system = nullptr;
    if (member) {
      system = joined_->body(*member);
    } else {
      loose_.push_back(make_body_system(*effect, gravity, typical));
      system = loose_.back().get();
    }
    const auto size = static_cast<std::size_t>(system->layout().coordinates);
    const std::size_t first = member ? joined_->first_coordinate(*member) : all_;
    if (!member) all_ += size;
    bodies_.push_back({effect, system, first, size, columns, member});
    columns += size;
  }
  if (strand_->layout().constraints > 0) rows_.emplace(*strand_, all_);
  const auto n = static_cast<Eigen::Index>(all_),
             m = 2 * static_cast<Eigen::Index>(columns);
  for (Eigen::MatrixXd* border : {&u_, &v_, &responses_}) border->setZero(n, m);
  inner_.setZero(m, m);
  inner_x_.setZero(m);
  lu_ = DenseLu(m);
  for (auto* x : {&q_typ_, &zero_, &r_, &base_, &pulled_, &shifted_}) {
    x->assign(strand_size_, 0.0);
  }
  strand_->scale(q_typ_, r_);
}

Traits DrivenSystem::traits() const {
  Traits all = strand_->traits();
  for (const auto& body : loose_) {
    all.constant_mass = all.constant_mass && body->traits().constant_mass;
  }
  return all;
}

void DrivenSystem::place(In q, In v) const {
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    bodies_[k].effect->move_to(motion(q, v, k));
  }
}

void DrivenSystem::initial_state(Out q, Out v) const {
  strand_->initial_state(of_strand(q), of_strand(v));
  static_cast<void>(each_loose([&](BodySystem& body, std::size_t k) {
    body.initial_state(of_body(q, k), of_body(v, k));
    return Status::ok;
  }));
  place(q, v);
}

void DrivenSystem::scale(Out q_typ, Out v_typ) const {
  strand_->scale(of_strand(q_typ), of_strand(v_typ));
  static_cast<void>(each_loose([&](BodySystem& body, std::size_t k) {
    body.scale(of_body(q_typ, k), of_body(v_typ, k));
    return Status::ok;
  }));
}

/// Bodies come after the strands, whose loads they read.
Status DrivenSystem::residual(double t, In q, In v, In a, Out r) noexcept {
  place(q, v);
  return recorded([&] {
    const Status s =
        strand_->residual(t, of_strand(q), of_strand(v), of_strand(a), of_strand(r));
    if (s != Status::ok) return s;
    return each_loose([&](BodySystem& body, std::size_t k) {
      return body.residual(t, of_body(q, k), of_body(v, k), of_body(a, k), of_body(r, k));
    });
  });
}

Status DrivenSystem::linearize_bordered(double t, In q, In v, In a, In lambda,
                                        Weights w) noexcept {
  if (rows_) last_.take(t, q, v, a, lambda, w);
  return factor(t, q, v, a, lambda, w);
}

Status DrivenSystem::factor(double t, In q, In v, In a, In lambda, Weights w) noexcept {
  place(q, v);
  Status s = border(t, q, v, w);
  if (s != Status::ok) return s;
  s = constrained_ == nullptr
          ? strand_->linearize(t, of_strand(q), of_strand(v), of_strand(a), w)
          : constrained_->linearize_bordered(t, of_strand(q), of_strand(v), of_strand(a),
                                             lambda, w);
  if (s != Status::ok) return s;
  s = each_loose([&](BodySystem& body, std::size_t k) {
    return body.linearize(t, of_body(q, k), of_body(v, k), of_body(a, k), w);
  });
  return s == Status::ok && coupled_ ? couple() : s;
}

/// x = S^-1 x, without the derivatives of the contact forces.
Status DrivenSystem::solve_parts(InOut x) noexcept {
  if (const Status s = strand_->solve(of_strand(x), of_strand(x)); s != Status::ok) {
    return s;
  }
  return each_loose([&](BodySystem& body, std::size_t k) {
    return body.solve(of_body(x, k), of_body(x, k));
  });
}

Status DrivenSystem::solve(In b, Out x) noexcept {
  const Status restored = last_.restore([this](const LastMatrix::Arguments& of) {
    return factor(of.t, of.q, of.v, of.a, of.lambda, of.w);
  });
  if (restored != Status::ok) return restored;
  if (x.data() != b.data()) std::ranges::copy(b, x.begin());
  const Status s = solve_parts(x);
  if (s != Status::ok || !coupled_) return s;
  Eigen::Map<Eigen::VectorXd> all(x.data(), std::ssize(x));
  inner_x_.noalias() = v_.transpose() * all;
  lu_.solve(inner_x_);
  all.noalias() -= responses_ * inner_x_;
  return Status::ok;
}

SparseForm* DrivenSystem::sparse_form() {
  if (!rows_) return nullptr;
  if (!full_) full_.emplace(*this);
  return this;
}

Status DrivenSystem::values(double t, In q, In v, In a, Weights w, Out s) noexcept {
  return last_.replaced_by([&] { return full_->values(t, q, v, a, w, s); });
}

Status DrivenSystem::acceleration(double t, In q, In v, Out a) noexcept {
  place(q, v);
  return recorded([&] {
    const Status s = strand_->explicit_form()->acceleration(t, of_strand(q), of_strand(v),
                                                            of_strand(a));
    if (s != Status::ok) return s;
    return each_loose([&](BodySystem& body, std::size_t k) {
      return body.acceleration(t, of_body(q, k), of_body(v, k), of_body(a, k));
    });
  });
}

void DrivenSystem::positions(double t, In q, Out x) {
  points_->positions(t, of_strand(q), x);
}

void DrivenSystem::velocities(double t, In q, In v, Out u) {
  points_->velocities(t, of_strand(q), of_strand(v), u);
}

/// Points do not move with the bodies: the last columns are 0.
bool DrivenSystem::jacobian(double t, In q, Out j) {
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
bool DrivenSystem::accept(double t, InOut q, InOut v) {
  place(q, v);
  bool changed = strand_->accept(t, of_strand(q), of_strand(v));
  static_cast<void>(each_loose([&](System& body, std::size_t k) {
    if (body.accept(t, of_body(q, k), of_body(v, k))) changed = true;
    return Status::ok;
  }));
  return changed;
}

void DrivenSystem::reset() {
  strand_->reset();
  for (const auto& body : loose_) static_cast<System&>(*body).reset();
  for (const Driven& body : bodies_) body.effect->move_to(body.effect->start());
}

std::vector<double> DrivenSystem::memory() const {
  std::vector<double> all = strand_->memory();
  for (const auto& body : loose_) {
    const std::vector<double> own = static_cast<System&>(*body).memory();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void DrivenSystem::recall(In memory) {
  for (auto body = loose_.rbegin(); body != loose_.rend(); ++body) {
    System& system = **body;
    const std::size_t own = system.memory().size();
    system.recall(memory.last(own));
    memory = memory.first(memory.size() - own);
  }
  strand_->recall(memory);
}

/// A rotation vector whose reference has moved has another meaning in the past.
bool DrivenSystem::carry(double t, InOut q, InOut v, InOut a) const {
  const bool turns = std::ranges::none_of(
      loose_, [](const auto& body) { return body->layout().coordinates > 1; });
  return turns && tress::carry(*strand_, t, of_strand(q), of_strand(v), of_strand(a));
}

std::unique_ptr<System> with_driven_bodies(std::unique_ptr<System> strand,
                                           const Effects& effects) {
  const std::vector<const DrivenBody*> bodies = driven_bodies(effects);
  if (bodies.empty()) return strand;
  if (strand->layout().constraints > 0 && bordered_form(*strand) == nullptr) {
    // Joined strands have the form; here it is one.
    std::vector<std::unique_ptr<SupportedSystem>> one;
    one.push_back(as_supported(std::move(strand)));
    strand = std::make_unique<JoinedSystem>(std::move(one), std::vector<Joint>{},
                                            std::vector<std::string>{});
  }
  return std::make_unique<DrivenSystem>(std::move(strand), bodies,
                                        gravity_on_bodies(effects));
}

const StrandBlock* block_of(const System& system) {
  const auto* turning = dynamic_cast<const DrivenSystem*>(&system);
  return dynamic_cast<const StrandBlock*>(turning == nullptr ? &system
                                                             : &turning->strand());
}

}  // namespace tress::models
