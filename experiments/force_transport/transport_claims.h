#pragma once

#include <string_view>
#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::force_transport {

/// The models that the experiment force_transport compares, and Young's modulus of the
/// soft hair.
namespace transport {
inline constexpr std::string_view ours = "force_transport", theirs = "corde",
                                  chain = "articulated_chain", rod = "super_helix";
inline constexpr double seed_hair = 1e6;  // Pa
}  // namespace transport

/// Fills the columns that compare a row with the corresponding row of corde, of the rod
/// and of articulated_chain.
void compare_with_corde(std::vector<Row>& rows);

/// The claims about force_transport in the table.
void check_transport_claims(const std::vector<Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::force_transport
