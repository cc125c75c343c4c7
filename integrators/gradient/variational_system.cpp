#include "integrators/gradient/variational_system.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

#include "integrators/gradient/run_phases.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Why a run has no derivative by a parameter whose change by s ends the use of a
/// reference frame in another step.
std::string frame_moves(const std::string& name, double s) {
  std::ostringstream text;
  text << "a change of " << name << " by " << s
       << " of its size moves a reference frame to another step: change dt_s by a "
          "thousandth, or use a model without reference frames, such as super_helix";
  return text.str();
}

}  // namespace

VariationalSystem::VariationalSystem(const WatchedSystem& run, System& system,
                                     std::span<const VariedSystem> varied,
                                     const Options& options, KnownForces forces,
                                     System* copies)
    : run_(run),
      system_(system),
      varied_(varied),
      n_(size(system.layout().coordinates)),
      stages_(system, varied, options, forces, copies) {
  const int constraints = stages_.dynamics().m();
  if (constraints > 0) {
    starts_.emplace(system, varied, acceleration_options(options), forces, copies);
  }
  if (system.contact_form() != nullptr) {
    contacts_.emplace(stages_.dynamics(), varied);
    contact_columns_.emplace(*contacts_, *system.contact_form(), columns());
  }
  for (auto* x : {&start_.q, &start_.v, &start_.a}) x->resize(n_);
  start_.lambda.resize(size(constraints));
}

void VariationalSystem::initial_state(Out dq, Out dv) const {
  std::ranges::fill(dq, 0.0);
  std::ranges::fill(dv, 0.0);
  std::vector<double> q(n_), v(n_);
  for (std::size_t k = 0; k < columns(); ++k) {
    const Stencil& stencil = varied_[k].stencil;
    system_.initial_state(q, v);
    add(column(dq, k), stencil.base, q);
    add(column(dv, k), stencil.base, v);
    for (std::size_t i = 0; i < stencil.at.size(); ++i) {
      varied_[k].systems[i]->initial_state(q, v);
      add(column(dq, k), stencil.weight[i], q);
      add(column(dv, k), stencil.weight[i], v);
    }
  }
}

void VariationalSystem::follow(double t, In q, In v) {
  from_ = start_;
  if (contacts_) contacts_->start(from_);
  start_.t = t;
  std::ranges::copy(q, start_.q.begin());
  std::ranges::copy(v, start_.v.begin());
  looked_ = false;
  carried_ = 0;
}

void VariationalSystem::scale(Out q_typ, Out v_typ) const {
  for (std::size_t k = 0; k < columns(); ++k) {
    system_.scale(column(q_typ, k), column(v_typ, k));
  }
}

/// The record of a stage: times of the run and of this one differ by rounding.
Status VariationalSystem::look_at(double t) noexcept {
  const auto stages = run_.stages();
  if (stages.empty()) return Status::fatal;
  const auto nearest = std::ranges::min_element(
      stages, {}, [t](const auto& stage) { return std::abs(stage.t - t); });
  if (looked_ && nearest->t == looked_at_) return Status::ok;
  looked_ = true;
  looked_at_ = nearest->t;
  if (contacts_ && !contacts_->hold(*nearest)) {
    failure_ = std::string(ContactDerivative::other_contacts);
    return Status::fatal;
  }
  return stages_.move(*nearest);
}

Status VariationalSystem::linearize(double t, In, In, In, Weights w) noexcept {
  Status s = look_at(t);
  if (s == Status::ok) s = stages_.factor(w);
  return s == Status::ok && contacts_ ? contacts_->factor(w) : s;
}

Status VariationalSystem::residual(double t, In dq, In dv, In da, Out r) noexcept {
  Status s = look_at(t);
  if (s == Status::ok) s = stages_.excess(dq, dv, da, r);
  if (s != Status::ok || !contacts_) return s;
  const std::size_t rows = contacts_->rows();
  laws_.resize(columns() * rows);
  for (std::size_t k = 0; k < columns(); ++k) {
    contacts_->laws(k, column(dq, k), column(dv, k), Out(laws_).subspan(k * rows, rows));
  }
  return s;
}

Status VariationalSystem::solve(In b, Out x) noexcept {
  if (b.data() != x.data()) std::ranges::copy(b, x.begin());
  if (!contacts_) return Status::ok;
  const std::size_t rows = contacts_->rows();
  for (std::size_t k = 0; k < columns(); ++k) {
    contacts_->correct(In(laws_).subspan(k * rows, rows), column(x, k));
  }
  return Status::ok;
}

Status VariationalSystem::acceleration(double t, In dq, In dv, Out da) noexcept {
  Linearized& equations = at_start();
  start_.t = t;
  Status s =
      equations.dynamics().accelerate(t, start_.q, start_.v, start_.a, start_.lambda);
  if (s == Status::ok) s = equations.move(start_);
  if (s == Status::ok) s = equations.factor({1, 0, 0});
  looked_ = false;
  return s == Status::ok ? equations.accelerate(dq, dv, da) : s;
}

/// Where nothing moves, the systems only follow the run. Else the change of what each
/// stencil's state becomes is differentiated: coordinates that do not move add nothing.
bool VariationalSystem::accept(double t, InOut dq, InOut dv) {
  const WatchedSystem::Motion& before = run_.accepted();
  std::vector<double> q = before.q, v = before.v;
  system_.accept(t, q, v);
  const bool moved = run_.moved();
  const std::vector<double> old_dq(dq.begin(), dq.end()), old_dv(dv.begin(), dv.end());
  for (std::size_t k = 0; k < columns(); ++k) {
    const Stencil& stencil = varied_[k].stencil;
    for (std::size_t i = 0; i < stencil.at.size(); ++i) {
      const double s = stencil.at[i];
      shifted(q, before.q, s, column(In(old_dq), k));
      shifted(v, before.v, s, column(In(old_dv), k));
      const std::vector<double> old_q = q, old_v = v;
      if (varied_[k].systems[i]->accept(t, q, v) != moved) {
        failure_ =
            frame_moves(varied_[k].name.empty() ? "parameter " + std::to_string(k + 1)
                                                : varied_[k].name,
                        s);
        std::ranges::fill(dq, std::nan(""));
        return moved;
      }
      if (!moved) continue;
      add(q, -1, old_q);
      add(v, -1, old_v);
      add(column(dq, k), stencil.weight[i], q);
      add(column(dv, k), stencil.weight[i], v);
    }
  }
  return moved;
}

bool VariationalSystem::carry(double t, InOut dq, InOut dv, InOut da) const {
  if (carried_ == run_.carried().size()) return false;
  const WatchedSystem::Motion& before = run_.carried()[carried_++];
  using Vectors = std::array<std::vector<double>, 3>;
  const std::array<InOut, 3> all{dq, dv, da};
  const std::array<In, 3> of_run{before.q, before.v, before.a};
  Vectors old;
  for (std::size_t j = 0; j < 3; ++j) old[j].assign(all[j].begin(), all[j].end());
  for (std::size_t k = 0; k < columns(); ++k) {
    const Stencil& stencil = varied_[k].stencil;
    for (std::size_t i = 0; i < stencil.at.size(); ++i) {
      Vectors from, to;
      for (std::size_t j = 0; j < 3; ++j) {
        from[j].resize(n_);
        shifted(from[j], of_run[j], stencil.at[i], column(In(old[j]), k));
      }
      to = from;
      if (!tress::carry(*varied_[k].systems[i], t, to[0], to[1], to[2])) return false;
      for (std::size_t j = 0; j < 3; ++j) {
        add(to[j], -1, from[j]);
        add(column(all[j], k), stencil.weight[i], to[j]);
      }
    }
  }
  return true;
}

}  // namespace tress::integrators
