#include "integrators/stage/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::integrators {
namespace {

// A matrix is rebuilt where more iterations than this are to come at the present rate.
// An exact Jacobian costs as much as six of them, and two follow it.
constexpr double most_to_come = 8;

}  // namespace

Newton::Newton(StageEquations& equations, StressOrigin& stresses, Refresh refresh,
               const NewtonEnding& ending, bool contacts)
    : equations_(equations),
      stresses_(stresses),
      refresh_(refresh),
      turned_(ending.turned),
      contacts_(contacts),
      foresees_(contacts && equations.rules.left < equations.rules.tolerance),
      step_(equations.dynamics) {
  if (ending.learns) updates_.emplace(equations.dynamics.q_typ());
}

Status Newton::solve(const Unknowns& guess, Matrix matrix, Unknowns& x) noexcept {
  x = guess;
  Status s = iterate(refresh_, matrix, true, x);
  if (s == Status::retry && refresh_ != Refresh::every_iteration) {
    x = guess;
    s = iterate(Refresh::every_iteration, Matrix::own, true, x);
  }
  if (s == Status::retry && stresses_.exists()) {
    // The stresses of the last state may be far from the solution's too: a rope that is
    // first pulled has none.
    x = guess;
    s = iterate(Refresh::every_iteration, Matrix::own, false, x);
  }
  return s;
}

Status Newton::single_step(In a_matrix, Unknowns& x) noexcept {
  equations_.place(x);
  const Status s = equations_.linearize(a_matrix, x.lambda);
  if (s != Status::ok) return s;
  double correction = 0;
  return correct(false, x, correction);
}

Status Newton::correct(bool linearize, Unknowns& x, double& correction) noexcept {
  if (linearize) {
    const Status s = equations_.linearize(x);
    if (s != Status::ok) return s;
    factored_ = equations_.w();
    matrix_ = equations_.dynamics.matrix();
    if (updates_) updates_->forget();
  }
  const Status s = equations_.correction(x, step_);
  if (s != Status::ok) return s;
  ++equations_.dynamics.stats.newton_iterations;
  if (updates_) updates_->improve(step_.a);
  stresses_.correct_from(equations_.q());
  x.become(x, -1, step_);
  equations_.place(x);
  correction = equations_.size_of(step_);
  return std::isfinite(correction) ? Status::ok : Status::retry;
}

Status Newton::iterate(Refresh refresh, Matrix matrix, bool stresses,
                       Unknowns& x) noexcept {
  const NewtonRules& rules = equations_.rules;
  equations_.place(x);
  if (updates_) updates_->begin();
  double previous = std::numeric_limits<double>::infinity();
  rate_ = 0;
  int grown = 0;
  const Weights w = equations_.w();
  const bool usable = matrix_ == equations_.dynamics.matrix() && factored_.vel == w.vel &&
                      factored_.pos == w.pos;
  if (matrix == Matrix::own) shares_ = true;
  const bool shared =
      refresh == Refresh::every_step && shares_ && matrix == Matrix::shared;
  bool linearize = !usable || !(refresh == Refresh::when_slow || shared);
  for (int i = 0; i < equations_.iterations; ++i) {
    double correction = 0;
    if (linearize && stresses) {
      i == 0 ? stresses_.hold() : stresses_.follow(equations_.t());
    }
    const bool foreseen = linearize && squared_ > 0;
    const Status s = correct(linearize, x, correction);
    if (s != Status::ok) return s;
    const double rate = rate_ = correction / previous;
    // The remaining error is the sum of the corrections to come: rate / (1 - rate) of
    // this one.
    double expected = rate;
    if (foreseen) {
      const double next = squared_ * correction;
      expected = i > 0 ? std::min(next, rate) : next;
    }
    const double error_left = expected > 0 && expected < 1
                                  ? NewtonRules::error_left(correction, expected)
                                  : correction;
    if (i > 0 && linearize && foresees_) {
      squared_ = std::max(i > 1 ? squared_ : 0.0, rate / previous);
    }
    if (correction <= rules.tolerance) return Status::ok;
    const bool near = error_left <= rules.left;
    if (near && !contacts_) return Status::ok;
    if (rules.stagnates(correction, rate, i)) return Status::ok;
    if (rate > 1 && i > 0 && ++grown == most_grown) return Status::retry;
    const bool slow = i > 0 && (rate >= 1 || std::log(rules.left / correction) <
                                                 most_to_come * std::log(rate));
    linearize = !near && (refresh == Refresh::every_iteration || slow ||
                          ((i == 0 || linearize) && correction > turned_));
    if (slow) shares_ = false;
    previous = correction;
  }
  return Status::retry;
}

}  // namespace tress::integrators
