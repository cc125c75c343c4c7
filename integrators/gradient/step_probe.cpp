#include "integrators/gradient/step_probe.h"

#include <algorithm>
#include <stdexcept>

#include "integrators/catalogue.h"
#include "integrators/gradient/run_phases.h"

namespace tress::integrators {
namespace {

void set_unit(InOut x, std::size_t k) {
  std::ranges::fill(x, 0.0);
  x[k] = 1;
}

/// The terms of x, without that of vector `own`.
StepTable::Combination terms(In x, std::size_t own) {
  StepTable::Combination all;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (x[k] != 0 && k != own) all.push_back({k, x[k]});
  }
  return all;
}

bool same(const StepTable::Combination& x, const StepTable::Combination& y) {
  return std::ranges::equal(x, y, [](const auto& a, const auto& b) {
    return a.vector == b.vector && a.factor == b.factor;
  });
}

}  // namespace

bool StepTable::operator==(const StepTable& other) const {
  return inputs == other.inputs && vectors == other.vectors &&
         std::ranges::equal(results, other.results, same) &&
         std::ranges::equal(
             operations, other.operations, [](const Operation& a, const Operation& b) {
               return a.kind == b.kind && a.first == b.first && a.w.vel == b.w.vel &&
                      a.w.pos == b.w.pos && std::ranges::equal(a.of, b.of, same);
             });
}

StepProbe::StepProbe(std::string_view method, const Options& options)
    : method_(make_integrator(method, *this, linear_options(options))),
      fixed_(dynamic_cast<FixedStep&>(*method_)) {}

StepTable StepProbe::start(double t) {
  std::vector<double> q(static_cast<std::size_t>(most_vectors)), v(q);
  begin(2);
  for (const InOut x : fixed_.state()) std::ranges::fill(x, 0.0);
  set_unit(q, 0);
  set_unit(v, 1);
  if (method_->start(t, q, v) != Status::ok) throw std::logic_error(method_->failure());
  return taken();
}

StepTable StepProbe::step(double t, const WatchedSystem& run) {
  const std::vector<InOut> state = fixed_.state();
  begin(state.size());
  for (std::size_t k = 0; k < state.size(); ++k) set_unit(state[k], k);
  moves_ = run.moved();
  to_carry_ = run.carried().size();
  if (method_->advance(t) != Status::ok) throw std::logic_error(method_->failure());
  return taken();
}

void StepProbe::go_to(double t, In numbers) {
  start(t);
  std::size_t next = 0;
  for (double* x : fixed_.numbers()) *x = numbers[next++];
}

void StepProbe::begin(std::size_t inputs) {
  table_ = {};
  table_.inputs = next_ = inputs;
  moves_ = false;
  to_carry_ = 0;
}

StepTable StepProbe::taken() {
  table_.vectors = next_;
  for (const InOut x : fixed_.state()) table_.results.push_back(terms(x, next_));
  return std::move(table_);
}

/// Of an operation whose results are the next vectors, and may be in its arguments.
void StepProbe::note(Kind kind, std::array<In, 3> of, Weights w) const {
  StepTable::Operation& one = table_.operations.emplace_back();
  one.kind = kind;
  for (std::size_t k = 0; k < of.size(); ++k) one.of[k] = terms(of[k], next_);
  one.w = w;
  one.first = next_;
}

void StepProbe::give(InOut x) const { set_unit(x, next_++); }

void StepProbe::initial_state(Out q, Out v) const {
  std::ranges::fill(q, 0.0);
  std::ranges::fill(v, 0.0);
}

void StepProbe::scale(Out q_typ, Out v_typ) const {
  std::ranges::fill(q_typ, 1.0);
  std::ranges::fill(v_typ, 1.0);
}

Status StepProbe::residual(double, In, In, In a, Out r) noexcept {
  std::ranges::copy(a, r.begin());
  r[next_] -= 1;
  return Status::ok;
}

Status StepProbe::linearize(double, In, In, In, Weights) noexcept { return Status::ok; }

Status StepProbe::solve(In b, Out x) noexcept {
  if (b.data() != x.data()) std::ranges::copy(b, x.begin());
  return Status::ok;
}

void StepProbe::solved(double, In q, In v, In, In) noexcept {
  note(Kind::stage, {q, v, {}}, {1, v[next_], q[next_]});
  ++next_;
}

Status StepProbe::acceleration(double, In q, In v, Out a) noexcept {
  note(Kind::acceleration, {q, v, {}}, {1, 0, 0});
  give(a);
  return Status::ok;
}

bool StepProbe::accept(double, InOut q, InOut v) {
  if (!moves_) return false;
  note(Kind::accept, {q, v, {}}, {});
  give(q);
  give(v);
  return true;
}

bool StepProbe::carry(double, InOut q, InOut v, InOut a) const {
  if (to_carry_ == 0) return false;
  --to_carry_;
  note(Kind::carry, {q, v, a}, {});
  give(q);
  give(v);
  give(a);
  return true;
}

}  // namespace tress::integrators
