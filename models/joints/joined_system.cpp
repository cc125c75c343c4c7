#include "models/joints/joined_system.h"

#include <algorithm>
#include <string>

#include "contract/input_error.h"
#include "linear/finite.h"

namespace tress::models {
namespace {

std::vector<std::unique_ptr<System>> as_systems(
    std::vector<std::unique_ptr<SupportedSystem>> strands) {
  std::vector<std::unique_ptr<System>> all;
  for (auto& strand : strands) all.push_back(std::move(strand));
  return all;
}

InOut column(Eigen::MatrixXd& of, Eigen::Index k) {
  return {of.col(k).data(), static_cast<std::size_t>(of.rows())};
}

}  // namespace

JoinedSystem::JoinedSystem(std::vector<std::unique_ptr<SupportedSystem>> strands,
                           const std::vector<Joint>& joints,
                           const std::vector<std::string>& where, std::size_t bodies)
    : StrandBlock(as_systems(std::move(strands)), bodies) {
  const auto n = static_cast<std::size_t>(StrandBlock::layout().coordinates);
  std::vector<JoinedRows::Member> members;
  for (std::size_t k = 0; k < this->strands(); ++k) {
    auto& held = dynamic_cast<SupportedSystem&>(strand(k));
    held_.push_back(&held);
    members.push_back({&held, first_of(k)});
    if (held.stress_form() != nullptr) stressed_.push_back(k);
    Assembled& own = assembled_.emplace_back();
    if (held.takes_springs()) continue;
    own.form = held.sparse_form();
    own.solver = make_linear_solver(LinearKind::automatic, own.form->pattern());
    own.values.resize(static_cast<std::size_t>(own.form->pattern().nonzeros()));
  }
  loads_.resize(held_.size());
  make_joints(joints, where);
  rows_ = std::make_unique<JoinedRows>(std::move(members), joints_);
  for (auto* x : {&acceleration_, &alone_, &zero_, &v_typ_, &scratch_}) x->assign(n, 0.0);
  std::vector<double> q_typ(n);
  scale(q_typ, v_typ_);
  lambda_.resize(static_cast<std::size_t>(rows_->rows()));
  gradient_.resize(static_cast<std::size_t>(rows_->pattern().nonzeros()));
  if (rows_->rows() > 0) {
    eliminated_ = std::make_unique<Bordered>(
        [this](InOut b) { return solve_factored(b); }, rows_->pattern(), q_typ);
  }
  Eigen::Index columns = 0;
  for (const JointPair& joint : joints_) columns += joint.couplings();
  for (Eigen::MatrixXd* m : {&u_, &v_, &responses_}) {
    m->setZero(static_cast<Eigen::Index>(n), columns);
  }
  inner_.resize(columns, columns);
  inner_x_.resize(columns);
  inner_lu_.emplace(columns);
}

void JoinedSystem::make_joints(const std::vector<Joint>& joints,
                               const std::vector<std::string>& where) {
  std::vector<double> q(static_cast<std::size_t>(StrandBlock::layout().coordinates)),
      v(q.size());
  initial_state(q, v);
  prepare(0);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto end = [&](const StrandPoint& at) {
      SupportedSystem& strand = *held_[at.strand];
      refuse_if(strand.rows().own() > 0,
                "a joint of a model that has constraints of its own", where[j],
                "use a model without them, such as super_helix, super_clothoid or der");
      refuse_if(
          !strand.traits().regular_mass,
          "a joint of a model whose mass matrix is singular", where[j],
          "use super_helix or super_clothoid; der with twist = \"dynamic\"; or, for "
          "articulated_chain, a clamped root");
      refuse_if(strand.strand().sparse_form() == nullptr && !strand.takes_springs(),
                "a joint of a model without the exact Jacobian", where[j],
                "use [model] jacobian = \"exact\", or another model");
      ends_.push_back(at);
      JointEnd made(strand.strand(), first_of(at.strand), at.point, where[j]);
      const bool half =
          tress::sections(strand.strand()) != nullptr &&
          tress::sections(strand.strand())->section_kind(at.point).half_edge;
      if (half && strand.natural().any())
        made.follow(strand.natural().turn(at.point > 0));
      const bool turns =
          joints[j].kind == JointKind::weld || joints[j].kind == JointKind::hinge;
      for (const MomentOnSection& one : strand.moments()) {
        if (turns && one.moment().point == at.point) {
          refuse_on_half_edge(strand.strand(), one.moment(), {}, where[j]);
        }
      }
      return made;
    };
    for (std::size_t i = 0; i < j; ++i) {
      const bool hold =
          joints[i].kind != JointKind::spring && joints[j].kind != JointKind::spring;
      const bool same = (joints[i].a == joints[j].a && joints[i].b == joints[j].b) ||
                        (joints[i].a == joints[j].b && joints[i].b == joints[j].a);
      refuse_if(hold && same, "a second joint of the same points", where[j],
                "leave out one of them");
    }
    JointEnd a = end(joints[j].a), b = end(joints[j].b);
    joints_.emplace_back(std::move(a), std::move(b), joints[j], q, where[j]);
  }
}

/// Ends move by 1e-5 of typical sizes: 1e-10 of their derivatives along the motion.
void JoinedSystem::be_exact() {
  std::vector<double> q_typ(v_typ_.size()), v_typ(q_typ);
  scale(q_typ, v_typ);
  double rate = 0;
  for (std::size_t i = 0; i < q_typ.size(); ++i) {
    rate = std::max(rate, v_typ[i] / q_typ[i]);
  }
  for (JointPair& joint : joints_) joint.be_exact(1e-5 / rate);
}

void JoinedSystem::begin_at(In q, In v) {
  for (std::size_t k = 0; k < strands(); ++k) held_[k]->begin_at(part(q, k), part(v, k));
}

void JoinedSystem::prepare(double t) {
  for (SupportedSystem* strand : held_) strand->prepare(t);
}

Status JoinedSystem::residual(double t, In q, In v, In a, Out r) noexcept {
  for (std::size_t k = 0; k < strands(); ++k) {
    const Status s =
        held_[k]->residual(t, part(q, k), part(v, k), part(a, k), part(r, k));
    if (s != Status::ok) return s;
  }
  for (JointPair& joint : joints_) {
    if (joint.couplings() == 0) continue;
    const JointLoad load = joint.load(t, q, v, {});
    joint.add_load(t, q, {-1.0 * load.force, -1.0 * load.moment}, r);
  }
  return all_finite(r) ? Status::ok : Status::retry;
}

/// The loads of all joints on each strand.
void JoinedSystem::hang_loads(double t, In q, In v, In lambda) {
  for (auto& own : loads_) own.clear();
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const JointLoad load = joints_[j].load(t, q, v, rows_->of_joint(lambda, j));
    for (const int side : {0, 1}) {
      const StrandPoint& at = ends_[2 * j + static_cast<std::size_t>(side)];
      SectionLoad on;
      on.point = at.point;
      on.force = (side == 0 ? -1.0 : 1.0) * load.force;
      on.moment = (side == 0 ? -1.0 : 1.0) * load.moment;
      loads_[at.strand].push_back(on);
    }
  }
}

Status JoinedSystem::factor_strand(std::size_t k, double t, In q, In v, In a, In lambda,
                                   Weights w) noexcept {
  const In own_lambda = rows_->of_strand(lambda, k);
  const In q_k = part(q, k), v_k = part(v, k), a_k = part(a, k);
  Assembled& own = assembled_[k];
  if (own.form == nullptr) {
    return held_[k]->linearize_with_springs(t, q_k, v_k, a_k, own_lambda, w, {},
                                            loads_[k]);
  }
  Status s = own.form->values(t, q_k, v_k, a_k, w, own.values);
  if (s == Status::ok && w.pos != 0 && !own_lambda.empty()) {
    s = held_[k]->rows().add_curvature(t, q_k, own_lambda, -w.pos, own.values);
  }
  if (s != Status::ok) return s;
  // Loads are in the order of the ends.
  std::size_t load = 0;
  for (std::size_t i = 0; i < ends_.size() && w.pos != 0; ++i) {
    if (ends_[i].strand != k) continue;
    const Vec& moment = loads_[k][load++].moment;
    if (norm(moment) == 0) continue;
    joints_[i / 2]
        .end(static_cast<int>(i % 2))
        .add_curvature(t, q, moment, -w.pos, own.values);
  }
  return own.solver->factor(own.values);
}

Status JoinedSystem::factor(double t, In q, In v, In a, In lambda, Weights w) noexcept {
  prepare(t);
  const bool moving = w.vel != 0 || w.pos != 0;
  for (auto& own : loads_) own.clear();
  if (moving) hang_loads(t, q, v, lambda);
  for (std::size_t k = 0; k < strands(); ++k) {
    const Status s = factor_strand(k, t, q, v, a, lambda, w);
    if (s != Status::ok) return s;
  }
  coupled_ = moving && u_.cols() > 0;
  return coupled_ ? couple(t, q, v, lambda, w) : Status::ok;
}

/// Prepares the terms of the joints' derivatives.
Status JoinedSystem::couple(double t, In q, In v, In lambda, Weights w) noexcept {
  u_.setZero();
  v_.setZero();
  Eigen::Index first = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Eigen::Index count = joints_[j].couplings();
    if (count == 0) continue;
    joints_[j].write_couplings(t, q, v, rows_->of_joint(lambda, j), w,
                               u_.middleCols(first, count), v_.middleCols(first, count));
    first += count;
  }
  responses_ = u_;
  for (Eigen::Index k = 0; k < responses_.cols(); ++k) {
    const Status s = solve_strands(column(responses_, k));
    if (s != Status::ok) return s;
  }
  inner_.noalias() = v_.transpose() * responses_;
  inner_.diagonal().array() += 1;
  return inner_.allFinite() && inner_lu_->factor(inner_) > 0 ? Status::ok : Status::retry;
}

Status JoinedSystem::solve_strands(InOut x) noexcept {
  for (std::size_t k = 0; k < strands(); ++k) {
    const InOut own = part(x, k);
    const Status s = assembled_[k].form == nullptr ? held_[k]->solve(own, own)
                                                   : assembled_[k].solver->solve(own);
    if (s != Status::ok) return s;
  }
  return Status::ok;
}

Status JoinedSystem::solve_factored(InOut x) noexcept {
  if (const Status s = solve_strands(x); s != Status::ok || !coupled_) return s;
  Eigen::Map<Eigen::VectorXd> all(x.data(), std::ssize(x));
  inner_x_.noalias() = v_.transpose() * all;
  inner_lu_->solve(inner_x_);
  all.noalias() -= responses_ * inner_x_;
  return Status::ok;
}

Status JoinedSystem::linearize_bordered(double t, In q, In v, In a, In lambda,
                                        Weights w) noexcept {
  last_.take(t, q, v, a, lambda, w);
  return factor(t, q, v, a, lambda, w);
}

Status JoinedSystem::solve(In b, Out x) noexcept {
  const Status restored = last_.restore([this](const LastMatrix::Arguments& of) {
    return factor(of.t, of.q, of.v, of.a, of.lambda, of.w);
  });
  if (restored != Status::ok) return restored;
  if (x.data() != b.data()) std::ranges::copy(b, x.begin());
  return solve_factored(x);
}

SparseForm* JoinedSystem::sparse_form() {
  if (rows_->rows() == 0) return nullptr;
  if (!full_) full_.emplace(*this);
  return this;
}

Status JoinedSystem::values(double t, In q, In v, In a, Weights w, Out s) noexcept {
  return last_.replaced_by([&] { return full_->values(t, q, v, a, w, s); });
}

void JoinedSystem::take_stresses(double t, In q, Stresses stresses) noexcept {
  for (const std::size_t k : stressed_) {
    strand(k).stress_form()->take_stresses(t, part(q, k), stresses);
  }
}

void JoinedSystem::reset() {
  for (std::size_t k = 0; k < strands(); ++k) strand(k).reset();
}

std::optional<std::size_t> JoinedSystem::member_of(const DrivenBody& effect) const {
  for (std::size_t k = shown(); k < strands(); ++k) {
    if (&body(k)->effect() == &effect) return k;
  }
  return {};
}

BodySystem* JoinedSystem::body(std::size_t k) const {
  return k < shown() ? nullptr : &dynamic_cast<BodySystem&>(held_[k]->strand());
}

std::unique_ptr<SupportedSystem> as_supported(std::unique_ptr<System> strand) {
  if (dynamic_cast<SupportedSystem*>(strand.get()) != nullptr) {
    return std::unique_ptr<SupportedSystem>(
        static_cast<SupportedSystem*>(strand.release()));
  }
  return std::make_unique<SupportedSystem>(std::move(strand), std::vector<Support>{});
}

}  // namespace tress::models
