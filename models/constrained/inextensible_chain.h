#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "contract/system.h"
#include "models/constrained/particles.h"

namespace tress::models {

/// Data common to all structures of hanging particles.
struct HangingShape {
  double mass = 1;        // kg, all particles together, equal shares
  double length = 1;      // m: L of a strand, a structure's own measure
  double gravity = 9.81;  // m/s^2, along -z
  double drag = 0;        // nu, kg/(m s), on length shared equally between particles
  double spin = 0;        // rad/s, about the vertical through the origin
};

/// Parameter for HangingShape::drag.
inline constexpr Parameter hanging_drag_parameter{
    .name = "drag_kg_m_s",
    .help = "air drag per length nu (kg/(m s))",
    .number = 0,
    .min = 0,
    .max = 1e6};
/// Parameter for HangingShape::spin.
inline constexpr Parameter hanging_spin_parameter{
    .name = "spin_rad_s",
    .help = "initial rotation about the vertical (rad/s)",
    .number = 0,
    .min = -1e6,
    .max = 1e6};

/// Reads the data common to all structures.
HangingShape hanging_shape(const Parameters& parameters);

/// Hanging strand of n rigid massless links of length L/n with point masses m/n at their
/// ends, as particles and distance constraints.
///
/// Open: pivot at the origin, straight along x, n particles, n rows; released
/// horizontally. Closed: a regular polygon of perimeter L in the x-z plane whose first
/// particle is fixed at the origin: n particles, n + 3 rows. Both may spin about the
/// vertical through the origin, a rigid and therefore consistent motion.
struct ChainShape : HangingShape {
  int links = 10;       // n: >= 1 open, >= 3 closed
  bool closed = false;  // whether the chain is a ring
};

/// Throws InputError on sizes out of range.
ParticleScene inextensible_chain(const ChainShape& shape);

/// Adds gravity and drag to a scene; zero terms are not built. `height` (m) sets the
/// typical speed sqrt(g height).
void add_gravity_and_drag(ParticleScene& scene, double gravity, double drag,
                          double height);

/// Gives every particle the velocity of a rigid rotation about the z axis (rad/s).
void spin_about_z(ParticleScene& scene, double spin);

/// Returns the parameters of the model.
std::span<const Parameter> inextensible_chain_parameters();
/// Makes the model.
std::unique_ptr<System> make_inextensible_chain(const Parameters& parameters);

}  // namespace tress::models
