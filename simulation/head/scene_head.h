#pragma once

#include <memory>
#include <span>

#include "models/effects/strand_interaction.h"
#include "models/head/head.h"
#include "simulation/head/halo.h"
#include "simulation/head/head_division.h"
#include "simulation/head/head_guard.h"
#include "simulation/head/make_head.h"
#include "simulation/head/no_head.h"
#include "simulation/head/ranks.h"
#include "simulation/rest/held_shape.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// The strands of a rank, of a scene that no_head() has nothing against, at t = 0: in
/// SIMD lanes, with the largest number of quadrature points that any strand of the scene
/// needs, if the scene does not say how many; or, where no_lanes() has a reason, as a
/// ReplicatedHead. Two passes over strands by so many threads, a thousand at a time.
struct SceneHead {
  std::unique_ptr<models::StrandInteraction> interaction;  // or null; outlives the head
  std::unique_ptr<Head> head;
  std::unique_ptr<HeadGuard> guard;              // null: a head of no scene
  bool guarded = false;                          // whether it judges the steps
  bool lanes = true;                             // else a ReplicatedHead
  std::shared_ptr<const HeadDivision> division;  // null: all strands, in their order
  std::unique_ptr<Halo> halo;   // null: no other rank's strands may touch these
  std::vector<HeldShape> held;  // of a rest that is inverse, by places
};
SceneHead make_head(const SceneOutline& outline, const HeadPack& pack, int threads);
/// The same of the strands that a scene holds: the guides of a groom, or those left by
/// only(). no_head() is asked of the scene that they come from.
SceneHead make_head(const Scene& scene, const HeadPack& pack, int threads);
/// By ranks, each with strands of about equal sums of `cost`; empty: equally many. Throws
/// InputError if there are fewer strands than ranks.
SceneHead make_head(const SceneOutline& outline, const HeadPack& pack, int threads,
                    Ranks& ranks, std::span<const double> cost = {});

/// Of a call of HeadRun::step() for the scene (s): of the intervals that strands divide
/// into steps of their own, with a tolerance, or as systems that see no others.
double longest_step(const Scene& scene, bool lanes);

/// Bytes that so many strands of a head take, known before it is made.
std::size_t head_bytes(const SceneOutline& outline, const HeadPack& pack,
                       std::size_t strands);

}  // namespace tress::simulation
