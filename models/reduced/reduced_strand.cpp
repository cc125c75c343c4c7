#include "models/reduced/reduced_strand.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "contract/constants.h"
#include "contract/input_error.h"
#include "math/gauss_legendre.h"
#include "models/reduced/pitfalls.h"
#include "models/reduced/winding.h"
#include "models/strand/geometry.h"
#include "models/strand/rod_joint.h"

namespace tress::models {
namespace {

constexpr Parameter own_parameters[] = {
    {.name = "modes",
     .help = "unknowns of an element. `bend_twist`: bending about e1 and e2, "
             "and twist. `bend`: without twist. `bend_planar`: bending about e1 "
             "alone, in the plane of tangent and e2",
     .choices = "bend_twist|bend|bend_planar"},
    {.name = "solver",
     .help = "linear solver; recursive_plain is the textbook update (loses digits)",
     .choices = "recursive|composite|sparse|recursive_plain"},
    {.name = "jacobian",
     .help = "terms of dr/dq and dr/dv. exact: all. elastic: mass, friction and elastic "
             "stiffness. elastic_local: as elastic, without the stiffness of distal "
             "elements in the recursion",
     .choices = "exact|elastic|elastic_local"},
    {.name = "rotary_inertia",
     .help = "rotational inertia of the section about the tangent",
     .choices = "on|off"},
    {.name = "quadrature",
     .help = "Gauss-Legendre points per element; 0: chosen by the largest angle that an "
             "element winds, of all strands with the same number of elements",
     .number = 0,
     .min = 0,
     .max = 64,
     .whole = true},
};

constexpr std::string_view plain_solver = "recursive_plain";

Vec times(const Vec& x, const Vec& y) { return {x.x * y.x, x.y * y.y, x.z * y.z}; }
LinearStrain times(const Vec& x, const LinearStrain& y) {
  return {times(x, y.mean), times(x, y.half)};
}

/// 1 for the components that are unknowns.
Vec unknowns(int dofs) { return {dofs == 3 ? 1.0 : 0, 1, dofs == 1 ? 0.0 : 1}; }

bool identity(const Frame& f) { return f.e0.x == 1 && f.e1.y == 1 && f.e2.z == 1; }

/// Returns null for a segment at the root.
const Segment* parent_of(const Strand& strand, const Segment& segment) {
  return segment.parent < 0 ? nullptr
                            : &strand.segments[static_cast<std::size_t>(segment.parent)];
}

/// Integral over a joint's arc length of a shape that is constant on every segment.
Vec joint_angle(const Strand& strand, std::size_t i, Vec Segment::*shape) {
  const Segment& segment = strand.segments[i];
  Vec angle = segment.length / 2 * (segment.*shape);
  if (segment.parent >= 0) {
    const Segment& before = strand.segments[static_cast<std::size_t>(segment.parent)];
    angle = angle + before.length / 2 * (before.*shape);
  }
  return angle;
}

constexpr const char* place = "model option modes";

void check_plane(const Strand& strand) {
  refuse_if(strand.free_root.has_value(), "a free root does not stay in a plane", place,
            "use modes = bend or bend_twist with motion = free");
  for (const Segment& segment : strand.segments) {
    refuse_if(!identity(segment.mount), "branches leave the plane", place,
              "use modes = bend or bend_twist for trees");
    for (const Vec& shape :
         {segment.natural, segment.initial, segment.natural_half, segment.initial_half}) {
      refuse_if(shape.x != 0 || shape.z != 0,
                "a shape with twist or curvature about e2 leaves the plane", place,
                "use modes = bend or bend_twist, or a natural curvature about e1 alone");
    }
  }
}

void add_points(ReducedStrand& reduced, ReducedSegment& segment, double density_area,
                int points) {
  const std::vector<QuadraturePoint> rule = gauss_legendre(points, segment.length);
  segment.first_block = reduced.blocks.size();
  for (int first = 0; first < points; first += Pack::lanes) {
    PointBlock block;
    for (int lane = 0; lane < Pack::lanes; ++lane) {
      QuadraturePoint point{segment.length / 2, 0};  // unused lanes carry no mass
      if (first + lane < points) point = rule[static_cast<std::size_t>(first + lane)];
      block.s.set(lane, point.at);
      block.length.set(lane, point.weight);
      block.mass.set(lane, density_area * point.weight);
    }
    reduced.blocks.push_back(block);
  }
  segment.last_block = reduced.blocks.size();
}

/// Each segment's inertia about its tangent. For a helix, half of it is lumped at its
/// start, where its parent's tip turns; for a rigid link all of it. The difference of a
/// clothoid's twist turns neither end. It turns the section at x by l x (x - 1), with the
/// inertia l^3/30. Its coupling to the turning of the ends is omitted.
void add_rotors(ReducedStrand& reduced, const Strand& strand, Unknown unknown) {
  const bool rigid = unknown == Unknown::joint_angle;
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    const Segment& segment = strand.segments[i];
    const double half = strand.material_of(segment).density * segment.section.polar() *
                        segment.length / 2;
    reduced.segments[i].rotor += rigid ? 2 * half : half;
    if (unknown == Unknown::linear_curvature) {
      reduced.segments[i].inertia.half.x = half * segment.length * segment.length / 15;
    }
    if (rigid) continue;
    if (segment.parent >= 0) {
      reduced.segments[static_cast<std::size_t>(segment.parent)].rotor += half;
    } else {
      reduced.root_rotor += half;
    }
  }
}

}  // namespace

bool loses_digits(std::string_view option, std::string_view word) {
  return option == "solver" && word == plain_solver;
}

std::span<const Parameter> reduced_parameters() { return own_parameters; }

ReducedOptions reduced_options(const Parameters& p) {
  const std::string_view modes = p.word("modes"), solver = p.word("solver"),
                         jacobian = p.word("jacobian");
  ReducedOptions options;
  options.dofs = modes == "bend_twist" ? 3 : modes == "bend" ? 2 : 1;
  options.method = solver == "composite"    ? TreeMethod::composite
                   : solver == "sparse"     ? TreeMethod::sparse
                   : solver == plain_solver ? TreeMethod::recursive_plain
                                            : TreeMethod::recursive;
  options.jacobian = jacobian == "exact"     ? ReducedJacobian::exact
                     : jacobian == "elastic" ? ReducedJacobian::elastic
                                             : ReducedJacobian::elastic_local;
  options.rotary_inertia = p.word("rotary_inertia") == "on";
  options.quadrature = p.whole("quadrature");
  return options;
}

// Largest error of an entry (i, j) of an element's mass matrix, free root included, over
// sqrt(M_ii M_jj) (largest diagonal entries of their kinds), for any direction of the
// Darboux vector; tests/models/reduced/test_quadrature.cpp prints it:
//
//     angle/pi   4 points       8      12      16      20
//         0.1       1e-08   5e-16
//         0.25      4e-07   4e-16
//         0.5       9e-06   3e-15
//         1         4e-04   3e-11   3e-16
//         1.5       4e-03   1e-08   4e-16
//         2         4e-02   1e-06   5e-13   4e-16
//         3         2e-01   4e-04   5e-09   3e-15
//         4         2e-01   1e-02   2e-06   2e-11   8e-16
//         5         3e-01   9e-02   2e-04   1e-08   8e-14
//         6         7e-01   2e-01   4e-03   2e-06   5e-11
//
// The constant-curvature error of an element of that angle is far larger, about
// angle^2/12; 1e-8 makes quadrature negligible when models are compared at different
// element counts. It is reached at 0.29, 4.7, 9.8, 15.6, 21.8, 28.3, 35.3 rad with 4, 8
// ... 28 points, in steps of a pack; the last line of quadrature_points() fits these.
int quadrature_points(double angle) {
  constexpr double widest = 6500;  // rad, for some 4100 points
  if (!(angle <= widest)) {
    throw InputError("an element winds by more than 6500 rad", "natural or initial shape",
                     "use more elements, or less curvature and twist");
  }
  if (angle <= 0.28) return 4;
  if (angle <= 4.6) return 8;
  if (angle <= 9.7) return 12;
  if (angle <= 15.5) return 16;
  return 4 * static_cast<int>(std::ceil((angle + 10) / 6.35));
}

// Largest errors of a clothoid at its tip (frame, position, W e_k), and at its points,
// over the length, for several directions of a Darboux vector that is constant, or grows
// from nothing (then with twice the angle here, the sum of those of mean and half);
// tests/models/clothoid/test_clothoid.cpp prints them:
//
//     angle          8 points       12             16             20
//     1 constant     9e-14 5e-10    9e-14 7e-13
//     1 growing      6e-15 3e-08    6e-15 1e-12
//     4 constant     9e-14 7e-06    9e-14 7e-10    9e-14 9e-11
//     4 growing      8e-11 9e-06    1e-14 6e-09    1e-14 2e-11
//     8 constant     1e-08 7e-04    1e-12 1e-06    1e-12 1e-09
//     8 growing      4e-08 2e-04    2e-13 6e-07    2e-13 1e-09
//    12 growing      2e-06 1e-03    1e-11 1e-05    1e-12 5e-08    1e-12 1e-09
//
// Gauss points are nodes of superconvergence for the tip. The points, whose errors
// average out of mass integrals as much, keep some 1e-8; motion may wind an element by
// more.
int clothoid_points(double angle) {
  refuse_if(!(angle <= most_clothoid_winding),
            "an element of linear curvature winds by more than 24 rad",
            "natural or initial shape", "use more elements, or less curvature and twist");
  return angle <= 1    ? 8
         : angle <= 4  ? 12
         : angle <= 8  ? 16
         : angle <= 12 ? 20
                       : 4 * static_cast<int>(std::ceil((angle + 8) / 4));
}

double largest_winding(const Strand& strand, bool linear) {
  double winding = 0;
  for (const Segment& segment : strand.segments) {
    for (const auto& [mean, half] :
         {LinearStrain{segment.natural, segment.natural_half},
          LinearStrain{segment.initial, segment.initial_half}}) {
      winding =
          std::max(winding, segment.length * (norm(mean) + (linear ? norm(half) : 0)));
    }
  }
  return winding;
}

int points_of_segment(Unknown unknown, double angle) {
  if (unknown == Unknown::joint_angle) return Pack::lanes;
  return unknown == Unknown::linear_curvature ? clothoid_points(angle)
                                              : quadrature_points(angle);
}

double reduced_scale(const Strand& strand, bool joints) {
  return joints ? 1 / static_cast<double>(strand.segments.size()) : 1 / strand.length();
}

double reduced_rate(const Strand& strand) {
  const Material material = strand.material_of(strand.segments.front());
  const CrossSection& section = strand.segments.front().section;
  const double length = strand.length();
  // First frequency of a clamped beam: 3.516 sqrt(EI / (rho S L^4)).
  const double bending = 12.36 * material.youngs_modulus * section.inertia1() /
                         (material.density * section.area() * std::pow(length, 4));
  return std::sqrt(earth_gravity / length + bending);
}

ReducedStrand reduced_strand(const Strand& strand, Unknown unknown,
                             const ReducedOptions& options, Effects effects) {
  check(strand);
  const bool joints = unknown == Unknown::joint_angle;
  if (options.dofs == 1) check_plane(strand);
  const bool linear = unknown == Unknown::linear_curvature;
  const Vec free = unknowns(options.dofs), held = Vec{1, 1, 1} - free;

  ReducedStrand reduced;
  reduced.root = strand.root;
  reduced.free_root = strand.free_root;
  reduced.effects = std::move(effects);
  reduced.jacobian = options.jacobian;
  reduced.method = options.jacobian == ReducedJacobian::elastic_local
                       ? TreeMethod::elastic_local
                       : options.method;
  const int points = options.quadrature > 0
                         ? options.quadrature
                         : points_of_segment(unknown, largest_winding(strand, linear));
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    const Segment& from = strand.segments[i];
    ReducedSegment segment;
    segment.parent = from.parent;
    segment.length = from.length;
    segment.mount = from.mount;
    segment.mounted = !identity(from.mount);
    const Material material = strand.material_of(from);
    Vec moment = from.length * stiffness(material, from.section);
    Vec friction = (from.length * material.internal_friction) * Vec{1, 1, 1};
    if (joints) {
      const RodJoint joint = rod_joint(strand, parent_of(strand, from), from, {});
      moment = joint.stiffness;
      friction = joint.friction;
    }
    const auto of_squares = [linear](const Vec& x) {
      return LinearStrain{x, linear ? 1.0 / 3 * x : Vec{}};
    };
    segment.stiffness = of_squares(times(free, moment));
    segment.friction = of_squares(times(free, friction));
    const LinearStrain natural =
        joints ? LinearStrain{joint_angle(strand, i, &Segment::natural), {}}
               : LinearStrain{from.natural, from.natural_half};
    const LinearStrain initial =
        joints ? LinearStrain{joint_angle(strand, i, &Segment::initial), {}}
               : LinearStrain{from.initial, from.initial_half};
    segment.rest = times(free, natural);
    segment.initial = times(free, initial);
    segment.held = times(held, natural);
    add_points(reduced, segment, material.density * from.section.area(), points);
    reduced.segments.push_back(segment);
  }
  if (options.rotary_inertia) add_rotors(reduced, strand, unknown);
  reduced.rigid_links = joints;
  if (joints) {  // beyond the last half of a link there is no joint
    const Segment& last = strand.segments.back();
    reduced.to_tip = helix_turn(times(free, last.natural), last.length / 2);
  }

  reduced.length = strand.length();
  reduced.rate = reduced_rate(strand);
  reduced.unknown_scale = reduced_scale(strand, joints);
  // A free root's frame before the first joint has no mass.
  const bool massless_root = joints && strand.free_root.has_value();
  reduced.regular_mass = (options.dofs < 3 || options.rotary_inertia) && !massless_root;
  return reduced;
}

}  // namespace tress::models
