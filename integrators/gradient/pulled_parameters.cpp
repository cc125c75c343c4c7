#include "integrators/gradient/pulled_parameters.h"

#include <algorithm>
#include <cmath>

#include "contract/forms/material_points.h"
#include "integrators/gradient/run_phases.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

using Constants = std::vector<std::optional<ConstantsDerivative>>;

Constants constants_derivatives(System& system, std::span<const RunParameter> parameters,
                                KnownForces forces) {
  Constants all;
  for (const RunParameter& parameter : parameters) {
    all.push_back(constants_derivative(system, parameter, forces));
  }
  return all;
}

std::vector<std::vector<double>> natural_directions(
    System& system, std::span<const RunParameter> parameters, const Constants& known) {
  std::vector<std::vector<double>> all(parameters.size());
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (!known[k]) all[k] = natural_direction(system, parameters[k]);
  }
  return all;
}

std::vector<VariedSystem> others(System& system, std::span<const RunParameter> parameters,
                                 const Constants& known,
                                 const std::vector<std::vector<double>>& natural_by) {
  std::vector<VariedSystem> all;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (!natural_by[k].empty() || (known[k] && !known[k]->moves_points)) continue;
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

PulledParameters::PulledParameters(System& system,
                                   std::span<const RunParameter> parameters,
                                   const Options& options, KnownForces forces)
    : system_(system),
      transposed_(transposed_form(system)),
      clamp_(moved_clamp(system)),
      constants_by_(constants_derivatives(system, parameters, forces)),
      natural_by_(natural_directions(system, parameters, constants_by_)),
      varied_(others(system, parameters, constants_by_, natural_by_)),
      stages_(system, varied_, options, KnownForces{.sparse = false}, nullptr),
      r_(size(stages_.dynamics().n())),
      c_(size(stages_.dynamics().m())) {
  for (std::size_t k = 0; k < natural_by_.size(); ++k) {
    any_constants_ = any_constants_ || constants_by_[k];
    if (!natural_by_[k].empty()) continue;
    if (constants_by_[k] && !constants_by_[k]->moves_points) continue;
    if (!constants_by_[k] && !varied_[index_.size()].starts) {
      residuals_.push_back(index_.size());
    }
    index_.push_back(k);
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
    starts_.emplace(system, varied_, acceleration_options(options),
                    KnownForces{.sparse = false}, nullptr);
  }
  if (std::ranges::any_of(natural_by_, [](const auto& by) { return !by.empty(); })) {
    natural_.emplace(system, stages_.dynamics());
  }
}

void PulledParameters::begin(std::size_t numbers) {
  by_.assign(numbers, std::vector<double>(varied_.size()));
  n_hat_.assign(numbers, std::vector<double>(natural_ ? natural_->count() : 0));
  const std::size_t constants = any_constants_ ? transposed_->constants().size() : 0;
  c_hat_.assign(numbers, std::vector<double>(constants));
  by_loads_.assign(numbers, std::vector<double>(count()));
}

void PulledParameters::pull_constants(const WatchedSystem::Motion& at, bool placed,
                                      std::size_t number, In x) noexcept {
  if (!any_constants_) return;
  TransposedForm& form = *transposed_;
  if (!placed) form.place_transposed(at.t, at.q, at.v, at.a, x);
  form.add_by_constants(c_hat_[number]);
  std::optional<double> own;
  for (std::size_t k = 0; k < count(); ++k) {
    if (!constants_by_[k]) continue;
    const VariedSystem &loads = constants_by_[k]->loads, &clamp = constants_by_[k]->clamp;
    for (std::size_t i = 0; i < clamp.systems.size(); ++i) {
      by_loads_[number][k] -=
          clamp.stencil.weight[i] * clamp_->power_of_clamp(*clamp.systems[i]);
    }
    for (std::size_t i = 0; i < loads.systems.size(); ++i) {
      by_loads_[number][k] +=
          loads.stencil.weight[i] * form.power_of_loads(*loads.systems[i]);
    }
    if (loads.systems.empty() || loads.stencil.base == 0) continue;
    if (!own) own = form.power_of_loads(system_);
    by_loads_[number][k] += loads.stencil.base * *own;
  }
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
  if (residuals_.empty() && !natural_) return Status::ok;
  Linearized& linearized = starts && starts_ ? *starts_ : stages_;
  Status status = linearized.move(at);
  for (const std::size_t k : residuals_) {
    if (status != Status::ok) break;
    std::ranges::fill(r_, 0.0);
    std::ranges::fill(c_, 0.0);
    status = linearized.add_parameter(k, r_, c_);
    for (std::size_t s = 0; s < x.size(); ++s) {
      by_[s][k] -= scalar_product(r_, In(x[s]).first(r_.size())) +
                   scalar_product(c_, In(x[s]).subspan(r_.size()));
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
        by_[s][k] += weight * (scalar_product(q, q_hat[s]) + scalar_product(v, v_hat[s]));
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
        by_[s][k] += weight * scalar_product(x, x_hat[s]);
      }
    });
  }
}

void PulledParameters::write(Out by) const {
  for (std::size_t s = 0; s < by_.size(); ++s) {
    const Out row = by.subspan(s * count(), count());
    std::ranges::fill(row, 0.0);
    for (std::size_t k = 0; k < index_.size(); ++k) row[index_[k]] = by_[s][k];
    for (std::size_t k = 0; k < count(); ++k) {
      if (constants_by_[k]) {
        row[k] += by_loads_[s][k] - scalar_product(constants_by_[k]->by, c_hat_[s]);
      }
      if (!natural_by_[k].empty()) row[k] = scalar_product(natural_by_[k], n_hat_[s]);
    }
  }
}

}  // namespace tress::integrators
