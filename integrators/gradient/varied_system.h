#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "contract/system.h"

namespace tress::integrators {

/// A parameter of a system as a number s, which is 0 in the system itself. Returns the
/// system at s, |s| <= 1/4, whose linearize() is that of its residual.
using RunParameter = std::function<std::unique_ptr<System>(double s)>;

/// f'(0) = base f(0) + sum_i weight_i f(at_i).
struct Stencil {
  double base = 0;
  std::span<const double> at, weight;
};

/// Exact of affine functions, whatever the distance.
inline constexpr double affine_at[] = {0.25}, affine_weight[] = {4};
inline constexpr Stencil affine_stencil{-4, affine_at, affine_weight};

/// Central differences of order 4 at the distance d. Their error is d^4/30 f''''' and,
/// from rounding, 1.5e-16/d |f|. It is below 1e-10 f' also where stretching makes f'''''
/// 4e12 times f' (edges of a hair, whose axial stiffness is 4e6 of its bending
/// stiffness).
inline constexpr double central_distance = 3e-6;
inline constexpr double central_at[] = {-2 * central_distance, -central_distance,
                                        central_distance, 2 * central_distance};
inline constexpr double central_weight[] = {
    1 / (12 * central_distance), -8 / (12 * central_distance),
    8 / (12 * central_distance), -1 / (12 * central_distance)};
inline constexpr Stencil central_stencil{0, central_at, central_weight};

/// A parameter's stencil with its systems. Each follows the run, at the state q + s dq:
/// what it remembers (History) depends on s too.
struct VariedSystem {
  Stencil stencil;
  std::vector<std::unique_ptr<System>> systems;
};

/// With the affine stencil where residual, start and points are affine in s: measured at
/// one state, in which all terms are alive, and several times. Never of systems with a
/// History, which makes the residual depend on the states behind it.
VariedSystem varied_system(System& system, const RunParameter& parameter);

}  // namespace tress::integrators
