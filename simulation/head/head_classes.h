#pragma once

#include <vector>

#include "simulation/head/scene_head.h"

namespace tress::simulation {

/// A scene's strands of one number of elements, as a scene of their own:
/// <name>.<elements>.
struct HeadClass {
  int elements;
  SceneOutline outline;
};

/// Whether strands may differ in their numbers of elements: their tables do, or they get
/// as many as they need ([groom] tolerance_m).
bool has_classes(const SceneOutline& outline);
/// Of such a scene, ascending; each may run as a head. Every strand is made once, by so
/// many threads. Throws InputError where a strand cannot be made.
std::vector<HeadClass> head_classes(const SceneOutline& outline, int threads);
/// no_head(), for those who run one head of a scene.
std::optional<NoHead> no_single_head(
    const SceneOutline& outline, models::HeadNumber number = models::HeadNumber::float64);
/// What speaks against running them side by side: strands that touch.
std::optional<NoHead> no_classes(const SceneOutline& outline);

}  // namespace tress::simulation
