#pragma once

#include <memory>

#include "integrators/block/block_method.h"
#include "models/head/head.h"

namespace tress::simulation {

/// How a head's steps are computed, beside what its strands are.
struct HeadOptions : models::LaneOptions {
  HeadMethod method = HeadMethod::semi_implicit_euler;
  // As Options::newton_tolerance, at least what numbers resolve, and newton_iterations.
  double newton_tolerance = 1e-10;
  int newton_iterations = 20;
  /// By tr_bdf2 every strand takes steps of its own, as long as its own error allows, as
  /// Options::tolerance; 0: equal steps. Newton's tolerance follows from it. See
  /// integrators/block/controlled_blocks.h.
  double tolerance = 0;
  double min_step = 0;  // s, with a tolerance: strands that need less are lost
};

/// Whether numbers are long enough for strands that choose their steps by this tolerance.
bool resolve(models::HeadNumber number, double tolerance);

/// A head of super-helices (models/head/helix_strand.h); coordinates are Darboux vectors
/// (1/m), 3 per element; semi_implicit_euler with the stiff tangent, or the other methods
/// with the exact one (models/head/exact/exact_kernel.h), which have gravity, linear drag
/// and bodies. tr_bdf2 starts from the acceleration at the start, so that twist must have
/// inertia. Throws InputError if the options or the pack make no sense.
std::unique_ptr<models::Head> helix_head(const HeadOptions& options,
                                         const models::HeadPack& pack);

/// A head of chains of rigid links (models/head/chain_strand.h); coordinates are the
/// rotation vectors of the joints (rad), 3 per link; methods as above, but
/// linearly_implicit_midpoint needs numbers of 64 bits; `points` are those of a link at
/// which effects act. Throws InputError as above.
std::unique_ptr<models::Head> chain_head(const HeadOptions& options,
                                         const models::HeadPack& pack);

/// A head of discrete elastic rods (models/head/maximal/der_strand.h), `elements` edges
/// each: semi_implicit_euler with the stiff tangent, or the other methods with the exact
/// one, linearly_implicit_midpoint in 64 bits. Coordinates are, per edge, the vector
/// along it (m, world axes) and the angle of its frame; the rate of the first edge is the
/// velocity of its end. Without rotary_inertia angles have no inertia, and there is no
/// tr_bdf2; `points` is not read. Throws InputError as above.
std::unique_ptr<models::Head> der_head(const HeadOptions& options,
                                       const models::HeadPack& pack);

/// A head of point masses and springs (models/head/maximal/spring_strand.h), `elements`
/// edges each: mass_spring with angular bending, without torsion, by semi_implicit_euler
/// with the filtered tangent, or by the other methods with the exact one; of effects
/// beyond gravity and linear drag it has bodies. Coordinates are the vectors along the
/// edges (m, world axes); the rate of the first is the velocity of its end. `points`,
/// `twist` and `rotary_inertia` are not read. Numbers have 64 bits: 32 do not resolve
/// strains of some 1e-6. Throws InputError as above.
std::unique_ptr<models::Head> spring_head(const HeadOptions& options,
                                          const models::HeadPack& pack);

/// Heads of corde and xpbd_cosserat (models/head/maximal/quaternion_strand.h), `elements`
/// edges each, with the options `model`, by all methods but semi_implicit_euler,
/// linearly_implicit_midpoint in 64 bits; of
/// effects beyond gravity and linear drag they have bodies. Coordinates are, per edge,
/// the vector along it (m, world axes) and its quaternion; the rate of the first edge is
/// the velocity of its end. `points`, `twist` and `rotary_inertia` are not read. They
/// throw InputError as above.
std::unique_ptr<models::Head> corde_head(const HeadOptions& options,
                                         const models::HeadPack& pack);
std::unique_ptr<models::Head> cosserat_head(const HeadOptions& options,
                                            const models::HeadPack& pack);

}  // namespace tress::simulation
