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

/// Whether strands get as many elements as they need ([groom] tolerance_m).
bool has_classes(const SceneOutline& outline);
/// Of such a scene, ascending; each may run as a head. Every strand is made once, by so
/// many threads. Throws InputError where a strand cannot be made.
std::vector<HeadClass> head_classes(const SceneOutline& outline, int threads);
/// What speaks against running them side by side: strands that touch.
std::optional<NoHead> no_classes(const SceneOutline& outline);

}  // namespace tress::simulation
