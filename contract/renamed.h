#pragma once

#include <string_view>

namespace tress {

/// Former name of a key, value, column, id, option or program, and its present name.
/// `./tress rename FILE...` reads this list and converts scenes and tables.
struct Renamed {
  std::string_view before, now;  // former and present name
};
/// All former names.
inline constexpr Renamed renamed_names[] = {
    // ids
    {"semi_implicit_euler", "linearly_implicit_euler"},
    // keys, and the columns of tables with the same names
    {"acceleration_m_s2", "gravity_m_s2"},
    {"cuts", "mesh"},
    {"density_1_m2", "density_per_m2"},
    {"frames_1_s", "frames_per_s"},
    {"frequency_1_s", "frequency_hz"},
    {"fuzz_1_m", "fuzz_per_m"},
    {"gravity", "gravity_m_s2"},
    {"head_angle_rad", "angle_rad"},
    {"initial_curvature_1_m", "initial_curvature_per_m"},
    {"mass_damping_1_s", "mass_damping_per_s"},
    {"natural_curvature_1_m", "natural_curvature_per_m"},
    {"natural_curvature2_1_m", "natural_curvature2_per_m"},
    {"natural_twist_1_m", "natural_twist_per_m"},
    {"nu_kg_m_s", "drag_kg_m_s"},
    {"peer", "simulator"},
    {"penalty_1_s2", "penalty_per_s2"},
    {"pixels_1_m", "pixels_per_m"},
    {"rate_1_s", "rate_per_s"},
    {"root", "motion"},
    {"smooth_1_s", "smooth_per_s"},
    {"stop_speed_m_s", "speed_m_s"},
    {"stop_time_s", "time_s"},
    {"tangent", "jacobian"},
    {"tangent", "root_tangent"},
    {"tolerance", "position_tol_rel"},
    {"wave_1_m", "wave_per_m"},
    // values
    {"bits", "precision"},
    {"head", "batch"},
    {"less_implicit", "elastic_local"},
    {"seed", "published"},
    {"stiff", "elastic"},
    // columns of tables only
    {"achieved_over_asked", "error_over_tolerance"},
    {"claim_per_element_s", "ghost_search_per_element_s"},
    {"elements_regraded", "elements_remeshed"},
    {"exchange_per_element_s", "halo_exchange_per_element_s"},
    {"fixed_cuts", "fixed_mesh"},
    {"growth_1_s", "growth_per_s"},
    {"lanes", "simd_width"},
    {"lanes_of_retries", "retry_lane_share"},
    {"lost", "failed"},
    {"lost_strands", "failed_strands"},
    {"meet_per_element_s", "ghost_contact_per_element_s"},
    {"seed_fps", "published_fps"},
    {"state", "state_hash"},
    {"tolerance", "accepted_error_rel"},
    // options
    {"--bits", "--precision"},
    {"--lanes", "--simd-width"},
    // programs and commands
    {"peers", "other_simulators"},
    {"regrading", "adaptive_mesh"},
};

/// Whether `now` is the present name of what was called `before`.
constexpr bool renamed(std::string_view before, std::string_view now) {
  for (const Renamed& one : renamed_names) {
    if (one.before == before && one.now == now) return true;
  }
  return false;
}

}  // namespace tress
