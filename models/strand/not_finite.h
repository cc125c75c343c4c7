#pragma once

#include <string>
#include <string_view>

#include "contract/basics.h"
#include "models/effects/effect.h"

namespace tress::models {

/// Messages for System::not_finite, each empty if all is finite. They may allocate and
/// are used only after a failure.

/// The first item of `values` (`each` entries per item) that is not finite, for example
/// "rate of element 3" for words = "rate of element"; items are counted from `first`.
std::string not_finite_place(In values, std::size_t each, std::string_view words,
                             std::size_t first = 0);

/// The first effect whose load is not finite, and the point: "quadratic_drag at point 7".
/// `p` holds what the effects need.
std::string not_finite_load(const Effects& effects, double t, const Points& p);

/// "motion of the clamp" unless its position (m), velocity and acceleration are finite.
std::string not_finite_clamp(const Vec& x, const Vec& v, const Vec& a);

/// The first non-empty result of several callables, called in turn.
template <class... Ask>
std::string first_words(const Ask&... ask) {
  std::string words;
  static_cast<void>(((words = ask()).empty() && ...));
  return words;
}

}  // namespace tress::models
