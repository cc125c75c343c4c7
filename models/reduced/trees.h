#pragma once

#include <string_view>
#include <vector>

#include "models/strand/strand.h"

namespace tress::models {

/// The five trees of [Bertails-Descoubes 2010, "Performance results"]. The paper gives
/// names and element counts; the geometry is ours.
///
/// - palm_tree, 8 elements, highest tip 3.4 m above the root: bent trunk of 2, 6 drooping
///   fronds of 1.
/// - algae, 10 elements, 0.41 m: short stalk, 3 wavy stems of 3.
/// - complex_tree, 50 elements, 4.0 m: trunk of 5, 5 branches of 3, each with 2 of 2,
///   each of those with 1 of 1; golden-angle azimuths.
/// - man, 81 elements, 0.81 m above the pelvis, which is the root, 1.7 m from sole to
///   crown. Spine of 4, neck, head of 2. 2 arms of 6, each with 5 fingers of 2. 2 legs of
///   6, 10 hairs of 3.
/// - willow, 242 elements, 4.1 m: trunk of 4, 7 limbs of 4, each with 6 hanging twigs of
///   5.
///
/// Sections are circles. Those of the plants follow the pipe model [Shinozaki et al.
/// 1964; da Vinci's rule]. The area is proportional to the length of all that grows
/// beyond, so areas add up at a fork. Arcs are in the natural shape; limbs droop or rise
/// by the tropism of [Prusinkiewicz & Lindenmayer 1990, section 1.10]. `initial` is the
/// natural shape, not bent by gravity at t = 0.
///
/// The geometry is meant for a root with frame `upright()`. Several segments may start at
/// the root, as do the man's spine and both hips.
inline constexpr std::string_view tree_choices =
    "palm_tree|algae|complex_tree|man|willow";

/// Parents before children, all lengths and radii in m. Throws InputError on other names.
std::vector<Segment> tree_segments(std::string_view name);

/// Returns a plausible isotropic material with which the tree stands under gravity. The
/// materials are green wood (E = 6 GPa, nu = 0.3), kelp (20 MPa, 0.5) and soft rubber for
/// the man (10 MPa, 0.5).
/// Internal friction gamma is the same for all sections: about 10 ms EI of the thinnest
/// one; thick ones relax faster and are damped less. Throws InputError on other names.
Material tree_material(std::string_view name);

/// The root frame: tangent up (e0 = z), e1 = y, e2 = -x. The man faces x.
Frame upright();

}  // namespace tress::models
