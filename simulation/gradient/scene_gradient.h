#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/gradient/gradient_systems.h"
#include "simulation/scene/gradient_table.h"

namespace tress::simulation {

/// Points that are differentiated: all (`points`), the tip, or the tip at the last time
/// (`last_tip`).
enum class GradientOf { points, tip, last_tip };
/// Method of the derivatives: GradientRun (`forward`), AdjointRun (`adjoint`), or the one
/// that is expected to cost less (`automatic`).
enum class GradientWay { forward, adjoint, automatic };

/// Asks for derivatives of the points of strands.
struct GradientTask {
  std::vector<SceneParameter> parameters;  // parameters of the derivatives
  bool damped = false;                     // GradientStart
  std::vector<double> times;               // s, ascending, from 0
  int parts = 1;                           // of every step
  GradientOf of = GradientOf::points;      // differentiated points
  GradientWay way = GradientWay::forward;  // method of the derivatives
};

/// The points of one strand at the times of its task, and their derivatives.
struct StrandGradient {
  std::vector<std::vector<double>> points;  // at each time: (3 points) m
  /// Derivatives by each parameter, at each time: m over SceneParameter::unit. The
  /// adjoint leaves zeros for points and times that its task does not ask for.
  std::vector<std::vector<std::vector<double>>> by;
  /// Whether an exact contact opens, closes, comes to rest or begins to slide within a
  /// step of each time. A small change of a parameter may move that across the time.
  /// Empty: derivatives are those of the adjoint.
  std::vector<bool> near_contact_change;
  std::string unfinished;  // why its run ended after these times; empty: it did not
  std::string not_smooth;  // why its motion is not smooth; empty: not known to be
  /// Largest distance of the points of a run with a tolerance from those of the run with
  /// its accepted steps frozen, over the length.
  double moved = 0;
  bool adjoint = false;       // how the derivatives were computed
  bool frames_moved = false;  // for which there is no adjoint: AdjointRun
};

/// Derivatives of a scene's run. Those of strands that choose their steps are of the run
/// with its accepted steps frozen, which also end at frames.
struct SceneGradient {
  std::vector<SceneParameter> parameters;  // parameters in the order of [gradient]
  bool damped = false;                     // how it began
  std::vector<StrandGradient> strands;     // derivatives of each strand
};

/// Throws InputError if the scene has no [gradient], or its run no derivatives.
void check_gradient(const Scene& scene);
/// Throws InputError if the scene's run has no derivatives.
void check_derivatives(const Scene& scene);
/// Place that messages on the derivatives of a scene name: its [gradient], or its name.
std::string gradient_place(const Scene& scene);

/// Whether a run starts damped, by a word of [gradient] start.
bool starts_damped(std::string_view start, std::span<const SceneParameter> parameters);

/// Returns the points that a word of [gradient] of names.
GradientOf gradient_of(std::string_view word);
/// Returns the method that a word of [gradient] way names.
GradientWay gradient_way(std::string_view word);

/// Times of all frames, from 0.
std::vector<double> times_of_frames(const Scene& scene);

/// The gradient of one strand's run. With a tolerance, steps also end at the times.
StrandGradient strand_gradient(const Scene& scene, std::size_t strand,
                               const GradientTask& task);

/// Returns how many derivatives [gradient] asks for: of each coordinate, at each frame,
/// by each parameter.
double count_of_derivatives(const Scene& scene);
/// The gradient that [gradient] asks for, with every step divided into `parts`.
SceneGradient scene_gradient(const Scene& scene, int parts = 1);

}  // namespace tress::simulation
