#include "integrators/controlled_stage.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace tress::integrators {
namespace {

/// Newton's tolerance over that of the run. Stages enter the estimate with weights of
/// order one, so that a hundredth of the tolerance is not seen in it. Where a strand
/// sticks, where multipliers hold it and where stretch drives the next step, more is
/// seen.
constexpr double newton_part = 1e-2;
/// Of smooth equations in reduced coordinates, whose stiff part is linear and is in the
/// matrix: what an iteration leaves is slow motion. Ten times as much as a hundredth
/// makes a strand gain energy that swings undamped for 150 s (million_steps of
/// hard_cases).
constexpr double smooth_newton_part = 0.03;
/// Of exact contact: what iterations leave lifts a strand off a stiff surface, where it
/// has no friction. On a slope at 97 % of the friction, esdirk43 at 1e-3 takes 32 steps
/// and moves by 10 um with this, 82 steps and 163 um with 1e-2 (super_helix, compliant).
constexpr double contact_newton_part = 1e-3;
/// Tolerance from which a matrix is out of date after the first correction, because the
/// corrections of points are large. New matrices in every iteration take a tenth less
/// time for tr_bdf2 at 1e-2 and a tenth more at 2e-3. (der on scenes/accuracy.)
constexpr double loose_tolerance = 3e-3;
/// Below, after a correction that turns an edge by so much: a fifth less work for
/// esdirk43 at 1e-3 than without. A tenth of a radian saves another tenth, but ends
/// iterations so early that a rod that swings undamped for 150 s gains energy
/// (million_steps of hard_cases).
constexpr double turned_edge = 0.5;

/// Tolerance over the threshold of a step from which Newton's tolerance follows the
/// threshold. Errors of iterations add up over the steps as the error of the method
/// does, and the steps of order 2 are many at tight tolerances.
constexpr double most_thresholds = 10;

/// Coordinates of constant mass are those of points, and so are those whose edges
/// stretch.
bool of_points(Dynamics& dynamics) {
  System& system = dynamics.system();
  return system.traits().constant_mass || system.stress_form() != nullptr;
}

bool smooth(Dynamics& dynamics) {
  return !of_points(dynamics) && dynamics.m() == 0 &&
         dynamics.system().contact_form() == nullptr;
}

}  // namespace

void check_controlled(System& system, const Options& options, Contact of_method) {
  if (options.formulation == Formulation::index3) {
    throw InputError("no error control on index 3", "position_tol_rel",
                     "use projection, or a fixed step");
  }
  if (of_method == Contact::regular && system.contact_form() != nullptr) {
    throw InputError("a multistep method has no error control with exact contact",
                     "position_tol_rel", "use tr_bdf2, esdirk43 or a fixed step");
  }
}

Options controlled_options(Dynamics& dynamics, Options options, double threshold) {
  options.newton_tolerance =
      (smooth(dynamics)                              ? smooth_newton_part
       : dynamics.system().contact_form() != nullptr ? contact_newton_part
                                                     : newton_part) *
      std::min(options.tolerance, most_thresholds * threshold);
  options.refresh = of_points(dynamics) && options.tolerance >= loose_tolerance
                        ? Refresh::every_iteration
                        : Refresh::every_step;
  return options;
}

Stage::Ending controlled_ending(Dynamics& dynamics) {
  Stage::Ending ending{.remaining = 1, .learns = smooth(dynamics)};
  if (of_points(dynamics)) ending.turned = turned_edge;
  return ending;
}

double second_order_threshold(const Options& options, double share) {
  return std::pow(share * options.tolerance, second_order_power / 2);
}

}  // namespace tress::integrators
