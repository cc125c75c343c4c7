#include "integrators/gradient/step_memory.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "contract/forms/stage_watcher.h"
#include "integrators/catalogue.h"
#include "integrators/fixed_step.h"

namespace tress::integrators {
namespace {

/// a + v/2 + q = 0 from q = v = 1, n times.
class Oscillators final : public System, public StageWatcher {
 public:
  explicit Oscillators(int n) : n_(n) {}

  Layout layout() const override { return {n_, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override { fill_both(q, v); }
  void scale(Out q_typ, Out v_typ) const override { fill_both(q_typ, v_typ); }
  Status residual(double /*t*/, In q, In v, In a, Out r) noexcept override {
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = a[i] + friction * v[i] + q[i];
    return Status::ok;
  }
  Status linearize(double /*t*/, In /*q*/, In /*v*/, In /*a*/,
                   Weights w) noexcept override {
    accelerates_ = accelerates_ || (w.vel == 0 && w.pos == 0);
    s_ = w.acc + w.vel * friction + w.pos;
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    std::ranges::transform(b, x.begin(), [this](double entry) { return entry / s_; });
    return Status::ok;
  }
  void solved(double /*t*/, In /*q*/, In /*v*/, In /*a*/,
              In /*lambda*/) noexcept override {
    seen_ = true;
  }
  /// Returns whether solutions of stages were seen.
  bool seen() const { return seen_; }
  /// Returns whether accelerations of a state were computed.
  bool accelerates() const { return accelerates_; }

 private:
  static constexpr double friction = 0.5;

  static void fill_both(Out q, Out v) {
    std::ranges::fill(q, 1.0);
    std::ranges::fill(v, 1.0);
  }

  int n_;
  double s_ = 1;
  bool seen_ = false, accelerates_ = false;
};

void require(Status status, const Integrator& run) {
  if (status != Status::ok) throw std::logic_error(run.failure());
}

/// A run of oscillators, and another one that continues it.
class ContinuedRun {
 public:
  ContinuedRun(std::string_view method, Options options, int n = 1)
      : oscillators_(n), run_(make(method, options)), continued_(make(method, options)) {
    std::vector<double> q(static_cast<std::size_t>(n)), v(q);
    oscillators_.initial_state(q, v);
    require(run_->start(0, q, v), *run_);
    require(run_->advance(steps * h), *run_);
    require(continued_->start(run_->time(), run_->q(), run_->v()), *continued_);
  }

  Integrator& run() { return *run_; }
  Integrator& continued() { return *continued_; }
  bool seen_stages() const { return oscillators_.seen(); }
  bool accelerates() const { return oscillators_.accelerates(); }

  /// Whether the next steps of both end at different states.
  bool parts() {
    // States are of size 1, and Newton's method leaves 1e-12 of it in some ten solutions.
    // bdf2 moves them by 1e-2, generalized_alpha by 4e-5.
    constexpr double seen = 1e-9;
    for (Integrator* one : {run_.get(), continued_.get()}) {
      require(one->advance((steps + 1) * h), *one);
    }
    return std::hypot(run_->q()[0] - continued_->q()[0],
                      run_->v()[0] - continued_->v()[0]) > seen;
  }

 private:
  // Steps in which a method of several steps has left its start.
  static constexpr int steps = 10;
  static constexpr double h = 0.125;

  std::unique_ptr<Integrator> make(std::string_view method, Options& options) {
    options.step = h;
    options.newton_tolerance = 1e-13;
    return make_integrator(method, oscillators_, options);
  }

  Oscillators oscillators_;
  std::unique_ptr<Integrator> run_, continued_;
};

FixedStep* fixed_step(Integrator& method) { return dynamic_cast<FixedStep*>(&method); }

/// Why a span of state() is no vector of n; empty: all are.
std::string other_span(std::string_view method, const Options& options, int n) {
  ContinuedRun runs(method, options, n);
  for (const InOut x : fixed_step(runs.run())->state()) {
    if (x.size() == static_cast<std::size_t>(n)) continue;
    return "state() of " + std::string(method) + " has a span of " +
           std::to_string(x.size()) +
           " numbers: return vectors of n, and single numbers by numbers()";
  }
  return {};
}

void copy_state(FixedStep& from, FixedStep& to) {
  const std::vector<InOut> old = from.state(), now = to.state();
  for (std::size_t k = 0; k < old.size(); ++k) {
    std::ranges::copy(old[k], now[k].begin());
  }
  const std::vector<double*> numbers = to.numbers();
  for (std::size_t k = 0; k < numbers.size(); ++k) *numbers[k] = *from.numbers()[k];
}

}  // namespace

bool remembers_steps(std::string_view method) { return ContinuedRun(method, {}).parts(); }

bool shows_stages(std::string_view method) {
  return ContinuedRun(method, {}).seen_stages();
}

bool starts_from_accelerations(std::string_view method) {
  return ContinuedRun(method, {}).accelerates();
}

std::string no_transposed_steps(std::string_view method, const Options& options) {
  const std::string id(method);
  Options own;
  own.own = options.own;
  ContinuedRun runs(method, own);
  if (fixed_step(runs.run()) == nullptr) {
    return id + " is no FixedStep, whose state() is all that the next step depends on";
  }
  for (const int n : {1, 2}) {  // a span may have one of these lengths
    if (std::string other = other_span(method, own, n); !other.empty()) return other;
  }
  copy_state(*fixed_step(runs.run()), *fixed_step(runs.continued()));
  if (!runs.parts()) return {};
  return "the next step of " + id +
         " depends on numbers that its state() and numbers() leave out";
}

}  // namespace tress::integrators
