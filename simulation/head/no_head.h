#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "models/head/head.h"
#include "simulation/head/make_head.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Why a scene does not run as asked for, and what would make it so.
struct NoHead {
  std::string reason, remedy;  // cause and remedy for messages
  std::string key = {};        // of the scene that is the cause: "table.key"
  std::string place = {};      // file:line:column of the cause, where it is known
};

/// Returns the location of the cause in a scene's file; the file alone if it is not
/// there.
std::string place_of(const NoHead& no, const std::string& file);

/// Why the strands of a scene do not run in SIMD lanes with such numbers: the part of the
/// scene that has none. They are then systems of their own (ReplicatedHead).
std::optional<NoHead> no_lanes(const Scene& scene,
                               models::HeadNumber number = models::HeadNumber::float64);

/// Returns the reason against running a scene as one batch (models/head/head.h) with this
/// number type: physics, or a request of the scene. Only the tables of strands are read:
/// make_head() throws InputError where one of their strands does not fit.
std::optional<NoHead> no_head(const SceneOutline& outline,
                              models::HeadNumber number = models::HeadNumber::float64);

/// Returns whether a scene in lanes has springs. Where none of these functions is true it
/// has super-helices.
bool steps_springs(const Scene& scene);
/// Returns whether a scene in lanes has discrete elastic rods.
bool steps_rods(const Scene& scene);
/// Returns whether a scene in lanes has rods with a quaternion for every edge.
bool steps_quaternions(const Scene& scene);
/// Returns whether a scene in lanes has rigid links.
bool steps_chains(const Scene& scene);
/// Returns whether a scene in lanes has elements of linear curvature.
bool steps_clothoids(const Scene& scene);
/// Whether nodes carry mass and edges between them stretch.
bool steps_edges(const Scene& scene);
/// Methods that heads have, by the ids of integrators.
inline constexpr std::pair<std::string_view, HeadMethod> head_methods[] = {
    {"linearly_implicit_euler", HeadMethod::linearly_implicit_euler},
    {"linearly_implicit_midpoint", HeadMethod::linearly_implicit_midpoint},
    {"backward_euler", HeadMethod::backward_euler},
    {"tr_bdf2", HeadMethod::tr_bdf2}};
/// The one of a scene's integrator, if there is one.
std::optional<HeadMethod> head_method(const Scene& scene);

}  // namespace tress::simulation
