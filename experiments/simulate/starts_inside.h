#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulation/scene/scene.h"
#include "simulation/scene/support_table.h"

namespace tress::experiments::scene_runs {

using namespace simulation;

/// Finds the strands whose axes begin inside bodies. Contact prevents that a strand
/// enters a body and assumes a start outside. A clamped root may be inside. A strand that
/// begins in an equilibrium does not count, because the surface supports it there. With
/// rest = "inverse" all do so.
class StartsInside {
 public:
  /// Makes the bodies of a scene, which must outlive it.
  explicit StartsInside(const Scene& scene);

  /// Returns true if the scene has bodies.
  bool any() const { return !bodies_.empty(); }
  /// Looks at the points of the next strand at t = 0 (3 numbers each, m).
  void look(In x);
  /// Returns a warning for each body in which strands begin.
  std::vector<std::string> warnings() const;

 private:
  struct InBody {
    std::string name;
    bool rigid;
    double radius;  // m, of strands on this body
    std::shared_ptr<const Effect> effect;
    std::size_t strands = 0, deepest = 0, point = 0;
    double depth = 0;  // m, of the deepest point of an axis
  };

  bool led_onto_supports(std::size_t strand, In x) const;

  const Scene& scene_;
  SceneSupports supports_;
  std::vector<InBody> bodies_;
  std::size_t first_point_;  // that is looked at
  std::size_t strands_ = 0;  // looked at
};

/// Prints the warnings.
void tell_starts_inside(const Scene& scene, const StartsInside& inside);

}  // namespace tress::experiments::scene_runs
