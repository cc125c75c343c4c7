#pragma once

#include <algorithm>
#include <string_view>

#include "contract/integrator.h"

namespace tress::integrators {

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
  /// End of these steps before a run from t to t_end, or a part of it.
  static double end(double t, double t_end, double step) {
    return t + steps * part * std::min(step, t_end - t);
  }
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
