#include "integrators/gradient/step_memory.h"

#include <cmath>
#include <stdexcept>

#include "integrators/catalogue.h"

namespace tress::integrators {
namespace {

/// a + v/2 + q = 0 from q = v = 1.
class Oscillator final : public System {
 public:
  Layout layout() const override { return {1, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override { q[0] = v[0] = 1; }
  void scale(Out q_typ, Out v_typ) const override { q_typ[0] = v_typ[0] = 1; }
  Status residual(double /*t*/, In q, In v, In a, Out r) noexcept override {
    r[0] = a[0] + friction * v[0] + q[0];
    return Status::ok;
  }
  Status linearize(double /*t*/, In /*q*/, In /*v*/, In /*a*/,
                   Weights w) noexcept override {
    s_ = w.acc + w.vel * friction + w.pos;
    return Status::ok;
  }
  Status solve(In b, Out x) noexcept override {
    x[0] = b[0] / s_;
    return Status::ok;
  }

 private:
  static constexpr double friction = 0.5;
  double s_ = 1;
};

void require(Status status, const Integrator& run) {
  if (status != Status::ok) throw std::logic_error(run.failure());
}

}  // namespace

bool remembers_steps(std::string_view method) {
  // Steps in which a method of several steps has left its start.
  constexpr int steps = 10;
  constexpr double h = 0.125;
  // States are of size 1, and Newton's method leaves 1e-12 of it in some ten solutions.
  // bdf2 moves them by 1e-2, generalized_alpha by 4e-5.
  constexpr double seen = 1e-9;
  Options options;
  options.step = h;
  options.newton_tolerance = 1e-13;
  Oscillator oscillator;
  double q = 0, v = 0;
  oscillator.initial_state({&q, 1}, {&v, 1});
  const auto run = make_integrator(method, oscillator, options);
  require(run->start(0, {&q, 1}, {&v, 1}), *run);
  require(run->advance(steps * h), *run);
  const auto restarted = make_integrator(method, oscillator, options);
  require(restarted->start(run->time(), run->q(), run->v()), *restarted);
  for (Integrator* one : {run.get(), restarted.get()}) {
    require(one->advance((steps + 1) * h), *one);
  }
  return std::hypot(run->q()[0] - restarted->q()[0], run->v()[0] - restarted->v()[0]) >
         seen;
}

}  // namespace tress::integrators
