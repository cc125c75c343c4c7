#pragma once

#include "models/head/head_units.h"
#include "models/head/lane_head.h"
#include "models/head/reduced_kernel.h"
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

/// Unknowns of an element in units of the batch.
struct ReducedStart {
  Vec rest, initial;  // at rest, and at t = 0
};
/// Returns the unknowns of element i at rest and at t = 0.
template <class Kind>
ReducedStart start_of(const Strand& strand, const LaneOptions& options,
                      const HeadUnits& units, std::size_t i) {
  const double unit = Kind::unit(units.length);
  const Vec rest = unit * Kind::at_rest(strand, i, &Segment::natural);
  Vec initial = unit * Kind::at_rest(strand, i, &Segment::initial);
  if (!options.twist) initial.x = rest.x;  // held
  return {rest, initial};
}

/// Throws InputError unless these numbers make sense.
inline void check_for_reduced_head(const LaneOptions& options) {
  check_for_head(options);
  refuse_if(options.points < 2 || options.points > most_points_of_element,
            std::to_string(options.points) + " points of an element", place_of_head,
            "use 2 to 16");
}

}  // namespace tress::models
