#pragma once

#include <optional>
#include <vector>

#include "models/catalogue.h"
#include "models/strand/strand.h"

namespace tress::simulation {

/// Half of each neighbouring segment and its mass, at the root and the tips of segments,
/// which are the material points of every strand model.
struct Lumps {
  std::vector<double> mass, length;  // (points) kg, m
};
Lumps lumps(const Strand& strand);

/// What a guard must know of a strand that its System does not say.
struct GuardedStrand {
  std::optional<RootMotion> root;  // the clamp, where it moves
  Effects effects;
  Lumps lumps;
  std::vector<double> rest;  // (points) m, of the segment that ends there; root: 0
  double mass = 0;           // kg
  /// J: m g L, with all loads that are the same everywhere in place of m g.
  double weight_work = 0;
  double bending_energy = 0;  // J, EI/L: of a bend by about one radian

  int points() const { return static_cast<int>(rest.size()); }
  bool uniform(const Effect& effect) const {
    return !effect.needs().position && !effect.needs().velocity;
  }
};

GuardedStrand guarded_strand(const Strand& strand, Effects effects);

/// The strand that a model of the catalogue makes of these parameters; none: it makes a
/// mechanism of its own.
std::vector<GuardedStrand> guarded_strands(const ModelEntry& model,
                                           const Parameters& parameters);

}  // namespace tress::simulation
