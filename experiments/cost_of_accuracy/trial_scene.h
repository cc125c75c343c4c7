#pragma once

#include <string>

#include "simulation/scene/changes.h"

namespace tress::experiments::cost_of_accuracy {

/// A scene whose model, integrator, numbers of elements and steps are for others to
/// choose. Throws InputError as read_scene does, and where the scene has no strand or
/// strands that touch each other.
Scene read_open_scene(const std::string& file);

/// The scene by this method, so many elements a strand, frames `rate` times a second and
/// steps that divide a frame. Throws InputError as with_elements does.
Scene trial_scene(Scene given, const Method& method, int elements, int substeps,
                  double rate);

/// What the answer of the rod itself depends on, for keys of references: the scene
/// without what is chosen, and what the files have that it names.
std::string physics(Scene scene);

/// Newton's corrections below 1e-6 of the scale of an unknown: a thousandth of the
/// smallest error that is asked for.
inline constexpr double newton_tolerance = 1e-6;

}  // namespace tress::experiments::cost_of_accuracy
