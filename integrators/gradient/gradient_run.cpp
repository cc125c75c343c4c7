#include "integrators/gradient/gradient_run.h"

#include <algorithm>

#include "contract/forms/material_points.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "integrators/gradient/run_phases.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

std::vector<VariedSystem> varied_systems(System& system,
                                         std::span<const RunParameter> parameters) {
  std::vector<VariedSystem> all;
  for (const RunParameter& parameter : parameters) {
    all.push_back(varied_system(system, parameter));
  }
  return all;
}

}  // namespace

std::optional<NoGradient> no_gradient(std::string_view method, System& system,
                                      const Options& options) {
  if (find_integrator(method).stages == 0) {
    std::string able;
    for (const IntegratorEntry& entry : integrator_catalogue()) {
      if (entry.stages > 0) able += (able.empty() ? "" : ", ") + std::string(entry.id);
    }
    return NoGradient{std::string(method) +
                          " does not solve the equations of implicit stages, at whose "
                          "solutions derivatives are taken",
                      "use " + able};
  }
  if (system.contact_form() != nullptr) {
    return NoGradient{
        "the forces of exact contact have no derivative yet",
        "use friction_law = \"regularised\" without normal and restitution"};
  }
  if (system.layout().constraints == 0) {
    if (system.traits().regular_mass) return {};
    return NoGradient{
        "the mass matrix is singular, so that accelerations have no derivative",
        "use rotary_inertia = \"on\", or another model"};
  }
  if (options.formulation == Formulation::index3) return {};
  return NoGradient{"constraints as " + std::string(name(options.formulation)) +
                        " have no exact derivative of their bias",
                    "use formulation = \"index3\""};
}

System& with_gradient(System& system, const GradientRun::Method& method) {
  std::optional<NoGradient> no = no_gradient(method.id, system, method.options);
  if (method.options.tolerance > 0) {
    no = NoGradient{"steps that a tolerance chooses are not smooth in the parameters",
                    "leave out position_tol_rel"};
  }
  if (!no) return system;
  throw InputError("no gradient: " + no->reason, "method " + std::string(method.id),
                   no->remedy);
}

GradientRun::GradientRun(System& system, std::unique_ptr<System> exact,
                         std::span<const RunParameter> parameters, const Method& method,
                         std::unique_ptr<System> copies)
    : method_(method),
      system_(with_gradient(system, method)),
      exact_(std::move(exact)),
      copies_(std::move(copies)),
      varied_(varied_systems(system, parameters)),
      watched_(system),
      variational_(watched_, *exact_, varied_, method.options, method.sparse,
                   copies_.get()),
      q_(size(system.layout().coordinates)),
      v_(q_),
      dq_(parameters.size() * q_.size()),
      dv_(dq_) {}

template <class Visit>
void GradientRun::each_system(const Visit& visit) {
  for (System* system : {&system_, exact_.get()}) visit(*system);
  for (const VariedSystem& one : varied_) {
    for (const auto& system : one.systems) visit(*system);
  }
}

Status GradientRun::start() {
  each_system([](System& system) { system.reset(); });
  t_ = 0;
  system_.initial_state(q_, v_);
  variational_.initial_state(dq_, dv_);
  if (watched_.history() != nullptr) {
    static_cast<void>(static_cast<System&>(watched_).accept(t_, q_, v_));
    static_cast<void>(static_cast<System&>(variational_).accept(t_, dq_, dv_));
  }
  return set_off();
}

Status GradientRun::start(const State& from) {
  each_system([&](System& system) {
    system.reset();
    system.recall(from.memory);
  });
  t_ = from.t;
  q_ = from.q, v_ = from.v;
  dq_ = from.dq, dv_ = from.dv;
  return set_off();
}

/// With the start that the method asks for.
Status GradientRun::set_off() {
  failure_.clear();
  stats_ = {};
  damping_ = method_.start == GradientStart::damped;
  if (!damping_) return begin(method_.id, method_.options);
  return begin(DampedStart::method, DampedStart::options(method_.options));
}

/// Both methods from the present state.
Status GradientRun::begin(std::string_view method, const Options& options) {
  before_ = stats_;
  run_ = make_integrator(method, watched_, options);
  columns_ = make_integrator(method, variational_, linear_options(options));
  watched_.forget();
  const Status s = run_->start(t_, q_, v_);
  if (s != Status::ok) return fail(s, run_->failure());
  variational_.follow(q_, v_);
  const Status c = columns_->start(t_, dq_, dv_);
  return c == Status::ok ? c : fail(c, "derivatives: " + columns_->failure());
}

Status GradientRun::advance(double t_end) {
  if (damping_) {
    Status s =
        advance_by(*run_, *columns_, DampedStart::end(t_, t_end, method_.options.step));
    damping_ = false;
    if (s == Status::ok) s = begin(method_.id, method_.options);
    if (s != Status::ok) return s;
  }
  return advance_by(*run_, *columns_, t_end);
}

Status GradientRun::advance_by(Integrator& run, Integrator& columns, double t_end) {
  Status of_columns = Status::ok;
  const Status s = run.advance(t_end, [&](double t, In q, In v) {
    variational_.follow(q, v);
    of_columns = columns.advance(t);
    watched_.forget();
    return of_columns == Status::ok && variational_.failure().empty();
  });
  keep(run, columns);
  if (!variational_.failure().empty()) return fail(Status::fatal, variational_.failure());
  if (of_columns != Status::ok) {
    return fail(of_columns, "derivatives: " + columns.failure());
  }
  return s == Status::ok ? s : fail(s, run.failure());
}

void GradientRun::keep(const Integrator& run, const Integrator& columns) {
  t_ = run.time();
  q_.assign(run.q().begin(), run.q().end());
  v_.assign(run.v().begin(), run.v().end());
  dq_.assign(columns.q().begin(), columns.q().end());
  dv_.assign(columns.v().begin(), columns.v().end());
  stats_ = before_;
  for (const Stats& done : {run.stats(), columns.stats()}) {
    stats_.residuals += done.residuals;
    stats_.linearizations += done.linearizations;
    stats_.solves += done.solves;
  }
  stats_.steps += run.stats().steps;
  stats_.newton_iterations += run.stats().newton_iterations;
}

Status GradientRun::fail(Status s, std::string why) {
  failure_ = std::move(why);
  return s;
}

/// dx = J dq + dx/ds at fixed q, with J dq as the velocity of dq less that of rest.
void GradientRun::points_by(std::size_t k, Out dx) {
  MaterialPoints& points = *exact_->material_points();
  std::vector<double> part(dx.size());
  points.velocities(t_, q_, dq(k), dx);
  points.velocities(t_, q_, std::vector<double>(q_.size()), part);
  add(dx, -1, part);
  const Stencil& stencil = varied_[k].stencil;
  points.positions(t_, q_, part);
  add(dx, stencil.base, part);
  for (std::size_t i = 0; i < stencil.at.size(); ++i) {
    varied_[k].systems[i]->material_points()->positions(t_, q_, part);
    add(dx, stencil.weight[i], part);
  }
}

}  // namespace tress::integrators
