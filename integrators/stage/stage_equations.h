#pragma once

#include <vector>

#include "integrators/stage/newton_rules.h"
#include "integrators/stage/unknowns.h"

namespace tress::integrators {

/// Equations of one implicit stage as a function of the unknowns x = (a, lambda),
///
///     F(x) = (r(t, q, v, a) - G^T lambda, c) = 0,  q = q_bar + w.pos a,  v = v_bar +
///     w.vel a
///
/// or those of a part s of the step, with t - left in place of t and
///
///     q = q_bar - left v_bar + s^2 w.pos a,  v = v_bar + s w.vel a.
///
/// All solution methods of a stage share them, and the state q(), v() at which they are
/// evaluated.
class StageEquations {
 public:
  /// The force-free motion of a part of the step. `whole`: that of the whole step, left =
  /// 0. `own`: left = (1 - s) w.pos/w.vel, so that the part starts where the step does.
  enum class Drift { whole, own };

  /// Allocates for a system, which must outlive it.
  StageEquations(Dynamics& system, const NewtonRules& endings, int most_iterations)
      : dynamics(system),
        rules(endings),
        iterations(most_iterations),
        q_part_(size(dynamics.n())),
        q_(q_part_.size()),
        v_(q_part_.size()) {}

  Dynamics& dynamics;       // system with the form of its constraints
  const NewtonRules rules;  // tolerances of Newton's method
  const int iterations;     // of Newton's method

  /// Poses the equations of a stage. The spans must last until the next call.
  void pose(double t, In q_bar, In v_bar, Weights w) noexcept {
    whole_ = {t, q_bar, w};
    v_bar_ = v_bar;
    now_ = whole_;
  }
  /// Selects the equations of the whole step.
  void take_whole() noexcept { now_ = whole_; }
  /// Selects the equations of a part of the step, 0 to 1.
  void take_part(double part, Drift drift) noexcept {
    const Weights w = whole_.w;
    const double left = drift == Drift::own ? (1 - part) * w.pos / w.vel : 0;
    shifted(q_part_, whole_.q_bar, -left, v_bar_);
    now_ = {whole_.t - left, q_part_, {w.acc, part * w.vel, part * part * w.pos}};
  }

  /// Moves q() and v() to those of x.
  void place(const Unknowns& x) noexcept {
    for (std::size_t i = 0; i < q_.size(); ++i) {
      q_[i] = now_.q_bar[i] + now_.w.pos * x.a[i];
      v_[i] = v_bar_[i] + now_.w.vel * x.a[i];
    }
  }

  // At q() and v(), those of x.
  /// Evaluates F(x) at q() and v(), which must be those of x.
  Status residual(const Unknowns& x, Unknowns& f) noexcept {
    return dynamics.residual(now_.t, q_, v_, x.a, x.lambda, f.a, f.lambda);
  }
  /// Builds the matrix at q() and v(), those of x.
  Status linearize(const Unknowns& x) noexcept { return linearize(x.a, x.lambda); }
  /// Builds the matrix at q() and v() for these accelerations and multipliers.
  Status linearize(In a, In lambda) noexcept {
    return dynamics.linearize(now_.t, q_, v_, a, lambda, now_.w);
  }
  /// x becomes S^-1 x, with S as the last linearize() left it.
  Status solve(Unknowns& x) noexcept { return dynamics.solve(x.a, x.lambda); }
  /// The correction by the matrix of the last linearize(); x + correction is nearer if it
  /// is subtracted.
  Status correction(const Unknowns& x, Unknowns& step) noexcept {
    const Status s = residual(x, step);
    return s == Status::ok ? solve(step) : s;
  }
  /// Newton's correction, with the matrix of x itself, and its size.
  Status newton_correction(const Unknowns& x, Unknowns& step, double& size) noexcept;

  /// Largest change of q and v over System::scale, under the weights of now or others.
  double size_of(const Unknowns& step) const noexcept { return size_of(step, now_.w); }
  /// Returns the largest change of q and v over System::scale under weights `w`.
  double size_of(const Unknowns& step, Weights w) const noexcept;
  /// Scalar product over System::scale.
  double dot(In x, In y) const noexcept;

  /// Returns the coordinates at which the equations are evaluated.
  In q() const { return q_; }
  /// Returns the rates at which the equations are evaluated.
  In v() const { return v_; }
  /// Returns the rates of the stage without its acceleration.
  In v_bar() const { return v_bar_; }
  /// Returns the time of the selected equations, s.
  double t() const { return now_.t; }
  /// Returns the weights of the selected equations.
  Weights w() const { return now_.w; }
  /// Returns the weights of the whole step.
  Weights whole_w() const { return whole_.w; }
  /// The position at the start of the whole step, from which v_bar leads to q_bar.
  void start(Out q) const noexcept {
    shifted(q, whole_.q_bar, -(whole_.w.pos / whole_.w.vel), v_bar_);
  }

 private:
  struct Posed {
    double t = 0;
    In q_bar;
    Weights w;
  };

  Posed whole_, now_;
  In v_bar_;
  std::vector<double> q_part_, q_, v_;
};

}  // namespace tress::integrators
