#pragma once

#include <cstdint>
#include <string>

namespace tress::testing_support {

/// A legal scene with numbers from far apart, and what physics allows it, from the
/// numbers themselves: none of the product's own bounds is asked.
struct RandomScene {
  std::string text;
  double mass = 0;         // kg, of all strands
  double lightest = 0;     // kg, of one
  double weight_work = 0;  // J: m g L of all strands, other uniform forces with gravity
  /// Nothing but its start and its weight drives it: its energy cannot rise.
  bool passive = true;
  double pushed = 0;   // m/s: what the root's motion or wind adds to a strand's speed
  double worked = 0;   // J/kg: what other effects may add
  double carried = 0;  // m/s: of the fastest place carried by the root's frame
};

/// The same scene for the same number.
RandomScene random_scene(std::uint64_t seed);

}  // namespace tress::testing_support
