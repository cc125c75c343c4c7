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
  Pack s, mass, length;
};

/// One segment of a reduced-coordinate strand. Strains are over (twist, curvature 1,
/// curvature 2); entries of components that are not unknowns are 0 except in `held`.
/// Models of constant strain take the means (Strain = Vec).
template <class Strain = LinearStrain>
struct ReducedSegmentOf {
  ReducedSegmentOf() = default;
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

  int parent = -1;
  double length = 0;
  bool mounted = false;  // mount is not the identity
  Frame mount;
  double rotor = 0;  // rotational inertia about the tangent at the tip, kg m^2
  Strain held;       // fixed values of components that are not unknowns
  Strain rest;       // unknowns at rest
  Strain initial;    // unknowns at t = 0
  Strain stiffness;  // moment per unknown
  Strain friction;   // moment per rate of unknown
  Strain inertia;    // of the section's rotation, beyond the rotors; of linear strains
  std::size_t first_block = 0, last_block = 0;
};
using ReducedSegment = ReducedSegmentOf<>;

/// Terms of the Jacobian. elastic_local: the elastic Jacobian, solved by our
/// reconstruction of a recursion that is "less implicit" than the composite matrix.
enum class ReducedJacobian { exact, elastic, elastic_local };

struct ReducedOptions {
  int dofs = 3;  // 3: bend_twist, 2: bend, 1: bend_planar
  ReducedJacobian jacobian = ReducedJacobian::exact;
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

/// Unknowns of a segment: the curvatures of a helix, those of a clothoid (two for each
/// component), or the rotation vector of a ball joint. A joint represents the bending of
/// half of each adjacent link.
enum class Unknown { curvature, linear_curvature, joint_angle };

/// A strand prepared for ReducedSystem.
struct ReducedStrand {
  std::vector<ReducedSegment> segments;
  std::vector<PointBlock> blocks;
  RootMotion root;
  std::optional<FreeRoot> free_root;
  double root_rotor = 0;  // as ReducedSegment::rotor, of the root
  Frame to_tip;  // from the frame of the last segment's tip to its section's, at rest
  Effects effects;
  ReducedJacobian jacobian = ReducedJacobian::exact;
  TreeMethod method = TreeMethod::recursive;
  double unknown_scale = 1;  // reduced_scale()
  double length = 1;         // m
  double rate = 1;           // reduced_rate()
  bool regular_mass = true;
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
inline constexpr double most_clothoid_winding = 24;
inline constexpr int most_clothoid_points = 32;

}  // namespace tress::models
