#pragma once

#include <vector>

#include "simulation/head/scene_head.h"

namespace tress::simulation {

/// A scene's strands of one number of elements, as a scene of their own:
/// <name>.<elements>.
struct HeadClass {
  int elements;          // number of elements of each strand
  SceneOutline outline;  // scene of these strands
};

/// Returns whether strands may differ in their numbers of elements: their tables do, or
/// each gets the number that it needs ([groom] tolerance_m).
bool has_classes(const SceneOutline& outline);
/// Returns the classes of such a scene, ascending; each may run as a batch. `threads`
/// threads make every strand once. Throws InputError where a strand cannot be made.
std::vector<HeadClass> head_classes(const SceneOutline& outline, int threads);
/// no_head(), for those who run one head of a scene.
std::optional<NoHead> no_single_head(
    const SceneOutline& outline, models::HeadNumber number = models::HeadNumber::float64);
/// Returns the reason against running them together: strands that touch.
std::optional<NoHead> no_classes(const SceneOutline& outline);

}  // namespace tress::simulation
