#pragma once

#include <memory>
#include <span>

#include "models/effects/strand_interaction.h"
#include "models/head/head.h"
#include "simulation/head/halo.h"
#include "simulation/head/head_division.h"
#include "simulation/head/head_guard.h"
#include "simulation/head/head_passages.h"
#include "simulation/head/make_head.h"
#include "simulation/head/no_head.h"
#include "simulation/head/ranks.h"
#include "simulation/rest/held_shape.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Strands of a rank at t = 0, of a scene that no_head() accepts. They are in SIMD lanes
/// or, where no_lanes() has a reason, a ReplicatedHead. Unless the scene gives the number
/// of quadrature points, lanes have the largest number that any strand of the scene
/// needs. `threads` threads pass twice over the strands, a thousand at a time.
struct SceneHead {
  std::unique_ptr<models::StrandInteraction> interaction;  // or null; outlives the head
  std::unique_ptr<Head> head;                              // batch of the strands
  std::unique_ptr<HeadGuard> guard;                        // null: a head of no scene
  bool guarded = false;                                    // whether it judges the steps
  bool lanes = true;                                       // else a ReplicatedHead
  std::shared_ptr<const HeadDivision> division;  // null: all strands, in their order
  std::unique_ptr<Halo> halo;  // null: no other rank's strands may touch these
  std::unique_ptr<HeadPassages> passages;  // null: no bodies, or strands watch themselves
  std::vector<HeldShape> held;             // of a rest that is inverse, by places
};
/// Makes the strands of this process alone, in the order of the scene.
SceneHead make_head(const SceneOutline& outline, const HeadPack& pack, int threads);
/// Makes a batch of the strands that a scene holds: the guides of a groom, or those left
/// by only(). no_head() must accept the scene that they come from.
SceneHead make_head(const Scene& scene, const HeadPack& pack, int threads);
/// Makes the strands of each rank, with about equal sums of `cost` per rank; empty:
/// equally many. Throws InputError if there are fewer strands than ranks.
SceneHead make_head(const SceneOutline& outline, const HeadPack& pack, int threads,
                    Ranks& ranks, std::span<const double> cost = {});

/// Returns the longest step (s) of HeadRun::step() for the scene. Strands divide it into
/// steps of their own with a tolerance, or as systems that see no others.
double longest_step(const Scene& scene, bool lanes);

/// Returns the memory (bytes) of this number of strands, known before the batch is made.
std::size_t head_bytes(const SceneOutline& outline, const HeadPack& pack,
                       std::size_t strands);

}  // namespace tress::simulation
