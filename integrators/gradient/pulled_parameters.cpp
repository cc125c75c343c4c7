#include "integrators/gradient/pulled_parameters.h"

#include <algorithm>
#include <cmath>

#include "contract/forms/material_points.h"
#include "integrators/gradient/run_phases.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

std::vector<std::vector<double>> natural_directions(
    System& system, std::span<const RunParameter> parameters) {
  std::vector<std::vector<double>> all;
  for (const RunParameter& parameter : parameters) {
    all.push_back(natural_direction(system, parameter));
  }
  return all;
}

std::vector<VariedSystem> others(System& system, std::span<const RunParameter> parameters,
                                 const std::vector<std::vector<double>>& natural_by) {
  std::vector<VariedSystem> all;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (!natural_by[k].empty()) continue;
    all.push_back(varied_system(system, parameters[k], VariedMemory::of_run));
  }
  return all;
}

/// see(weight, system) of all terms of a stencil.
template <class See>
void each_term(System& system, const VariedSystem& varied, See see) {
  const Stencil& stencil = varied.stencil;
  if (stencil.base != 0) see(stencil.base, system);
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    see(stencil.weight[i], *varied.systems[i]);
  }
}

}  // namespace

PulledNatural::PulledNatural(System& system, Dynamics& dynamics)
    : form_(*natural_strains(system)),
      dynamics_(dynamics),
      stiffness_(form_.natural_stiffness()),
      coordinates_(form_.strains_are_coordinates()),
      base_(size(dynamics.n())),
      r_(base_),
      c_(size(dynamics.m())),
      natural_(form_.natural()),
      changed_(natural_) {
  if (!coordinates_) find_groups(system);
}

/// Away from the initial state, and at several times: symmetry, or a clamp along the
/// axes, may hide that an equation has a strain.
void PulledNatural::find_groups(System& system) {
  const std::size_t n = base_.size();
  std::vector<double> q(n), v(n), a(n), q_typ(n), v_typ(n);
  system.initial_state(q, v);
  system.scale(q_typ, v_typ);
  for (std::size_t i = 0; i < n; ++i) {
    q[i] += 0.02 * std::sin(1 + 2.7 * static_cast<double>(i)) * q_typ[i];
  }
  std::vector<std::vector<bool>> taken;  // rows of each group
  for (std::size_t k = 0; k < natural_.size(); ++k) {
    std::vector<bool> touched(n);
    for (const double t : probed_times) {
      form_.set_natural(natural_);
      static_cast<void>(system.residual(t, q, v, a, base_));
      changed_[k] += 1;
      form_.set_natural(changed_);
      static_cast<void>(system.residual(t, q, v, a, r_));
      changed_[k] = natural_[k];
      for (std::size_t i = 0; i < n; ++i) touched[i] = touched[i] || r_[i] != base_[i];
    }
    Member member{k, {}};
    for (std::size_t i = 0; i < n; ++i) {
      if (touched[i]) member.rows.push_back(i);
    }
    std::size_t group = 0;
    const auto meets = [&](std::size_t i) { return taken[group][i]; };
    while (group < groups_.size() && std::ranges::any_of(member.rows, meets)) ++group;
    if (group == groups_.size()) {
      groups_.emplace_back();
      taken.emplace_back(n);
    }
    for (const std::size_t i : member.rows) taken[group][i] = true;
    groups_[group].push_back(std::move(member));
  }
  form_.set_natural(natural_);
}

Status PulledNatural::pull(const WatchedSystem::Motion& at,
                           std::span<const std::vector<double>> mu,
                           std::span<std::vector<double>> n_hat) noexcept {
  if (coordinates_) {
    for (std::size_t s = 0; s < mu.size(); ++s) {
      for (std::size_t k = 0; k < stiffness_.size(); ++k) {
        n_hat[s][k] += stiffness_[k] * mu[s][k];
      }
    }
    return Status::ok;
  }
  Status status = dynamics_.residual(at.t, at.q, at.v, at.a, at.lambda, base_, c_);
  for (const auto& group : groups_) {
    if (status != Status::ok) break;
    for (const Member& member : group) changed_[member.strain] += 1;
    form_.set_natural(changed_);
    status = dynamics_.residual(at.t, at.q, at.v, at.a, at.lambda, r_, c_);
    for (const Member& member : group) {
      changed_[member.strain] = natural_[member.strain];
      for (std::size_t s = 0; s < mu.size(); ++s) {
        for (const std::size_t i : member.rows) {
          n_hat[s][member.strain] -= mu[s][i] * (r_[i] - base_[i]);
        }
      }
    }
  }
  form_.set_natural(natural_);
  return status;
}

ParameterResiduals::ParameterResiduals(System& system,
                                       std::span<const VariedSystem> varied,
                                       const Options& options)
    : dynamics_(system, options),
      varied_(varied),
      base_r_(size(dynamics_.n())),
      base_c_(size(dynamics_.m())),
      r_(base_r_),
      c_(base_c_) {
  for (const VariedSystem& one : varied) {
    auto& equations = equations_.emplace_back();
    for (const auto& made : one.systems) {
      equations.push_back(std::make_unique<Dynamics>(*made, options));
    }
  }
}

Status ParameterResiduals::move(const WatchedSystem::Motion& state) noexcept {
  state_ = &state;
  const auto based = [](const VariedSystem& one) { return one.stencil.base != 0; };
  if (std::ranges::none_of(varied_, based)) return Status::ok;
  return dynamics_.residual(state.t, state.q, state.v, state.a, state.lambda, base_r_,
                            base_c_);
}

Status ParameterResiduals::derivative(std::size_t k, Out dr, Out dc) noexcept {
  const Stencil& stencil = varied_[k].stencil;
  for (std::size_t i = 0; i < dr.size(); ++i) dr[i] = stencil.base * base_r_[i];
  for (std::size_t i = 0; i < dc.size(); ++i) dc[i] = stencil.base * base_c_[i];
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    const Status s = equations_[k][i]->residual(state_->t, state_->q, state_->v,
                                                state_->a, state_->lambda, r_, c_);
    if (s != Status::ok) return s;
    add(dr, stencil.weight[i], r_);
    add(dc, stencil.weight[i], c_);
  }
  return Status::ok;
}

PulledParameters::PulledParameters(System& system,
                                   std::span<const RunParameter> parameters,
                                   const Options& options)
    : natural_by_(natural_directions(system, parameters)),
      varied_(others(system, parameters, natural_by_)),
      stages_(system, varied_, options),
      r_(size(stages_.dynamics().n())),
      c_(size(stages_.dynamics().m())) {
  for (std::size_t k = 0; k < natural_by_.size(); ++k) {
    if (natural_by_[k].empty()) index_.push_back(k);
  }
  system.reset();
  const std::vector<double> memory = system.memory();
  for (const VariedSystem& one : varied_) {
    for (const auto& made : one.systems) {
      std::vector<double> own = made->memory();
      add(own, -1, memory);
      began_.push_back(std::move(own));
    }
  }
  if (stages_.dynamics().m() > 0) {
    starts_.emplace(system, varied_, acceleration_options(options));
  }
  if (varied_.size() < natural_by_.size()) {
    natural_.emplace(system, stages_.dynamics());
  }
}

void PulledParameters::begin(std::size_t numbers) {
  by_.assign(numbers, std::vector<double>(varied_.size()));
  n_hat_.assign(numbers, std::vector<double>(natural_ ? natural_->count() : 0));
}

void PulledParameters::recall(In memory) {
  std::size_t next = 0;
  for (const VariedSystem& one : varied_) {
    for (const auto& system : one.systems) {
      std::vector<double> own = began_[next++];
      add(own, 1, memory);
      system->recall(own);
    }
  }
}

Status PulledParameters::pull(const WatchedSystem::Motion& at, bool starts,
                              std::span<const std::vector<double>> x) noexcept {
  ParameterResiduals& residuals = starts && starts_ ? *starts_ : stages_;
  Status status = residuals.move(at);
  for (std::size_t k = 0; k < varied_.size() && status == Status::ok; ++k) {
    status = residuals.derivative(k, r_, c_);
    for (std::size_t s = 0; s < x.size(); ++s) {
      by_[s][k] -= product(r_, In(x[s]).first(r_.size())) +
                   product(c_, In(x[s]).subspan(r_.size()));
    }
  }
  if (status != Status::ok || !natural_) return status;
  return natural_->pull(at, x, n_hat_);
}

void PulledParameters::pull_start(System& system, std::span<const In> q_hat,
                                  std::span<const In> v_hat) {
  std::vector<double> q(r_.size()), v(q);
  for (std::size_t k = 0; k < varied_.size(); ++k) {
    each_term(system, varied_[k], [&](double weight, System& at) {
      at.initial_state(q, v);
      for (std::size_t s = 0; s < by_.size(); ++s) {
        by_[s][k] += weight * (product(q, q_hat[s]) + product(v, v_hat[s]));
      }
    });
  }
}

void PulledParameters::pull_points(System& system, double t, In q,
                                   std::span<const std::vector<double>> x_hat) {
  std::vector<double> x(x_hat.front().size());
  for (std::size_t k = 0; k < varied_.size(); ++k) {
    each_term(system, varied_[k], [&](double weight, System& at) {
      at.material_points()->positions(t, q, x);
      for (std::size_t s = 0; s < by_.size(); ++s) {
        by_[s][k] += weight * product(x, x_hat[s]);
      }
    });
  }
}

void PulledParameters::write(Out by) const {
  for (std::size_t s = 0; s < by_.size(); ++s) {
    const Out row = by.subspan(s * count(), count());
    for (std::size_t k = 0; k < index_.size(); ++k) row[index_[k]] = by_[s][k];
    for (std::size_t k = 0; k < count(); ++k) {
      if (!natural_by_[k].empty()) row[k] = product(natural_by_[k], n_hat_[s]);
    }
  }
}

}  // namespace tress::integrators
