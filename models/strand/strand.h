#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "math/frame.h"
#include "models/motion/root_motion.h"
#include "models/strand/material.h"

namespace tress::models {

/// Constants of a segment's material over those of its strand.
struct MaterialFactors {
  double modulus = 1;   // Young's modulus and shear modulus
  double density = 1;   // density
  double friction = 1;  // internal friction

  bool operator==(const MaterialFactors&) const = default;
};

/// One segment of a strand, which starts at the tip of `parent`, or at the root.
struct Segment {
  int parent = -1;       // index of an earlier segment, -1: the root
  double length = 0;     // m
  Frame mount;           // frame of this segment's start relative to the parent's tip
  CrossSection section;  // section of the segment
  Vec natural;           // twist and the two curvatures (about e0, e1, e2) at rest, 1/m
  Vec initial;           // twist and curvatures at t = 0, 1/m
  // How far the two are at the tip from their means above, if they vary linearly; read by
  // models whose elements can (LinearStrain of strain.h).
  Vec natural_half{}, initial_half{};  // natural and initial change, 1/m
  MaterialFactors factors{};           // material over that of the strand
};

/// The root is clamped to a prescribed motion, or free to move from an initial state.
struct FreeRoot {
  Vec position;  // m
  Frame frame;   // frame at the root
  Vec velocity;  // m/s
  Vec spin;      // rad/s, world components
};

/// A strand, or a tree of strands, the input of every strand model: material, segments,
/// rest shape, and motion of the root.
struct Strand {
  Material material;                  // material, times the factors of a segment
  std::vector<Segment> segments;      // parents before children
  RootMotion root;                    // motion of the clamp
  std::optional<FreeRoot> free_root;  // when set, `root` is not used

  double length() const;  // longest way from the root to a tip, m
  double mass() const;    // kg
  /// Returns the material of one of the segments.
  Material material_of(const Segment& segment) const;
  /// Returns whether all segments have the same section and material.
  bool uniform() const;
};

/// Returns GJ, EI1 and EI2 of a segment: stiffness of twist and the two curvatures, N
/// m^2.
Vec stiffness(const Strand& strand, const Segment& segment);

/// The Darboux vector (twist, curvature about e1, curvature about e2) of a shape over arc
/// length s in [0, length], 1/m.
using Shape = std::function<Vec(double s)>;
/// Returns the shape of constant Darboux vector (1/m).
Shape uniform_shape(Vec darboux);
/// Returns a helix of given radius and pitch (rise per turn, m). The curvature is
/// radius/(radius^2 + c^2) about e1 and the twist c/(radius^2 + c^2) with c = pitch/(2
/// pi); right-handed for pitch > 0. Throws InputError unless radius > 0 and both are
/// finite.
Shape helix_shape(double radius, double pitch);
/// A planar wave: curvature about e1 amplitude cos(2 pi s/wavelength), amplitude in 1/m.
/// Throws InputError unless both are finite and wavelength > 0.
Shape wavy_shape(double amplitude, double wavelength);

/// Discretisation of an unbranched strand: n segments, the last `grading` times as long
/// as the first (geometric series).
struct Discretisation {
  int elements = 20;    // number of segments
  double length = 0.1;  // m
  double grading = 1;   // ratio of the last length to the first
};

/// Makes a chain of segments. Natural shapes are averaged over each segment, and
/// projected to linear ones (Gauss-Legendre, 8 points). The rule is exact for polynomials
/// of degree 14, and within 1e-9 of the amplitude for a wave as long as the segment.
/// `initial` is the natural shape by default. Throws InputError unless there are
/// elements, lengths are positive and numbers finite.
Strand make_strand(const Material& material, const CrossSection& section,
                   const Discretisation& cut, const Shape& natural,
                   const Shape& initial = {});

/// Throws InputError naming the segment unless parents precede children, lengths are
/// positive, mounts are rotations and all numbers finite; also checks material and root.
void check(const Strand& strand);

}  // namespace tress::models
