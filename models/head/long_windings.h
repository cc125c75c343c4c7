#pragma once

#include "models/head/helix_element.h"

/// Functions of LaneFunctions for elements that wind by more than 1.5 rad: series of 16
/// terms up to 4.5 rad, closed forms beyond. Only long_windings.cpp and device code
/// include this file. The products that the compiler fuses depend on a source's options,
/// so the linker must not find a second definition.
namespace tress::models {

template <class T>
auto LaneFunctions<T>::longer(Numbers arc, Numbers squared, Numbers angle)
    -> HelixFunctions<Numbers> {
  const T s(arc), x2(squared), winding(angle);
  HelixFunctions<T> all = helix::series<16>(s, x2);
  for (int lane = 0; lane < T::lanes; ++lane) {
    if (!(lane_of(winding, lane) > helix::long_end)) continue;
    set_lane(all, lane, helix::closed_forms(lane_of(s, lane), lane_of(x2, lane)));
  }
  HelixFunctions<Numbers> numbers;
  for (std::size_t i = 0; i < std::size(HelixFunctions<T>::all); ++i) {
    numbers.*HelixFunctions<Numbers>::all[i] = (all.*HelixFunctions<T>::all[i]).numbers();
  }
  return numbers;
}

}  // namespace tress::models
