#pragma once

#include <concepts>
#include <optional>
#include <string_view>
#include <vector>

#include "contract/parameters.h"
#include "math/pack.h"
#include "models/effects/effect.h"
#include "models/reduced/tree/tree_solver.h"
#include "models/strand/strain.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Four quadrature points that carry mass of a segment.
struct PointBlock {
  Pack s, mass, length;  // arc length (m), mass (kg) and length (m) of each point
};

/// One segment of a reduced-coordinate strand. Strains are over (twist, curvature 1,
/// curvature 2); entries of components that are not unknowns are 0 except in `held`.
/// Models of constant strain take the means (Strain = Vec).
template <class Strain = LinearStrain>
struct ReducedSegmentOf {
  ReducedSegmentOf() = default;
  /// Converts a segment with another kind of strain; Vec takes the mean.
  template <class Other>
  requires(!std::same_as<Other, Strain>) explicit ReducedSegmentOf(
      const ReducedSegmentOf<Other>& s)
      : parent(s.parent),
        length(s.length),
        mounted(s.mounted),
        mount(s.mount),
        rotor(s.rotor),
        held(s.held),
        rest(s.rest),
        initial(s.initial),
        stiffness(s.stiffness),
        friction(s.friction),
        inertia(s.inertia),
        first_block(s.first_block),
        last_block(s.last_block) {}

  int parent = -1;       // index of an earlier segment; -1: the root
  double length = 0;     // arc length, m
  bool mounted = false;  // mount is not the identity
  Frame mount;           // frame of the start in that of the parent's tip
  double rotor = 0;      // rotational inertia about the tangent at the tip, kg m^2
  Strain held;           // fixed values of components that are not unknowns
  Strain rest;           // unknowns at rest
  Strain initial;        // unknowns at t = 0
  Strain stiffness;      // generalised force per unknown
  Strain friction;       // generalised force per rate of an unknown
  Strain inertia;  // of the section's rotation, beyond the rotors; of linear strains
  std::size_t first_block = 0, last_block = 0;  // its blocks, the last excluded
};
/// Segment of linear strains.
using ReducedSegment = ReducedSegmentOf<>;

/// Terms of the Jacobian. The exact Jacobian has all terms. The elastic one has mass,
/// friction, elasticity, and effects made semidefinite. With elastic_local, the elastic
/// Jacobian is solved by our reconstruction of a recursion that is "less implicit" than
/// the composite matrix.
enum class ReducedJacobian { exact, elastic, elastic_local };

/// Options of reduced models.
struct ReducedOptions {
  int dofs = 3;  // 3: bend_twist, 2: bend, 1: bend_planar
  ReducedJacobian jacobian = ReducedJacobian::exact;  // terms of the Jacobian
  TreeMethod method = TreeMethod::recursive;          // solver of the linear equations
  /// The section's rotational inertia about the tangent, rho (I1 + I2) per length, lumped
  /// at the ends of helices (trapezoidal rule), for a rigid link as a whole. Without it
  /// the mass matrix of a straight strand with twist is singular.
  bool rotary_inertia = true;
  int quadrature = 0;  // Gauss-Legendre points per segment; 0: by its winding angle
};

/// Returns the catalogue parameters of ReducedOptions.
std::span<const Parameter> reduced_parameters();
/// Reads ReducedOptions from parameters of reduced_parameters().
ReducedOptions reduced_options(const Parameters& parameters);

/// Unknowns of a segment. curvature: twist and curvatures of a helix; linear_curvature:
/// those of a clothoid, two for each component; joint_angle: rotation vector of a ball
/// joint. A joint represents the bending of half of each adjacent link.
enum class Unknown { curvature, linear_curvature, joint_angle };

/// A strand prepared for ReducedSystem.
struct ReducedStrand {
  std::vector<ReducedSegment> segments;  // parents before children
  std::vector<PointBlock> blocks;        // quadrature points of all segments
  RootMotion root;                       // motion of the clamp
  std::optional<FreeRoot> free_root;     // none: the root is clamped
  double root_rotor = 0;                 // as ReducedSegment::rotor, of the root
  Frame to_tip;  // from the frame of the last segment's tip to its section's, at rest
  bool rigid_links = false;  // segments do not bend: joints lie between them
  Effects effects;           // effects on the strand
  ReducedJacobian jacobian = ReducedJacobian::exact;  // terms of the Jacobian
  TreeMethod method = TreeMethod::recursive;          // solver of the linear equations
  double unknown_scale = 1;                           // reduced_scale()
  double length = 1;                                  // length of the strand, m
  double rate = 1;                                    // reduced_rate()
  bool regular_mass = true;  // whether the mass matrix is regular
};

/// Returns a typical unknown: one radian over the length, in joints over their number.
double reduced_scale(const Strand& strand, bool joints);
/// Returns a typical rate (1/s), the root of the summed squares of swinging and bending
/// rates.
double reduced_rate(const Strand& strand);

/// Throws InputError if modes and geometry are incompatible: a branched, twisted or
/// laterally curved strand in the plane, a free root in the plane or with ball joints.
ReducedStrand reduced_strand(const Strand& strand, Unknown unknown,
                             const ReducedOptions& options, Effects effects);

/// Returns the number of Gauss-Legendre points of a segment that winds by `angle` (rad),
/// such that the mass matrix is within 1e-8 of its integral
/// (tests/models/reduced/test_quadrature.cpp).
int quadrature_points(double angle);

/// Returns that number for a segment whose curvature varies linearly. Its points also
/// carry the integrals of kinematics; those of the tip are within 1e-11 of the length.
/// `angle` is the sum of the angles of mean and half. Throws InputError above
/// most_clothoid_winding.
int clothoid_points(double angle);
/// Largest angle by which an element of linear curvature may wind, rad.
inline constexpr double most_clothoid_winding = 24;
/// Largest number of points of an element of linear curvature.
inline constexpr int most_clothoid_points = 32;

}  // namespace tress::models
