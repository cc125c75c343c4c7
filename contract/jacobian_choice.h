#pragma once

#include "contract/jacobian_choice.h"
#include "contract/parameters.h"

namespace tress {

/// Terms included in dr/dq and dr/dv: all (`exact`, full Newton), or only mass, damping
/// and elastic stiffness (`elastic`, for methods with one linear solve). A constructor
/// option of models whose two Jacobians differ.
enum class Jacobian { exact, elastic };

/// The catalogue parameter of models whose two Jacobians differ.
inline constexpr Parameter jacobian_parameter{
    .name = "jacobian",
    .help = "terms of dr/dq, dr/dv: all, or mass and elastic stiffness only",
    .choices = "exact|elastic"};

/// Returns the value of jacobian_parameter.
inline Jacobian jacobian_choice(const Parameters& p) {
  return p.word("jacobian") == "elastic" ? Jacobian::elastic : Jacobian::exact;
}

}  // namespace tress
