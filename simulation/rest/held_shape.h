#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "models/effects/effect.h"
#include "simulation/scene/scene.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {

/// Data that keep a strand at rest in its shape at t = 0, for rest = "inverse".
struct HeldShape {
  std::vector<double> natural;  // of NaturalStrains
  double factor = 1;            // by which its moduli are raised
  double least_factor = 0;      // above which it stays; below 1: as it is
  double residual = 0;          // of the balance found, over that of the loads
  double sag = 0;               // largest displacement to it from the shape, m
  int contacts = 0;             // points that bodies support
  /// Offsets for Body::with_offsets() of a body, by its index among make_effects().
  std::vector<std::pair<std::size_t, std::vector<double>>> offsets;

  /// Returns true if the strand would fall with its own moduli.
  bool would_fall() const { return !(least_factor < 1); }
  /// Returns true if the strand falls with its moduli raised by `factor`.
  bool falls() const { return !(least_factor < factor); }
};

/// Factor of the stiffness by which strands exceed the moduli that they need.
inline constexpr double stiffened = 2;

/// Returns for each strand the natural strains n for which q, its shape at t = 0, is an
/// equilibrium, r(q; n) = 0, under the loads at t = 0. The residual is affine in n.
///
/// Reduced models, whose strains are coordinates: n_k += r_k/stiffness_k, exact. Others
/// have more coordinates than strains. The remaining displacement, |D^-1 K^-1 r| with K =
/// dr/dq and typical sizes D, is minimised within the model's own constraints.
///
/// Effects act with their values at t = 0, wind with its mean; roots and bodies are held
/// where they are then. A `body` with regularised friction supports the points that it
/// meets by normal forces f >= 0. These minimise the elastic energy of n - s(q), by
/// nonnegative least squares. Where the depth d of a point is not f/k, its offset is
/// changed by f/k - d from then on, as the depth at rest must be.
///
/// With the elastic stiffness raised by s, K(s) = s K_el + G, where G depends neither on
/// s nor on n: the internal forces are those of the load. A strand therefore stays where
/// s is above least_factor, the largest s for which K(s) is singular. Loads without a
/// potential count with the symmetric part of their slopes. Where the scene says
/// `stiffen`, strands that would fall get `stiffened` times the moduli that they need.
///
/// O(n^3) for each strand, n its coordinates. Equilibria as unknowns of the natural
/// shape: [Hadap 2006; Derouet-Jourdan et al. 2013].
///
/// `between`: effects between strands, which know all positions. `numbers`: numbers of
/// the strands in messages, if they are not all of a scene. Throws InputError where the
/// model has no such natural strains, a root is free or a balance does not exist.
std::vector<HeldShape> held_shapes(
    const Scene& scene, const std::function<models::Effects(std::size_t)>& between,
    Crew& crew, std::span<const std::size_t> numbers = {});

/// Returns the scene with roots, and bodies that move with them, held where they are at
/// t = 0. Wind has its mean; a sine wind is calm at t = 0.
Scene still(Scene scene);

/// Root and tips of elements of all strands at t = 0, (3 points) m.
std::vector<double> points_at_start(const Scene& scene);

/// The strand with the moduli that hold it.
models::Strand stiffer(models::Strand strand, const HeldShape& held);
/// The effects on it, which are make_effects(), with bodies that support it.
models::Effects supporting(models::Effects effects, const HeldShape& held);

}  // namespace tress::simulation
