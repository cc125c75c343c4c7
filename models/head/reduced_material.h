#pragma once

#include "models/head/head_units.h"
#include "models/head/lane_head.h"
#include "models/head/reduced_kernel.h"
#include "models/head/strain_entries.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Sets the properties common to all elements of a strand, in one lane.
template <class Kind>
void set_material(const Strand& strand, const LaneOptions& options,
                  const HeadUnits& units, int lane,
                  ReducedMaterial<typename Kind::Real>& m) {
  const Segment& first = strand.segments.front();
  const double density = strand.material.density * first.section.area();
  const double length = first.length / units.length, bending = units.stiffness(),
               moment = Kind::moment(length);
  set_lane(m.length, lane, length);
  set_lane(m.density, lane, density / units.density);
  set_lane(m.drag, lane,
           (options.drag + options.mass_damping * density) * units.time / units.density);
  set_lane(m.stiffness, lane,
           moment / bending * stiffness(strand.material, first.section));
  set_lane(m.friction, lane,
           moment * strand.material.internal_friction / (bending * units.time));
  const double polar = options.rotary_inertia ? first.section.polar() : 0;
  set_lane(m.rotor, lane,
           length * strand.material.density * polar /
               (units.density * units.length * units.length));
}

/// Unknowns of an element in units of the batch: Vec or LinearStrain.
template <class Strain>
struct ReducedStart {
  Strain rest, initial;  // at rest, and at t = 0
};
/// Sets the twist of `to`, which is held, to that of `from`.
inline void hold_twist(const Vec& from, Vec& to) { to.x = from.x; }
/// Sets the twist of `to`, which is held, to that of `from`.
inline void hold_twist(const LinearStrain& from, LinearStrain& to) {
  hold_twist(from.mean, to.mean);
  hold_twist(from.half, to.half);
}
/// Returns the unknowns of element i at rest and at t = 0.
template <class Kind>
auto start_of(const Strand& strand, const LaneOptions& options, const HeadUnits& units,
              std::size_t i) {
  const double unit = Kind::unit(units.length);
  const auto rest = unit * Kind::at_rest(strand, i, &Segment::natural);
  auto initial = unit * Kind::at_rest(strand, i, &Segment::initial);
  if (!options.twist) hold_twist(rest, initial);
  return ReducedStart<decltype(initial)>{rest, initial};
}

/// Throws InputError if the points cannot carry the integrals of a clothoid.
inline void check_for_clothoids(const LaneOptions& options) {
  refuse_if(options.points < 4, std::to_string(options.points) + " points of a clothoid",
            place_of_head, "use 4 to 16");
}
/// Throws InputError unless these numbers make sense.
inline void check_for_reduced_head(const LaneOptions& options) {
  check_for_head(options);
  refuse_if(options.points < 2 || options.points > most_points_of_element,
            std::to_string(options.points) + " points of an element", place_of_head,
            "use 2 to 16");
}

}  // namespace tress::models
