#pragma once

#include <string>

#include "simulation/scene/changes.h"

namespace tress::experiments::cost_of_accuracy {

/// A scene whose model, integrator, numbers of elements and steps are left open. Throws
/// InputError as read_scene does, and where the scene has no strand or strands that touch
/// each other.
Scene read_open_scene(const std::string& file);

/// The scene by this method, with `elements` per strand, `rate` frames per second and
/// steps that divide a frame. Throws InputError as with_elements does.
Scene trial_scene(Scene given, const Method& method, int elements, int substeps,
                  double rate);

/// Everything that determines the continuous solution, for keys of references: the scene
/// without the open choices, and the contents of the files it names.
std::string physics(Scene scene);

/// Newton's corrections below 1e-6 of the scale of an unknown: a thousandth of the
/// smallest target error.
inline constexpr double newton_tolerance = 1e-6;

}  // namespace tress::experiments::cost_of_accuracy
