#pragma once

#include <optional>
#include <vector>

#include "models/catalogue.h"
#include "models/strand/strand.h"

namespace tress::simulation {

/// Largest number of steps between two checks of a state.
constexpr int guarded_every = 4;
/// Longest time between two checks of a state, s.
constexpr double guarded_for = 2e-3;
/// Largest change of a segment's length relative to its length.
constexpr double most_stretch = 0.5;

/// Half of each neighbouring segment and its mass, at the root and the tips of segments,
/// which are the material points of every strand model.
struct Lumps {
  std::vector<double> mass, length;  // (points) kg, m
  std::vector<double> arc;           // (points) arc length from the root, m
  double longest = 0;                // arc length of the farthest tip, m

  /// Returns the points of effects at these places, with these velocities and tangents (3
  /// numbers each).
  Points points(In x, In v, In tangent) const {
    return {.count = static_cast<int>(mass.size()),
            .x = x,
            .v = v,
            .tangent = tangent,
            .mass = mass,
            .length = length,
            .arc = arc,
            .longest = longest};
  }
};
/// Computes the lumps of a strand at rest.
Lumps lumps(const Strand& strand);

/// Data of a strand that a guard needs and its System does not provide.
struct GuardedStrand {
  std::optional<RootMotion> root;  // the clamp, where it moves
  Effects effects;                 // effects that act on the strand
  Lumps lumps;                     // lumped masses
  std::vector<double> rest;        // (points) m, of the segment that ends there; root: 0
  double mass = 0;                 // kg
  /// J: m g L, with all uniform loads in place of m g.
  double weight_work = 0;
  double bending_energy = 0;  // J, EI/L: a bend of about one radian

  /// J, that it may gain by hanging down. At least a share of EI/L: a strand at rest
  /// without load, solved to 1e-10 of the typical coordinates, has less energy.
  double slack() const { return weight_work + 1e-9 * bending_energy; }
  /// Returns the number of points.
  int points() const { return static_cast<int>(rest.size()); }
  /// Returns true if the effect's load is the same for all states.
  bool uniform(const Effect& effect) const {
    return !effect.needs().position && !effect.needs().velocity;
  }
};

/// Computes these data for a strand.
GuardedStrand guarded_strand(const Strand& strand, Effects effects);

/// The strand that a catalogue model makes from these parameters; empty: the model is a
/// mechanism.
std::vector<GuardedStrand> guarded_strands(const ModelEntry& model,
                                           const Parameters& parameters);

}  // namespace tress::simulation
