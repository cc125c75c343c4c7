#pragma once

#include <span>
#include <string_view>

#include "contract/parameters.h"
#include "experiments/numerics/stability.h"
#include "simulation/run/simulation.h"

namespace tress::experiments {

/// One strand in one situation, as strand_parameters(); unset ones
/// keep their default, a hair of 10 cm and 40 um radius (EI = 6e-9 N m^2, 6.5e-7 kg).
struct StrandScene {
  std::string_view name;
  std::string_view what;
  ModelSettings settings;
  double t_end;     // s
  double coarsest;  // s, longer steps would miss what drives the scene
  bool driven;      // the root moves: judged by its tip, otherwise by its energy
};

std::span<const StrandScene> strand_scenes();

/// Throws InputError naming the nearest scene if there is no such scene.
const StrandScene& find_strand_scene(std::string_view name);

/// Returns the initial state with every rate perturbed by up to 1e-3 of its typical size
/// (a millionth of the energy), so that symmetry hides no instability. A straight strand
/// released in a plane never twists otherwise. Projected onto the constraints, if any.
State perturbed_start(System& system);

/// Returns bounds of a stable run of the scene, for `system` made with `parameters`.
///
/// Passive: 1 % of the energy that the scene can convert to motion, which is that of the
/// start above the strand hanging straight and unloaded, E(0) + m g L/2.
///
/// Driven: the tip stays within 1.001 L of the root and below strand_speed_bound.
/// Inextensible models cannot violate the first. It detects instabilities of models with
/// stretch, and is ten times the strain rho a L/E that 100 g put on a hair of 10 cm.
StabilityBounds stability_bounds(const StrandScene& scene, const Parameters& parameters,
                                 System& system);

/// Returns the stability bounds of any passive system released at `start`, such as a
/// tree: 1 % of the largest kinetic energy until t_end, found by steps of 1 ms. Throws
/// InputError when those are themselves unstable.
StabilityBounds release_bounds(System& system, const State& start, double t_end);

/// Returns an upper bound on the speed (m/s) of the tip relative to the root until t_end,
/// for any motion of the strand. In the frame of the clamp the clamp does no work. The
/// working forces there are gravity and, per mass, at most f = |a| + (|alpha| + omega^2)
/// L from the root's motion. A turning clamp changes the potential of gravity by at most
/// |omega x g| L per mass and time. With u^2/2 the energy per mass above that of the
/// strand hanging straight and unloaded, u u' <= u f + |omega x g| L, hence
///
///     u <= sqrt(2 g L + 2 int |omega x g| L dt) + int f dt,
///
/// where 2 g L is that of the upright strand, the most of any unloaded shape. u bounds
/// the root mean square speed of the strand. The tip may be faster, as in a whip: all of
/// the energy in the last tenth, turning about its own start, gives sqrt(30) u. Adding
/// |omega| L transforms from the clamp's frame to a non-rotating one.
double strand_speed_bound(const Parameters& parameters, double t_end);

}  // namespace tress::experiments
