#pragma once

#include <string_view>
#include <vector>

#include "models/strand/strand.h"

namespace tress {

/// The five trees of [Bertails-Descoubes 2010, "Performance results"]. The source gives
/// names and element counts; the geometry is ours.
///
/// | name         | elements | what it is                                        | height
/// |
/// |--------------|----------|---------------------------------------------------|--------|
/// | palm_tree    | 8        | bent trunk of 2, 6 drooping fronds of 1           | 3 m |
/// | algae        | 10       | short stalk, 3 wavy stems of 3                    | 0.4 m
/// | | complex_tree | 50       | trunk of 5, 5 branches of 3, each with 2 of 2,    | 4 m
/// | |              |          | each of those with 1 of 1; golden-angle azimuths  | | |
/// man          | 81       | spine 4, neck, head 2, arms 16 each with five     | 1.7 m  |
/// |              |          | fingers of 2, legs 6 each, 10 hairs of 3          | | |
/// willow       | 242      | trunk of 4, 7 limbs of 4, each with 6 twigs of 5  | 4 m    |
///
/// Sections are circles. Those of the plants follow the pipe model [Shinozaki et al.
/// 1964; da Vinci's rule]: the area is proportional to the length of all that grows
/// beyond, so areas add up at a fork. Arcs are in the natural shape; limbs that droop or
/// rise do so by the tropism of [Prusinkiewicz & Lindenmayer 1990, section 1.10].
/// `initial` is the natural shape: at t = 0 gravity has not bent anything yet.
///
/// The geometry is meant for a root of frame `upright()`, also for what starts at the
/// root in other directions (the man's legs).
inline constexpr std::string_view tree_choices =
    "palm_tree|algae|complex_tree|man|willow";

/// Parents before children, all lengths and radii in m. Throws InputError on another
/// name.
std::vector<Segment> tree_segments(std::string_view name);

/// A material with which the tree stands under gravity: green wood, kelp, or the rubber
/// of a doll. Internal friction is one number for all sections: it is chosen for the
/// thinnest, thick ones are damped less. Throws InputError on another name.
Material tree_material(std::string_view name);

/// The root frame: tangent up (e0 = z), e1 = y, e2 = -x. The man faces x.
Frame upright();

}  // namespace tress
