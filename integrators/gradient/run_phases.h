#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "contract/integrator.h"

namespace tress::integrators {

/// The steps of a run until its next stop: equal ones, each divided into equal parts.
struct EqualSteps {
  double count, h;  // number of parts, length of a part in s
  bool allowed;     // by Options::max_steps

  /// Steps that FixedStep takes over a span, with its 1e-9 for rounding.
  EqualSteps(double span, const Options& options, int parts) {
    const double whole = std::max(1.0, std::ceil(span / options.step - 1e-9));
    count = parts * whole;
    h = span / count;
    allowed = whole <= static_cast<double>(options.max_steps);
  }
};

/// Advances from t to t_end by this number of equal steps, one after the other.
template <class Advance>
Status take_equal_steps(double count, double t, double t_end, Advance advance) {
  Status s = Status::ok;
  for (double i = 1; i <= count && s == Status::ok; ++i) {
    s = advance(i == count ? t_end : t + i * ((t_end - t) / count));
  }
  return s;
}

/// The method of a damped start (GradientStart): some steps of a part of the step each.
struct DampedStart {
  static constexpr std::string_view method = "backward_euler";  // id of the integrator
  /// Length of its steps over that of the run.
  static constexpr double part = 1.0 / 16;
  static constexpr int steps = 2;  // number of steps

  /// Returns the options of a run with its step shortened, without options of its method.
  static Options options(Options of_run) {
    of_run.step *= part;
    of_run.own.clear();
    return of_run;
  }
  /// End of these steps before a run that begins at t with steps of h.
  static double end(double t, double h) { return t + steps * part * h; }
};

/// Options of linear equations that a method solves in the steps of a run: the first
/// correction is the solution, and every advance() is one step.
inline Options linear_options(Options of_run) {
  constexpr double any = 1e200, one_step = 1e30;
  of_run.newton_tolerance = any;
  of_run.refresh = Refresh::every_iteration;
  of_run.formulation = Formulation::parametric;
  of_run.step = one_step;
  of_run.max_work = 0;
  return of_run;
}

/// Options under which constraints give accelerations.
inline Options acceleration_options(Options of_run) {
  of_run.formulation = Formulation::acceleration;
  return of_run;
}

}  // namespace tress::integrators
