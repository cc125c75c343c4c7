#pragma once

#include <string>
#include <string_view>

#include "contract/system.h"
#include "models/effects/effect.h"

namespace tress::models {

/// Words for System::not_finite, each empty where all is finite. Asked for after a
/// failure only: both may allocate.

/// The first place of `values` (`each` entries a place) that is not finite: "rate of
/// element 3" of the words "rate of element", with the first place called `first`.
std::string not_finite_place(In values, std::size_t each, std::string_view words,
                             std::size_t first = 0);

/// The first effect whose load is not finite, and at which of the points: "quadratic_drag
/// at point 7". `p` holds what the effects need.
std::string not_finite_load(const Effects& effects, double t, const Points& p);

/// "motion of the clamp" unless its place (m), velocity and acceleration are finite.
std::string not_finite_clamp(const Vec& x, const Vec& v, const Vec& a);

/// The first of several answers that is not empty. Each is a callable, asked in turn.
template <class... Ask>
std::string first_words(const Ask&... ask) {
  std::string words;
  static_cast<void>(((words = ask()).empty() && ...));
  return words;
}

}  // namespace tress::models
