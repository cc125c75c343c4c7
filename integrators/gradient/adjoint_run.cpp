#include "integrators/gradient/adjoint_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contract/forms/material_points.h"
#include "contract/input_error.h"
#include "integrators/gradient/run_phases.h"
#include "integrators/gradient/step_memory.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

using Kind = StepTable::Operation::Kind;

bool all_zero(In x) {
  return std::ranges::all_of(x, [](double entry) { return entry == 0; });
}

System& with_adjoint(System& system, const GradientRun::Method& method) {
  with_gradient(system, method);
  const std::string reason = no_adjoint(system, method.id, method.options);
  if (reason.empty()) return system;
  throw InputError("no adjoint of this run: " + reason,
                   "method " + std::string(method.id), "use GradientRun");
}

}  // namespace

std::string no_adjoint(System& system, std::string_view method, const Options& options) {
  if (system.contact_form() != nullptr) {
    return "the derivatives of exact contact are computed forward";
  }
  return no_transposed_steps(method, options);
}

AdjointRun::AdjointRun(System& system, std::unique_ptr<System> exact,
                       std::span<const RunParameter> parameters,
                       const GradientRun::Method& method, std::size_t record_bytes)
    : method_(method),
      system_(with_adjoint(system, method)),
      exact_(std::move(exact)),
      record_bytes_(record_bytes),
      n_(size(system.layout().coordinates)),
      run_(system, method),
      again_(*exact_, method),
      parameters_(*exact_, parameters, method.options, method.forces),
      stages_(*exact_, method.options, method.forces),
      q_hat_(n_),
      v_hat_(n_) {
  if (stages_.m() > 0) {
    starts_.emplace(*exact_, acceleration_options(method.options),
                    KnownForces{false, method.forces.quadratic});
  }
  for (auto* x : {&motion_.q, &motion_.v, &motion_.a}) x->resize(n_);
  motion_.lambda.resize(stages_.m());
}

Status AdjointRun::start() {
  system_.reset();
  failure_.clear();
  frames_moved_ = false;
  events_.clear();
  parts_.clear();
  stops_.clear();
  std::vector<double> q(n_), v(n_);
  system_.initial_state(q, v);
  if (system_.accept(0, q, v)) {
    return frames_have_moved();
  }
  damping_ = method_.start == GradientStart::damped;
  const Status s = begin(damping_ ? 0 : 1, 0, q, v);
  if (s == Status::ok) stop();
  return s;
}

/// A method begins with a part of its own, which no number of the method precedes.
Status AdjointRun::begin(std::size_t method, double t, In q, In v) {
  parts_.push_back({events_.size(), {method, t, {}, system_.memory()}});
  parts_.back().from.state.assign(q.begin(), q.end());
  parts_.back().from.state.insert(parts_.back().from.state.end(), v.begin(), v.end());
  tape_.clear();
  on_tape_ = parts_.size() - 1;
  const Status s = run_.begin(method, t, q, v, tape_);
  if (s != Status::ok) return fail(s, run_.failure());
  events_.push_back({t, true});
  memory_ = system_.memory();
  return Status::ok;
}

Status AdjointRun::advance(double t_end) {
  Status s = on_tape_ + 1 == parts_.size() ? Status::ok : repeat(parts_.size() - 1);
  const EqualSteps steps(t_end - time(), method_.options, method_.parts);
  if ((!damping_ && method_.parts == 1) || !steps.allowed) {
    if (s == Status::ok) s = advance_by(t_end);
  } else {
    if (damping_ && s == Status::ok) s = damped_start(steps.h);
    if (s == Status::ok) s = advance_in(steps.count, t_end);
  }
  if (s == Status::ok) stop();
  return s;
}

Status AdjointRun::damped_start(double h) {
  Status s = advance_in(DampedStart::steps, DampedStart::end(time(), h));
  damping_ = false;
  if (s != Status::ok) return s;
  const std::vector<double> q(this->q().begin(), this->q().end());
  const std::vector<double> v(this->v().begin(), this->v().end());
  return begin(1, time(), q, v);
}

Status AdjointRun::advance_in(double count, double t_end) {
  return take_equal_steps(count, time(), t_end,
                          [this](double t) { return advance_by(t); });
}

/// The record goes on in a new part when it is full.
Status AdjointRun::advance_by(double t_end) {
  const Status s = run_.advance(t_end, tape_, [this](double t) {
    events_.push_back({t, false});
    memory_ = system_.memory();
    if (record_bytes() < record_bytes_) return;
    parts_.push_back({events_.size(), run_.place()});
    on_tape_ = parts_.size() - 1;
    tape_.clear();
  });
  stats_ = run_.stats();
  return s == Status::ok ? s : fail(s, run_.failure());
}

void AdjointRun::stop() {
  stops_.push_back({events_.size(), time(), {q().begin(), q().end()}});
}

Status AdjointRun::fail(Status s, std::string why) {
  failure_ = std::move(why);
  return s;
}

Status AdjointRun::frames_have_moved() {
  frames_moved_ = true;
  return fail(
      Status::fatal,
      "reference frames moved, whose motion has no transposed derivative: use the "
      "derivatives forward in time");
}

std::size_t AdjointRun::record_bytes() const { return tape_.doubles() * sizeof(double); }

/// Writes the record of a part by taking its steps again.
Status AdjointRun::repeat(std::size_t part) {
  const Part& from = parts_[part];
  const std::size_t end =
      part + 1 < parts_.size() ? parts_[part + 1].first : events_.size();
  tape_.clear();
  on_tape_ = part;
  Status s = Status::ok;
  std::size_t next = from.first;
  if (next < end && events_[next].begins) {
    exact_->recall(from.from.memory);
    s = again_.begin(from.from.method, from.from.t, In(from.from.state).first(n_),
                     In(from.from.state).subspan(n_), tape_);
    ++next;
  } else {
    s = again_.go_to(from.from);
  }
  for (; next < end && s == Status::ok; ++next) {
    s = again_.advance(events_[next].t, tape_, [](double) {});
  }
  memory_ = exact_->memory();
  return s == Status::ok ? s : fail(s, "a step repeated: " + again_.failure());
}

Status AdjointRun::sweep(std::size_t numbers, const Seed& seed, Out by) {
  parameters_.begin(numbers);
  hat_.assign(numbers, {});
  inside_.assign(numbers, {});
  x_.assign(numbers, std::vector<double>(n_ + stages_.m()));
  next_stop_ = stops_.size();
  for (std::size_t part = parts_.size(); part-- > 0;) {
    Status s = part == on_tape_ ? Status::ok : repeat(part);
    if (s == Status::ok) s = sweep_part(part, seed);
    if (s != Status::ok) return s;
  }
  std::vector<In> q_hat, v_hat;
  for (const Vectors& one : hat_) {
    q_hat.emplace_back(one[0]);
    v_hat.emplace_back(one[1]);
  }
  parameters_.pull_start(*exact_, q_hat, v_hat);
  parameters_.write(by);
  return Status::ok;
}

Status AdjointRun::sweep_part(std::size_t part, const Seed& seed) {
  std::vector<double> memory = memory_;
  recall(memory);
  const auto& steps = tape_.steps();
  if (steps.empty()) return Status::ok;
  if (hat_.front().empty()) {
    const std::size_t vectors = steps.back().table->results.size();
    for (Vectors& one : hat_) one.assign(vectors, std::vector<double>(n_));
  }
  for (std::size_t k = steps.size(); k-- > 0;) {
    add_seeds(parts_[part].first + k + 1, seed);
    tape_.step_back(steps[k], memory);
    recall(memory);
    if (const Status s = step_back(steps[k]); s != Status::ok) return s;
  }
  return Status::ok;
}

void AdjointRun::recall(In memory) {
  if (memory.empty()) return;
  exact_->recall(memory);
  parameters_.recall(memory);
}

/// Of the stops after this number of events.
void AdjointRun::add_seeds(std::size_t events, const Seed& seed) {
  const std::size_t length = 3 * size(exact_->material_points()->count());
  for (; next_stop_ > 0 && stops_[next_stop_ - 1].events == events; --next_stop_) {
    const Stop& stop = stops_[next_stop_ - 1];
    Vectors x_hat(hat_.size(), std::vector<double>(length));
    for (std::size_t s = 0; s < hat_.size(); ++s) seed(s, next_stop_ - 1, x_hat[s]);
    if (std::ranges::all_of(x_hat, all_zero)) continue;
    parameters_.pull_points(*exact_, stop.t, stop.q, x_hat);
    pull_back_points(stop, x_hat);
  }
}

/// q_hat += J^T x_hat. Without MaterialPoints::pull_back(), column k of J is the velocity
/// of the points at v = e_k less that at rest.
void AdjointRun::pull_back_points(const Stop& at, const Vectors& x_hat) {
  MaterialPoints& points = *exact_->material_points();
  std::vector<int> all(size(points.count()));
  std::iota(all.begin(), all.end(), 0);
  bool closed_form = true;
  for (std::size_t s = 0; s < hat_.size() && closed_form; ++s) {
    if (all_zero(x_hat[s])) continue;
    closed_form = points.pull_back(at.t, at.q, all, x_hat[s], hat_[s][0]);
  }
  if (closed_form) return;
  std::vector<double> unit(n_), rest(x_hat.front().size()), u(rest);
  points.velocities(at.t, at.q, unit, rest);
  for (std::size_t k = 0; k < n_; ++k) {
    unit[k] = 1;
    points.velocities(at.t, at.q, unit, u);
    unit[k] = 0;
    add(u, -1, rest);
    for (std::size_t s = 0; s < hat_.size(); ++s) {
      hat_[s][0][k] += scalar_product(u, x_hat[s]);
    }
  }
}

void AdjointRun::distribute(const StepTable::Combination& of, In x, Vectors& to) const {
  for (const auto& [vector, factor] : of) add(to[vector], factor, x);
}

Status AdjointRun::step_back(const Tape::Step& step) {
  const StepTable& table = *step.table;
  for (std::size_t s = 0; s < hat_.size(); ++s) {
    inside_[s].resize(table.vectors);
    for (auto& one : inside_[s]) one.assign(n_, 0.0);
    for (std::size_t j = 0; j < table.results.size(); ++j) {
      distribute(table.results[j], hat_[s][j], inside_[s]);
    }
  }
  for (std::size_t k = table.operations.size(); k-- > 0;) {
    tape_.read(step, k, motion_);
    if (const Status s = back(table.operations[k]); s != Status::ok) return s;
  }
  for (std::size_t s = 0; s < hat_.size(); ++s) {
    hat_[s].resize(table.inputs);
    for (std::size_t j = 0; j < table.inputs; ++j) hat_[s][j].swap(inside_[s][j]);
  }
  return Status::ok;
}

Status AdjointRun::back(const Operation& operation) {
  const auto no_share = [&](const Vectors& one) {
    return all_zero(one[operation.first]);
  };
  if (operation.kind == Kind::accept || operation.kind == Kind::carry) {
    return frames_have_moved();
  }
  if (std::ranges::all_of(inside_, no_share)) return Status::ok;
  const bool starts = operation.kind == Kind::acceleration;
  TransposedEquations& equations = starts && starts_ ? *starts_ : stages_;
  Status status = Status::ok;
  if (starts) status = equations.accelerate(motion_);
  if (status == Status::ok) status = equations.move(motion_, operation.w);
  for (std::size_t s = 0; s < hat_.size() && status == Status::ok; ++s) {
    if (no_share(inside_[s])) {  // of a number of an earlier time
      std::ranges::fill(x_[s], 0.0);
      continue;
    }
    std::ranges::copy(inside_[s][operation.first], x_[s].begin());
    status = equations.solve(x_[s]);
    if (status != Status::ok) break;
    parameters_.pull_constants(motion_, equations.products(), s, x_[s]);
    std::ranges::fill(q_hat_, 0.0);
    std::ranges::fill(v_hat_, 0.0);
    equations.pull(x_[s], q_hat_, v_hat_);
    distribute(operation.of[0], q_hat_, inside_[s]);
    distribute(operation.of[1], v_hat_, inside_[s]);
  }
  if (status == Status::ok) status = parameters_.pull(motion_, starts, x_);
  return status == Status::ok
             ? status
             : fail(status, "the transposed equations of a stage are singular");
}

}  // namespace tress::integrators
