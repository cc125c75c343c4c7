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

/// Quadrature points that carry the mass of a segment: four points of one strand or, in a
/// batch, the same point of four strands.
struct PointBlock {
  Pack s, mass, length;
};

/// One segment of a reduced-coordinate strand. Vectors are over (twist, curvature 1,
/// curvature 2); entries of components that are not unknowns are 0 except in `held`.
/// T = Pack: the same segment of four strands.
template <class T>
struct ReducedSegmentOf {
  int parent = -1;
  T length{};
  bool mounted = false;  // mount is not the identity
  FrameOf<T> mount;
  T rotor{};          // rotational inertia about the tangent at the tip, kg m^2
  Vec3<T> held;       // fixed values of components that are not unknowns
  Vec3<T> rest;       // unknowns at rest
  Vec3<T> initial;    // unknowns at t = 0
  Vec3<T> stiffness;  // moment per unknown
  Vec3<T> friction;   // moment per rate of unknown
  std::size_t first_block = 0, last_block = 0;
};
using ReducedSegment = ReducedSegmentOf<double>;

/// Terms of the tangent. less_implicit: the stiff tangent, solved by our reconstruction
/// of a recursion that is "less implicit" than the composite matrix.
enum class ReducedTangent { exact, stiff, less_implicit };

struct ReducedOptions {
  int dofs = 3;  // 3: bend_twist, 2: bend, 1: bend_planar
  ReducedTangent tangent = ReducedTangent::exact;
  TreeMethod method = TreeMethod::recursive;
  /// The section's rotational inertia about the tangent, rho (I1 + I2) per length, lumped
  /// at the ends of helices (trapezoidal rule), for a rigid link as a whole. Without it
  /// the mass matrix of a straight strand with twist is singular.
  bool rotary_inertia = true;
  int quadrature = 0;  // Gauss-Legendre points per segment; 0: by its winding angle
};

/// The catalogue parameters of these options, and their reader.
std::span<const Parameter> reduced_parameters();
ReducedOptions reduced_options(const Parameters& parameters);

/// Unknowns of a segment: the curvatures of a helix, or the rotation vector of a ball
/// joint, which represents the bending of half of each adjacent link.
enum class Unknown { curvature, joint_angle };

/// A strand prepared for ReducedSystem.
struct ReducedStrand {
  std::vector<ReducedSegment> segments;
  std::vector<PointBlock> blocks;
  RootMotion root;
  std::optional<FreeRoot> free_root;
  double root_rotor = 0;  // as ReducedSegment::rotor, for a free root
  Frame to_tip;  // from the frame of the last segment's tip to its section's, at rest
  Effects effects;
  ReducedTangent tangent = ReducedTangent::exact;
  TreeMethod method = TreeMethod::recursive;
  double unknown_scale = 1;  // typical size of an unknown: one radian over the length
  double length = 1;         // m
  double rate = 1;  // 1/s, root of the summed squares of swinging and bending rates
  bool regular_mass = true;
};

/// Throws InputError if modes and geometry are incompatible: a branched, twisted or
/// laterally curved strand in the plane, a free root in the plane or with ball joints.
ReducedStrand reduced_strand(const Strand& strand, Unknown unknown,
                             const ReducedOptions& options, Effects effects);

/// Gauss-Legendre points for a segment that winds by `angle` (rad), such that the mass
/// matrix is within 1e-8 of its integral (tests/models/reduced/test_quadrature.cpp).
int quadrature_points(double angle);

}  // namespace tress::models
