#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "models/catalogue.h"
#include "simulation/run/guarded_strand.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::calibrate {

// Parameter names in strand models.
inline constexpr const char* gamma_key = "internal_friction_kg_m3_s";
inline constexpr const char* drag_key = "drag_kg_m_s";
inline constexpr const char* stiffness_key = "youngs_modulus_pa";

/// The properties of a strand that a fit can determine.
struct Properties {
  double gamma;           // internal friction, kg m^3/s
  double nu;              // air drag, kg/(m s)
  double youngs_modulus;  // Pa; the shear modulus keeps its ratio to it
};

struct BuiltStrand {
  std::unique_ptr<System> system;
  std::vector<GuardedStrand> guarded;
};

/// A strand of which records are made; all but its properties is known.
struct Specimen {
  Properties properties;  // its own
  double length, mass;    // m, kg
  /// Builds a strand with these properties and `finer` (a power of two) times the
  /// elements.
  std::function<BuiltStrand(const Properties&, int finer)> build;
};

/// Returns the specimen with a model's parameters (models/strand/strand_parameters.h).
Specimen specimen(const ModelEntry& model, const Parameters& parameters);

/// The strand of a scene with everything that acts on it; nu is that of
/// [effects.linear_drag]. Throws InputError unless the scene has exactly one strand, and
/// on a strand that flies freely.
Specimen specimen(const Scene& scene);

}  // namespace tress::experiments::calibrate
