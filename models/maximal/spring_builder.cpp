#include "models/maximal/spring_builder.h"

#include <cmath>

#include "models/strand/rod_joint.h"

namespace tress::models {
namespace {

// Threshold for the slope of an altitude over the dihedral angle and an edge: below it
// the rest shape is too straight for a tetrahedron.
constexpr double flat = 1e-3;
// The same for the sine of a bend beside a dihedral angle, and the one below which a bend
// no longer tells the angle (Dihedral::floor0).
constexpr double bent = 1e-3, vanishing = 1e-4;

}  // namespace

SpringBuilder::SpringBuilder(const Strand& strand, const NodalStrand& nodal)
    : strand_(strand), clamped_(nodal.parts.clamped), clamp_(nodal.root.place.frame) {
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    rest_.push_back(strand.segments[i].length * nodal.natural[i].e0);
  }
}

void SpringBuilder::add_stretch() {
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    const Segment& segment = strand_.segments[i];
    const double k = strand_.material_of(segment).youngs_modulus *
                     segment.section.area() / segment.length;
    add<Chord<1>>({{}, i, k, 0, segment.length});
  }
}

void SpringBuilder::add_bending(Bending bending) {
  if (clamped_) add_wall();
  for (std::size_t i = 0; i + 1 < rest_.size(); ++i) {
    const RodJoint j =
        rod_joint(strand_, &strand_.segments[i], strand_.segments[i + 1], {});
    const double stiffness = (j.stiffness.y + j.stiffness.z) / 2;
    const Vec* e = &rest_[i];
    if (bending == Bending::second_neighbour) {
      const double chord = Chord<2>{}.value(e);
      const double arm = std::sqrt(dot(e[0], e[0]) * dot(e[1], e[1])) / chord;
      add<Chord<2>>({{}, i, stiffness / (arm * arm), j.friction.y / (arm * arm), chord});
      continue;
    }
    const double curved = Hinge{}.value(e);
    const double rest =
        std::sqrt(std::max(0.0, curved * curved - Hinge::delta * Hinge::delta));
    if (bending == Bending::angular) {
      add<Hinge>({{}, i, stiffness, j.friction.y, rest});
    } else {
      add<BendAngle>({{}, i, stiffness, j.friction.y, 2 * std::atan(rest / 2)});
    }
  }
}

void SpringBuilder::add_altitudes() {
  if (clamped_ && rest_.size() >= 2) {
    WallAltitude wall{floor_at(0), strand_.segments[0].length, {}};
    wall.place(clamp_);
    add_altitude(wall, 0, 0);
  }
  for (std::size_t i = 0; i + 2 < rest_.size(); ++i) {
    add_altitude(Altitude{floor_at(i + 1)}, i, i + 1);
  }
}

void SpringBuilder::add_dihedrals() {
  for (std::size_t middle = clamped_ ? 0 : 1; middle + 1 < rest_.size(); ++middle) {
    const double length = strand_.segments[middle].length;
    const Vec e[3] = {middle == 0 ? length * clamp_.e0 : rest_[middle - 1], rest_[middle],
                      rest_[middle + 1]};
    const auto sides = [&](int k) { return norm(e[k]) * norm(e[k + 1]); };
    if (norm(cross(e[0], e[1])) < bent * sides(0) ||
        norm(cross(e[1], e[2])) < bent * sides(1)) {
      continue;
    }
    const Dihedral dihedral{Dihedral{}.value(e), std::pow(vanishing * sides(0), 2),
                            std::pow(vanishing * sides(1), 2)};
    const Segment& segment = strand_.segments[middle];
    const Material material = strand_.material_of(segment);
    const double k = material.shear_modulus * segment.section.torsion() / length;
    const double friction = material.internal_friction / length;
    if (middle == 0) {
      add<WallDihedral>({{dihedral, length, {}}, 0, k, friction, 0});
    } else {
      add<Dihedral>({dihedral, middle - 1, k, friction, 0});
    }
  }
}

template <class Strain>
void SpringBuilder::add(Spring<Strain> spring) {
  std::get<std::vector<Spring<Strain>>>(springs).push_back(std::move(spring));
}

void SpringBuilder::add_wall() {
  const RodJoint j = rod_joint(strand_, nullptr, strand_.segments[0], {});
  const double stiffness = (j.stiffness.y + j.stiffness.z) / 2;
  for (const WallBend::About about : {WallBend::About::e1, WallBend::About::e2}) {
    WallBend strain{about, {}, {}};
    strain.place(clamp_);
    add<WallBend>({strain, 0, stiffness, j.friction.y, strain.value(rest_.data())});
  }
}

double SpringBuilder::floor_at(std::size_t edge) const {
  return std::pow(Hinge::delta * dot(rest_[edge], rest_[edge]), 2);
}

/// `middle`: the edge about which the dihedral angle is measured.
template <class Strain>
void SpringBuilder::add_altitude(const Strain& strain, std::size_t first,
                                 std::size_t middle) {
  Vec slope[Strain::edges];
  const double rest = strain.gradient(&rest_[first], slope);
  const Segment& segment = strand_.segments[middle];
  // The last edge turns about the middle one.
  const Vec axis = (1 / segment.length) * rest_[middle];
  const double by_angle = dot(slope[Strain::edges - 1], cross(axis, rest_[middle + 1]));
  if (std::abs(by_angle) < flat * segment.length) return;
  const double scale = 1 / (segment.length * by_angle * by_angle);
  const Material material = strand_.material_of(segment);
  add<Strain>({strain, first, material.shear_modulus * segment.section.torsion() * scale,
               material.internal_friction * scale, rest});
}

}  // namespace tress::models
