#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "simulation/scene/gradient_table.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::statics {

/// The parameter of a path of equilibria: what varies in a scene, and its range.
struct Varied {
  /// Kind of a parameter.
  enum class Kind {
    gravity,      // factor on gravity
    point_force,  // factor on one [[effects.point_force]]
    supports,     // time of the keyframes of all supports, s
    number        // a number of the scene
  };

  Kind kind = Kind::gravity;
  std::string name;        // "gravity", "point_force_2", "supports", or the number's name
  std::string unit;        // unit of the parameter; 1: none
  std::size_t effect = 0;  // index of the effect, of gravity and point_force
  double from = 0, to = 1;
  simulation::SceneParameter number{};  // of kind `number`

  /// Returns |to - from|, > 0.
  double range() const { return std::abs(to - from); }
  /// Returns 1 for a range that ascends, -1 for one that descends.
  double direction() const { return to < from ? -1 : 1; }
};

/// Reads what varies: KEY or KEY=FROM..TO. Without text it is the supports if they move,
/// else the only point force, else gravity. Throws InputError naming `place` where the
/// scene has nothing of that name, or where both ends of the range are the same.
Varied varied(const simulation::Scene& scene, std::string_view text,
              const std::string& place);

/// Returns the scene with a value of its parameter. Throws InputError where the scene
/// does not admit the value.
simulation::Scene at_value(simulation::Scene scene, const Varied& varied, double value);

}  // namespace tress::experiments::statics
