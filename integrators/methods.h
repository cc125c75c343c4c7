#pragma once

#include <memory>

#include "contract/integrator.h"

/// The factories of our fixed-step methods, each in the file of its name. Order p means
/// an error O(h^p) at a fixed time. z = h omega on the imaginary axis for stability
/// limits.
namespace tress {

// ---- explicit, on q' = v, v' = a(t, q, v)
// ------------------------------------------------

/// Order 1; amplifies oscillations for every h: a baseline.
std::unique_ptr<Integrator> make_explicit_euler(System& system, const Options& options);

/// v += h a(q, v), q += h v. Order 1, symplectic for separable systems, z < 2.
/// [Hairer, Lubich, Wanner: Geometric Numerical Integration, 2nd ed., VI.3.1]
std::unique_ptr<Integrator> make_symplectic_euler(System& system, const Options& options);

/// Half kick, drift, half kick. Order 2, symplectic for separable systems, z < 2.
/// Velocity-dependent forces are evaluated at the predicted v + h a, which keeps order 2
/// with one evaluation per step. [Swope et al. 1982, J. Chem. Phys. 76, 637]
std::unique_ptr<Integrator> make_velocity_verlet(System& system, const Options& options);

/// The classical Runge-Kutta method. Order 4, z < 2.83. [Kutta 1901]
std::unique_ptr<Integrator> make_rk4(System& system, const Options& options);

/// Verlet's method with g = 0 and g' = 0 held by impulses. Order 2, symplectic, z < 2;
/// one factorisation per step. Needs a constant mass matrix. [Andersen 1983, J. Comput.
/// Phys. 52]
std::unique_ptr<Integrator> make_rattle(System& system, const Options& options);

// ---- implicit, through Stage
// --------------------------------------------------------------

/// Backward Euler's first Newton step from constant velocity: one linear solve per step,
/// the scheme of the seed papers. Order 1, strongly damping. The model's Tangent option
/// decides what S carries. [Baraff, Witkin 1998; Bertails et al. 2006]
std::unique_ptr<Integrator> make_semi_implicit_euler(System& system,
                                                     const Options& options);

/// Order 1, L-stable, strongly damping. [Hairer, Wanner: Solving ODEs II, IV.3]
std::unique_ptr<Integrator> make_backward_euler(System& system, const Options& options);

/// The one-stage Gauss method. Order 2, A-stable, no damping, symplectic.
/// [Hairer, Lubich, Wanner, II.1.3]
std::unique_ptr<Integrator> make_implicit_midpoint(System& system,
                                                   const Options& options);

/// The midpoint rule with one Newton step from an extrapolated acceleration: one
/// residual, one factorisation and one solve per step, like semi_implicit_euler, but
/// order 2, with any tangent (a W-method). Stable as implicit_midpoint on linear systems
/// with the exact tangent; beyond, the step must resolve what the tangent leaves out and
/// how it changes: it has an ErrorIndicator. [Steihaug, Wolfbrandt 1979, Math. Comp. 33,
/// 521; Hairer, Wanner: Solving ODEs II, IV.7]
std::unique_ptr<Integrator> make_linearly_implicit_midpoint(System& system,
                                                            const Options& options);

/// Two-step backward differentiation with variable-step coefficients, started by backward
/// Euler. Order 2, L-stable, damps high frequencies. [Hairer, Norsett, Wanner I, III.5]
std::unique_ptr<Integrator> make_bdf2(System& system, const Options& options);

/// Average acceleration (beta = 1/4, gamma = 1/2). Order 2, A-stable, no damping.
/// [Newmark 1959]
std::unique_ptr<Integrator> make_newmark(System& system, const Options& options);

/// Order 2, A-stable, spectral radius at infinity rho_inf = Options::rho_inf.
/// [Chung, Hulbert 1993; constraints: Arnold, Bruls 2007, eqs. (4) to (6)]
std::unique_ptr<Integrator> make_generalized_alpha(System& system,
                                                   const Options& options);

/// Two semi-implicit half steps that know nothing of the constraints, and between them a
/// correction of the positions, constraint after constraint, until all hold: how hair was
/// kept from stretching in film production. Order 1; without constraints its
/// amplification has determinant (1 + z^2/4)^-2: it damps half as much as
/// semi_implicit_euler. Options: correction, second_filter, correction_tolerance. [Kim
/// 2010, in: Realistic Hair Simulation, SIGGRAPH course, five steps; Provot 1995; Bridson
/// et al. 2002]
std::unique_ptr<Integrator> make_predictor_corrector(System& system,
                                                     const Options& options);

/// Position-based dynamics with compliance: backward Euler on the energy, explicit on all
/// other forces, by a fixed number of Gauss-Seidel sweeps over the blocks of the model's
/// ComplianceForm, Options::sweeps and sweep_order. From x = q + h v + h^2 rest(q, v) and
/// lambda = 0 every block is corrected in turn by x += W G^T dlambda with
///
///     ((1 + gamma) G W G^T + alpha/h^2) dlambda
///         = -C - alpha lambda/h^2 - gamma (G (x - q) + h C_t),   gamma = alpha c/h,
///
/// then v = (x - q)/h. Order 1. Few sweeps leave it softer than the model, the more so
/// the longer the step and the finer the strand. Converged sweeps are backward Euler's
/// step but for the change of G on the way, O(h^2) of the force (none for linear C, much
/// where light coordinates turn far). [Macklin, Mueller & Chentanez 2016, eqs. 18, 26]
std::unique_ptr<Integrator> make_xpbd(System& system, const Options& options);

// ---- GSL odeiv2, adaptive, on y = (q, v)
// --------------------------------------------------

std::unique_ptr<Integrator> make_gsl_rkf45(System& system, const Options& options);
std::unique_ptr<Integrator> make_gsl_rk8pd(System& system, const Options& options);
std::unique_ptr<Integrator> make_gsl_msadams(System& system, const Options& options);
std::unique_ptr<Integrator> make_gsl_bsimp(System& system, const Options& options);

}  // namespace tress
