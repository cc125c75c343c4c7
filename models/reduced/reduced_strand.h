#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "contract/parameters.h"
#include "math/pack.h"
#include "models/effects/effect.h"
#include "models/reduced/tree_solver.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Quadrature points that carry the mass of a segment: four at a time, or, in a batch,
/// the same one of four strands.
struct PointBlock {
  Pack s, mass, length;
};

/// One segment of a reduced-coordinate strand. Vectors are over (twist, curvature 1,
/// curvature 2); what belongs to components that are not unknowns is 0 but for `held`.
/// T = Pack: the same segment of four strands.
template <class T>
struct ReducedSegmentOf {
  int parent = -1;
  T length{};
  bool mounted = false;  // mount is not the identity
  FrameOf<T> mount;
  T rotor{};          // rotational inertia about the tangent at the tip, kg m^2
  Vec3<T> held;       // components that are not unknowns keep this value
  Vec3<T> rest;       // unknowns at rest
  Vec3<T> initial;    // and at t = 0
  Vec3<T> stiffness;  // moment per unknown
  Vec3<T> friction;   // and per its rate
  std::size_t first_block = 0, last_block = 0;
};
using ReducedSegment = ReducedSegmentOf<double>;

/// Which terms the tangent holds. less_implicit: the stiff tangent, solved as by our
/// reconstruction of a recursion that is "less implicit" than the composite matrix.
enum class ReducedTangent { exact, stiff, less_implicit };

struct ReducedOptions {
  int dofs = 3;  // 3: bend_twist, 2: bend, 1: bend_planar
  ReducedTangent tangent = ReducedTangent::exact;
  TreeMethod method = TreeMethod::recursive;
  /// The section's rotational inertia about the tangent, rho (I1 + I2) per length, at the
  /// ends of helices (trapezoidal rule), of a rigid link as one. Without it the mass
  /// matrix of a straight strand with twist is singular.
  bool rotary_inertia = true;
  int quadrature = 0;  // Gauss-Legendre points a segment; 0: by the angle it winds
};

/// The catalogue parameters of these options, and how they are read.
std::span<const Parameter> reduced_parameters();
ReducedOptions reduced_options(const Parameters& parameters);

/// What unknowns of a segment are: the curvatures of a helix, or the rotation vector of a
/// ball joint, which stands for the bending of half of each of its neighbours.
enum class Unknown { curvature, joint_angle };

/// A strand made ready for ReducedSystem.
struct ReducedStrand {
  std::vector<ReducedSegment> segments;
  std::vector<PointBlock> blocks;
  RootMotion root;
  std::optional<FreeRoot> free_root;
  double root_rotor = 0;  // as ReducedSegment::rotor, of a free root
  Frame to_tip;  // from the frame of the last segment's tip to its section's, as at rest
  Effects effects;
  ReducedTangent tangent = ReducedTangent::exact;
  TreeMethod method = TreeMethod::recursive;
  double unknown_scale = 1;  // typical size of an unknown: one radian over the length
  double length = 1;         // m
  double rate = 1;  // 1/s, of swinging and bending, the root of their squares' sum
  bool regular_mass = true;
};

/// Throws InputError where modes and geometry do not fit together: a branched, twisted or
/// laterally curved strand in the plane, a free root in the plane or behind a ball joint.
ReducedStrand reduced_strand(const Strand& strand, Unknown unknown,
                             const ReducedOptions& options, Effects effects);

/// Gauss-Legendre points for a segment that winds by `angle` (rad): the mass matrix is
/// then within 1e-8 of its integral (tests/models/reduced/test_quadrature.cpp).
int quadrature_points(double angle);

}  // namespace tress::models
