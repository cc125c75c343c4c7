#include "integrators/stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress {
namespace {

// A kept matrix is rebuilt when corrections shrink by less than this per iteration.
constexpr double slow_rate = 0.3;

// Corrections that stop shrinking are rounding when they are this close to the tolerance.
constexpr double stagnation_factor = 1e4;

}  // namespace

Stage::Stage(Dynamics& dynamics, const Options& options)
    : dynamics_(dynamics),
      tolerance_(options.newton_tolerance),
      iterations_(options.newton_iterations),
      refresh_(options.refresh),
      q_(static_cast<std::size_t>(dynamics.n())),
      v_(q_.size()),
      r_(q_.size()),
      c_(static_cast<std::size_t>(dynamics.m())) {}

void Stage::place(In q_bar, In v_bar, Weights w, In a) noexcept {
  for (std::size_t i = 0; i < q_.size(); ++i) {
    q_[i] = q_bar[i] + w.pos * a[i];
    v_[i] = v_bar[i] + w.vel * a[i];
  }
}

Status Stage::correct(double t, In q_bar, In v_bar, Weights w, bool linearize, InOut a,
                      InOut lambda, double& correction) noexcept {
  if (linearize) {
    factored_ = {};
    const Status s = dynamics_.linearize(t, q_, v_, a, lambda, w);
    if (s != Status::ok) return s;
    factored_ = w;
  }
  Status s = dynamics_.residual(t, q_, v_, a, lambda, r_, c_);
  if (s != Status::ok) return s;
  s = dynamics_.solve(r_, c_);
  if (s != Status::ok) return s;
  ++dynamics_.stats.newton_iterations;
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= r_[i];
  for (std::size_t k = 0; k < lambda.size(); ++k) lambda[k] -= c_[k];
  place(q_bar, v_bar, w, a);
  correction = std::max(w.pos * scaled_norm(r_, dynamics_.q_typ()),
                        w.vel * scaled_norm(r_, dynamics_.v_typ()));
  return std::isfinite(correction) ? Status::ok : Status::retry;
}

Status Stage::solve(double t, In q_bar, In v_bar, Weights w, InOut a,
                    InOut lambda) noexcept {
  place(q_bar, v_bar, w, a);
  double previous = std::numeric_limits<double>::infinity();
  double rate = 1;
  const bool same_matrix = factored_.vel == w.vel && factored_.pos == w.pos;
  bool linearize = refresh_ != Refresh::when_slow || factored_.acc == 0 || !same_matrix;
  for (int i = 0; i < iterations_; ++i) {
    double correction = 0;
    const Status s = correct(t, q_bar, v_bar, w, linearize, a, lambda, correction);
    if (s != Status::ok) return s;
    rate = correction / previous;
    // The error left is the sum of the corrections to come: rate / (1 - rate) of this
    // one. The first correction has no rate yet.
    const double error_left =
        i > 0 && rate < 1 ? correction * rate / (1 - rate) : correction;
    if (correction <= tolerance_ || error_left <= 0.1 * tolerance_) return Status::ok;
    if (rate > 0.5 && i >= 2 && correction <= stagnation_factor * tolerance_) {
      return Status::ok;
    }
    linearize = refresh_ == Refresh::every_iteration ||
                (refresh_ == Refresh::when_slow && i > 0 && rate > slow_rate);
    previous = correction;
  }
  factored_ = {};
  return Status::retry;
}

Status Stage::single_step(double t, In q_bar, In v_bar, Weights w, InOut a,
                          InOut lambda) noexcept {
  place(q_bar, v_bar, w, a);
  double correction = 0;
  return correct(t, q_bar, v_bar, w, true, a, lambda, correction);
}

}  // namespace tress
