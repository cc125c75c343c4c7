#pragma once

#include <string_view>

#include "contract/integrator.h"

/// Methods, models and ladders of the rows about strands.
namespace tress::experiments::work_precision {

/// Accuracy and matrix of the solution of a step's equations. Tolerances are over
/// System::scale: 0.3 is a curvature of 0.3 over the length of the strand.
struct Newton {
  Refresh refresh = Refresh::every_iteration;
  double tolerance = 0;  // 0: the method does not iterate, or SUNDIALS does
};
inline constexpr Newton converged{Refresh::every_iteration, 1e-10};
inline constexpr Newton loose{Refresh::every_step, 0.3};
inline constexpr Newton tight{Refresh::every_step, 1e-6};
inline constexpr Newton lazy{Refresh::when_slow, 0.1};

struct Variation {
  std::string_view integrator;
  std::string_view jacobian = {};
  Newton newton = {};
  int max_order = 0;
  bool full_only = false;
};

inline constexpr Variation methods[] = {
    {"implicit_midpoint", "elastic", loose},
    {"implicit_midpoint", "elastic", lazy},
    {"implicit_midpoint", "exact", loose},
    {"implicit_midpoint", "exact", converged},
    {"linearly_implicit_midpoint", "elastic"},
    {"linearly_implicit_midpoint", "exact"},
    {"generalized_alpha", "elastic", loose},
    {"generalized_alpha", "exact", converged, 0, true},
    {"newmark", "elastic", loose},
    {"newmark", "exact", converged, 0, true},
    {"bdf2", "elastic", loose},
    {"bdf2", "exact", converged, 0, true},
    {"tr_bdf2", "elastic", tight},
    {"esdirk43", "elastic", tight},
    {"radau5", "exact", converged},
    {"rodas5p", "exact"},
    {"backward_euler", "elastic", loose},
    {"backward_euler", "exact", converged, 0, true},
    {"linearly_implicit_euler", "elastic"},
    {"linearly_implicit_euler", "exact"},
    {"ida", "exact", {}, 2},
    {"ida", "exact", {}, 5},
    {"ida", "elastic", {}, 2, true},
    {"cvode_bdf", "exact"},
    {"cvode_bdf", "elastic", {}, 0, true},
    {"arkode_dirk", "exact"},
    {"arkode_dirk", "elastic", {}, 0, true},
    {"symplectic_euler"},
    {"velocity_verlet"},
    {"rk4"},
    {"explicit_euler", {}, {}, 0, true},
    {"cvode_adams"},
    {"arkode_erk"},
    {"gsl_rkf45"},
    {"gsl_rk8pd"},
    {"gsl_msadams", {}, {}, 0, true},
    {"gsl_bsimp", {}, {}, 0, true},
};

/// Number of elements of the released strand with a tolerance.
constexpr int controlled_elements = 10;

/// The methods compared on other strands and for the total error.
inline constexpr Variation best[] = {
    {"implicit_midpoint", "elastic", loose},
    {"linearly_implicit_midpoint", "elastic"},
};

struct Body {
  std::string_view model, modes, solver;
};
inline constexpr Body principal{"super_helix", "bend", "recursive"};
inline constexpr Body chain{"articulated_chain", "bend", "recursive"};
inline constexpr Body others[] = {
    {"super_helix", "bend", "composite"},
    {"super_helix", "bend", "sparse"},
    chain,
};

// Twist has almost no mass, so Newton's remaining error in it returns undamped and
// amplified: only converged steps or methods that damp fast modes succeed.
inline constexpr Body twisting{"super_helix", "bend_twist", "recursive"};
inline constexpr Variation twisting_methods[] = {
    {"implicit_midpoint", "elastic", loose, 0, true},
    {"implicit_midpoint", "exact", converged},
    {"linearly_implicit_midpoint", "elastic"},
    {"bdf2", "elastic", loose},
    {"bdf2", "exact", converged},
};

// Total error: the strand bends most at its root, so shorter elements there are worth
// trying beside equal ones.
inline constexpr double gradings[] = {1, 3};

/// Steps (s) or relative tolerances from loose to tight: loosest / base^(i exponent).
struct Ladder {
  double loosest, base, exponent;
  int rungs;
};

}  // namespace tress::experiments::work_precision
