#include "integrators/gradient/gradient_run.h"

#include <algorithm>

#include "contract/forms/bordered_form.h"
#include "contract/forms/contact_form.h"
#include "contract/forms/material_points.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "integrators/gradient/run_phases.h"
#include "integrators/gradient/step_memory.h"
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

/// Names of the methods with stages for which this is true.
template <class Is>
std::string methods_that(Is is) {
  std::string all;
  for (const IntegratorEntry& entry : integrator_catalogue()) {
    if (entry.stages == 0 || !is(entry.id)) continue;
    all += (all.empty() ? "" : ", ") + std::string(entry.id);
  }
  return all;
}

/// Of exact contact.
std::optional<NoGradient> no_contact_gradient(const IntegratorEntry& method,
                                              System& system) {
  constexpr const char* regularised =
      "friction_law = \"regularised\" without normal and restitution";
  ContactForm* const contacts = system.contact_form();
  if (contacts == nullptr) return {};
  if (contacts->complementarity() == nullptr) {
    return NoGradient{"exact friction on a surface that gives way has no derivative",
                      "use normal = \"rigid\", or friction_law = \"regularised\""};
  }
  if (method.contact != Contact::exact_rebounding) {
    return NoGradient{std::string(method.id) +
                          " changes its formula at an impact with exact contact, which "
                          "has no derivative",
                      std::string("use backward_euler, or ") + regularised};
  }
  if (system.layout().constraints > 0) {
    return NoGradient{"exact contact of a model with constraints has no derivative",
                      std::string("use ") + regularised};
  }
  return {};
}

std::string at_time(const std::string& what, double t) {
  return "at t = " + std::to_string(t) + " s: " + what;
}

void add_counts(const Stats& more, Stats& all) {
  all.residuals += more.residuals;
  all.linearizations += more.linearizations;
  all.solves += more.solves;
}

}  // namespace

std::optional<NoGradient> no_gradient(std::string_view method, System& system,
                                      const Options& options) {
  if (find_integrator(method).stages == 0) {
    return NoGradient{std::string(method) +
                          " does not solve the equations of implicit stages, at whose "
                          "solutions derivatives are taken",
                      "use " + methods_that([](std::string_view) { return true; })};
  }
  if (!shows_stages(method)) {
    return NoGradient{std::string(method) +
                          " does not show the solutions of its stages (StageWatcher), at "
                          "which derivatives are taken",
                      "let the method solve its stages by Stage"};
  }
  if (auto no = no_contact_gradient(find_integrator(method), system)) return no;
  if (system.layout().constraints == 0) {
    if (system.traits().regular_mass) return {};
    return NoGradient{
        "the mass matrix is singular, so that accelerations have no derivative",
        "use rotary_inertia = \"on\", or another model"};
  }
  const bool bordered = bordered_form(system) != nullptr;
  const auto fits = [&](std::string_view id) {
    return find_integrator(id).order(Formulation::index3).has_value() &&
           !(bordered && starts_from_accelerations(id));
  };
  if (!fits(method)) {
    return NoGradient{
        std::string(method) +
            (find_integrator(method).order(Formulation::index3)
                 ? " starts from accelerations, whose derivatives lose their digits in "
                   "joined strands and in reduced coordinates with constraints"
                 : " does not take constraints as index3, of which derivatives are "
                   "exact"),
        "use " + methods_that(fits)};
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
      variational_(watched_, *exact_, varied_, method.options, method.forces,
                   copies_.get()),
      q_(size(system.layout().coordinates)),
      v_(q_),
      dq_(parameters.size() * q_.size()),
      dv_(dq_) {
  ContactForm* const contacts = system.contact_form();
  if (contacts != nullptr && contacts->rebounds()) {
    rebounds_.emplace(*variational_.contacts());
  }
}

template <class Visit>
void GradientRun::each_system(const Visit& visit) {
  for (System* system : {&system_, exact_.get()}) visit(*system);
  for (const VariedSystem& one : varied_) {
    for (const auto& system : one.systems) visit(*system);
  }
}

/// The run before.
void GradientRun::forget() {
  if (variational_.contacts() != nullptr) variational_.contacts()->begin();
  if (rebounds_) rebounds_->begin();
  cases_.clear();
  contact_changes_.clear();
  each_system([](System& system) { system.reset(); });
}

Status GradientRun::start() {
  forget();
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
  forget();
  each_system([&](System& system) { system.recall(from.memory); });
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
  variational_.follow(t_, q_, v_);
  const Status c = columns_->start(t_, dq_, dv_);
  return c == Status::ok ? c : fail(c, "derivatives: " + columns_->failure());
}

Status GradientRun::advance(double t_end) {
  const EqualSteps steps(t_end - t_, method_.options, method_.parts);
  if ((!damping_ && method_.parts == 1) || !steps.allowed) {
    return advance_by(*run_, *columns_, t_end);
  }
  if (damping_) {
    Status s = advance_in(DampedStart::steps, DampedStart::end(t_, steps.h));
    damping_ = false;
    if (s == Status::ok) s = begin(method_.id, method_.options);
    if (s != Status::ok) return s;
  }
  return advance_in(steps.count, t_end);
}

Status GradientRun::advance_in(double count, double t_end) {
  return take_equal_steps(count, t_, t_end,
                          [this](double t) { return advance_by(*run_, *columns_, t); });
}

Status GradientRun::advance_by(Integrator& run, Integrator& columns, double t_end) {
  Status of_columns = Status::ok;
  const Status s = run.advance(t_end, [&](double t, In q, In v) {
    variational_.follow(t, q, v);
    of_columns = advance_columns(columns, t, q, v);
    watched_.forget();
    return of_columns == Status::ok && variational_.failure().empty();
  });
  keep(run, columns);
  if (!variational_.failure().empty()) {
    return fail(Status::fatal, at_time(variational_.failure(), t_));
  }
  if (of_columns != Status::ok) {
    if (!failure_.empty()) return of_columns;
    return fail(of_columns, "derivatives: " + columns.failure());
  }
  return s == Status::ok ? s : fail(s, run.failure());
}

/// The step that the run has come by.
Status GradientRun::advance_columns(Integrator& columns, double t, In q, In v) {
  ContactDerivative* const contacts = variational_.contacts();
  if (contacts == nullptr) return columns.advance(t);
  if (rebounds_ && !rebounds_->find(watched_.stages().back(), columns.q())) {
    return fail(Status::fatal, at_time(rebounds_->failure(), t));
  }
  const WatchedSystem::Motion& start = variational_.step_start();
  Status s = shift_columns(columns, start.t, start.q, start.v, 1);
  if (s == Status::ok) s = columns.advance(t);
  if (s == Status::ok) s = shift_columns(columns, t, q, v, -1);
  if (contacts->cases() != cases_) contact_changes_.push_back(t);
  cases_ = contacts->cases();
  return s;
}

/// By the delays of a rebound.
Status GradientRun::shift_columns(Integrator& columns, double t, In q, In v,
                                  double sign) {
  if (!rebounds_ || rebounds_->delays().empty()) return Status::ok;
  const std::size_t n = q_.size();
  std::vector<double> a(n), dq(columns.q().begin(), columns.q().end()),
      dv(columns.v().begin(), columns.v().end());
  const Status s = variational_.contacts()->free_acceleration(t, q, v, a);
  if (s != Status::ok) return s;
  for (std::size_t k = 0; k < varied_.size(); ++k) {
    const double delay = sign * rebounds_->delays()[k];
    add(Out(dq).subspan(k * n, n), delay, v);
    add(Out(dv).subspan(k * n, n), delay, a);
  }
  add_counts(columns.stats(), before_);
  return columns.start(t, dq, dv);
}

void GradientRun::keep(const Integrator& run, const Integrator& columns) {
  t_ = run.time();
  q_.assign(run.q().begin(), run.q().end());
  v_.assign(run.v().begin(), run.v().end());
  dq_.assign(columns.q().begin(), columns.q().end());
  dv_.assign(columns.v().begin(), columns.v().end());
  stats_ = before_;
  add_counts(run.stats(), stats_);
  add_counts(columns.stats(), stats_);
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
