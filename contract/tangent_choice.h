#pragma once

#include "contract/parameters.h"
#include "contract/tangent_choice.h"

namespace tress {

/// Terms included in dr/dq and dr/dv: all (full Newton), or only mass, damping and
/// elastic stiffness (semi-implicit Newton). A constructor option of models whose two
/// tangents differ.
enum class Tangent { exact, stiff };

/// The catalogue parameter of models whose two tangents differ.
inline constexpr Parameter tangent_parameter{
    .name = "tangent",
    .help = "terms of dr/dq, dr/dv: all, or mass and elastic stiffness only",
    .choices = "exact|stiff"};

inline Tangent tangent_choice(const Parameters& p) {
  return p.word("tangent") == "stiff" ? Tangent::stiff : Tangent::exact;
}

}  // namespace tress
