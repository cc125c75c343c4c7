#pragma once

#include "contract/forms/compliance_form.h"
#include "integrators/position_based/descent_method.h"

namespace tress::integrators {

/// Option for DescentChoice::block.
inline constexpr Parameter block_option{
    .name = "block",
    .help =
        "nodes that are solved together, 0: all, which makes a sweep a Newton "
        "iteration of the step",
    .number = 1,
    .min = 0,
    .max = 1e6,
    .whole = true};
/// Option for DescentChoice::curvature.
inline constexpr Parameter curvature_option{
    .name = "second_derivatives",
    .help =
        "second derivatives of strains: exact where the matrix stays positive definite, "
        "bounded by the sums of their rows, or left out",
    .choices = "exact|majorised|none"};
/// Option for DescentChoice::chebyshev.
inline constexpr Parameter chebyshev_option{
    .name = "chebyshev",
    .help =
        "convergence rate for which Chebyshev acceleration of the "
        "sweeps is set, 0: no acceleration",
    .number = 0,
    .min = 0,
    .max = 1};

/// Returns the choice given by sweeps_option, sweep_order_option, the options above, and
/// anderson_option where it is among them. Throws InputError if both accelerations are
/// chosen.
DescentChoice descent_choice(const Parameters& chosen);
/// Returns the choice given by start_option.
Start start_choice(const Parameters& chosen);

/// Whether a row has no compliance.
bool has_rigid_rows(const ComplianceForm& form);

}  // namespace tress::integrators
