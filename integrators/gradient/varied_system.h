#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/system.h"
#include "integrators/gradient/known_forces.h"

namespace tress::integrators {

/// A parameter of a system as a number s, which is 0 in the system itself. Returns the
/// system at s, |s| <= 1/4, whose linearize() is that of its residual.
struct RunParameter : std::function<std::unique_ptr<System>(double s)> {
  using function::function;
  /// Distance of its central differences in s where it places points, bodies or targets,
  /// whose forces may begin and end at any place. Empty: it is of another kind.
  std::optional<double> places = {};
  std::string name = {};  // for messages; empty: it has none
  bool starts = false;    // whether it is of the initial state, and no forces begin later
  ParameterLaw law = ParameterLaw::unknown;  // decides what may be measured at a probe
};

/// f'(0) = base f(0) + sum_i weight_i f(at_i).
struct Stencil {
  double base = 0;                 // weight of f(0)
  std::vector<double> at, weight;  // distances, and weights of the values there
};

/// Stencil that is exact of affine functions.
inline const Stencil affine_stencil{-4, {0.25}, {4}};

/// Central differences of order 4 at the distance d. Their error is d^4/30 f''''' and,
/// from rounding, 1.5e-16/d |f|. It is below 1e-10 f' also where stretching makes f'''''
/// 4e12 times f' (edges of a hair, whose axial stiffness is 4e6 of its bending
/// stiffness).
inline constexpr double central_distance = 3e-6;
/// Stencil of central differences at distances d and 2 d.
inline Stencil central_differences(double d) {
  const double part = 1 / (12 * d);
  return {0, {-2 * d, -d, d, 2 * d}, {part, -8 * part, 8 * part, -part}};
}
/// Central differences of order 2 at the distance d of a parameter that places. It moves
/// points by some 1e-8 of the length. Even where stretching makes f''' 4e6 times f', the
/// error is below 1e-9 f'. Rounding adds less than with order 4.
inline Stencil placing_differences(double d) {
  return {0, {-d, d}, {-1 / (2 * d), 1 / (2 * d)}};
}
/// Central differences at central_distance.
inline const Stencil central_stencil = central_differences(central_distance);

/// Returns the stencil of a parameter whose forces may begin to act at any place.
Stencil placed_stencil(const RunParameter& parameter);

/// s. Motions of roots, of periods and durations from milliseconds to seconds, are not at
/// rest at all of these times.
inline constexpr double probed_times[] = {0, 0.0137, 0.373, 2.91};
/// dr/ds = constant + by_q q + by_v v, entry by entry, in every state and at all times.
/// Moduli, internal frictions and natural strains have it in coordinates that are
/// strains.
struct SimpleDerivative {
  std::vector<double> constant, by_q, by_v;  // coefficients of the entries (n)
};

/// A parameter's stencil with its systems. Each follows the run, at the state q + s dq:
/// what it remembers (History) depends on s too.
struct VariedSystem {
  Stencil stencil;                               // stencil of the derivative
  std::vector<std::unique_ptr<System>> systems;  // systems at the stencil's distances
  std::optional<SimpleDerivative> simple;        // where the residual has one
  std::string name = {};                         // RunParameter::name
  bool starts = false;  // whether the initial state alone depends on the parameter
};

/// Memory of the systems of a stencil: that of their own runs (`own`), or that of the run
/// itself (`of_run`).
enum class VariedMemory { own, of_run };

/// Returns the affine stencil where residual and start are affine in s. This is measured
/// near the start, where all terms of the strand are alive, at several times, and once
/// far away. Measurements prove nothing about other states. Parameters of an unknown law
/// therefore get central differences, and so do those that move points or that
/// RunParameter::places. The residual of a system with a History of its own depends on
/// the states behind it and gets them too. `simple` of a smooth law is measured at three
/// states near the start and tried at a fourth one.
VariedSystem varied_system(System& system, const RunParameter& parameter,
                           VariedMemory memory = VariedMemory::own);

/// Derivatives of the residual by a parameter that acts through the constants of a
/// system, the motion of its clamp (MovedClamp) and the loads of effects alone
/// (TransposedForm).
struct ConstantsDerivative {
  std::vector<double> by;     // of the constants
  VariedSystem loads, clamp;  // whose loads, and whose clamp; no systems: they stay
  bool moves_points = false;  // at the start, or at fixed coordinates
};

/// The derivative of the constants by a parameter that changes nothing else in the
/// residual but loads and the clamp: measured at three states, for random velocities. A
/// parameter of an unknown law, or that places or moves the clamp, always has loads,
/// which may begin to act later, unless `forces` are quadratic: viscous drag always acts.
/// Empty: it changes other things, or the system has no constants.
std::optional<ConstantsDerivative> constants_derivative(System& system,
                                                        const RunParameter& parameter,
                                                        KnownForces forces = {});

/// The derivative of the natural strains by a parameter that changes nothing else,
/// measured as above. Empty: it changes other things, or the system has no
/// NaturalStrains.
std::vector<double> natural_direction(System& system, const RunParameter& parameter);

}  // namespace tress::integrators
