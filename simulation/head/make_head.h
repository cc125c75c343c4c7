#pragma once

#include <memory>

#include "integrators/block/block_method.h"
#include "models/head/head.h"

namespace tress::simulation {

/// Options of a batch's steps, in addition to the strands' own.
struct HeadOptions : models::LaneOptions {
  HeadMethod method = HeadMethod::linearly_implicit_euler;  // method of the steps
  // As Options::newton_tolerance, at least what numbers resolve, and newton_iterations.
  double newton_tolerance = 1e-10;  // bound of the last correction over typical sizes
  int newton_iterations = 20;       // bound of the corrections
  /// Tolerance of a strand's step error, as Options::tolerance; 0: equal steps. With
  /// tr_bdf2 every strand takes its own steps with this error control. Newton's tolerance
  /// follows from it. See integrators/block/controlled_blocks.h.
  double tolerance = 0;
  double min_step = 0;  // s, with a tolerance: strands that need less fail
};

/// Whether numbers are long enough for strands that choose their steps by this tolerance.
bool resolve(models::HeadNumber number, double tolerance);

/// Makes a batch of super-helices (models/head/helix_strand.h). Coordinates are Darboux
/// vectors (1/m), 3 per element. linearly_implicit_euler has the elastic Jacobian. The
/// other methods have the exact one (models/head/exact/exact_kernel.h), with gravity,
/// linear drag and bodies. tr_bdf2 starts from the acceleration at the start, so that
/// twist must have inertia. Throws InputError if the options or the pack make no sense.
std::unique_ptr<models::Head> helix_head(const HeadOptions& options,
                                         const models::HeadPack& pack);

/// Makes a batch of super-clothoids (models/head/clothoid_strand.h). Coordinates are, per
/// element, the mean Darboux vector and half its difference between the ends (1/m).
/// Methods and effects as above; `points` >= 4. Throws InputError as above.
std::unique_ptr<models::Head> clothoid_head(const HeadOptions& options,
                                            const models::HeadPack& pack);

/// Makes a batch of chains of rigid links (models/head/chain_strand.h). Coordinates are
/// the rotation vectors of the joints (rad), 3 per link. Methods as above, but
/// linearly_implicit_midpoint needs double precision. `points` are those of a link at
/// which effects act. Throws InputError as above.
std::unique_ptr<models::Head> chain_head(const HeadOptions& options,
                                         const models::HeadPack& pack);

/// Makes a batch of discrete elastic rods (models/head/maximal/der_strand.h), `elements`
/// edges each. linearly_implicit_euler has the elastic Jacobian, the other methods the
/// exact one; linearly_implicit_midpoint needs double precision. Coordinates are, per
/// edge, the vector along it (m, world axes) and the angle of its frame; the rate of the
/// first edge is the velocity of its end. Without rotary_inertia angles have no inertia,
/// and there is no tr_bdf2; `points` is not read. Throws InputError as above.
std::unique_ptr<models::Head> der_head(const HeadOptions& options,
                                       const models::HeadPack& pack);

/// Makes a batch of point masses and springs (models/head/maximal/spring_strand.h),
/// `elements` edges each: mass_spring with angular bending, without torsion.
/// linearly_implicit_euler has the filtered Jacobian, the other methods the exact one. Of
/// effects beyond gravity and linear drag it supports bodies. Coordinates are the vectors
/// along the edges (m, world axes); the rate of the first is the velocity of its end.
/// `points`, `twist` and `rotary_inertia` are not read. Numbers have double precision:
/// single precision does not resolve strains of about 1e-6. Throws InputError as above.
std::unique_ptr<models::Head> spring_head(const HeadOptions& options,
                                          const models::HeadPack& pack);

/// Makes a batch of corde or xpbd_cosserat (models/head/maximal/quaternion_strand.h),
/// `elements` edges each, with the options `model`. All methods but
/// linearly_implicit_euler are supported, linearly_implicit_midpoint in double precision.
/// Of effects beyond gravity and linear drag it supports bodies. Coordinates are, per
/// edge, the vector along it (m, world axes) and its quaternion; the rate of the first
/// edge is the velocity of its end. `points`, `twist` and `rotary_inertia` are not read.
/// Throws InputError as above.
std::unique_ptr<models::Head> corde_head(const HeadOptions& options,
                                         const models::HeadPack& pack);
/// Makes a batch of xpbd_cosserat: see corde_head().
std::unique_ptr<models::Head> cosserat_head(const HeadOptions& options,
                                            const models::HeadPack& pack);

}  // namespace tress::simulation
