#pragma once

#include <optional>
#include <vector>

#include "models/catalogue.h"
#include "models/strand/strand.h"

namespace tress::simulation {

/// Intervals between checks of a state, in steps and in time (s), and the largest change
/// of a segment's length relative to its length.
constexpr int guarded_every = 4;
constexpr double guarded_for = 2e-3, most_stretch = 0.5;

/// Half of each neighbouring segment and its mass, at the root and the tips of segments,
/// which are the material points of every strand model.
struct Lumps {
  std::vector<double> mass, length;  // (points) kg, m
};
Lumps lumps(const Strand& strand);

/// Data of a strand that a guard needs and its System does not provide.
struct GuardedStrand {
  std::optional<RootMotion> root;  // the clamp, where it moves
  Effects effects;
  Lumps lumps;
  std::vector<double> rest;  // (points) m, of the segment that ends there; root: 0
  double mass = 0;           // kg
  /// J: m g L, with all uniform loads in place of m g.
  double weight_work = 0;
  double bending_energy = 0;  // J, EI/L: a bend of about one radian

  /// J, that it may gain by hanging down. At least a share of EI/L: a strand at rest
  /// without load, solved to 1e-10 of the typical coordinates, has less energy.
  double slack() const { return weight_work + 1e-9 * bending_energy; }
  int points() const { return static_cast<int>(rest.size()); }
  bool uniform(const Effect& effect) const {
    return !effect.needs().position && !effect.needs().velocity;
  }
};

GuardedStrand guarded_strand(const Strand& strand, Effects effects);

/// The strand that a catalogue model makes from these parameters; empty: the model is a
/// mechanism.
std::vector<GuardedStrand> guarded_strands(const ModelEntry& model,
                                           const Parameters& parameters);

}  // namespace tress::simulation
