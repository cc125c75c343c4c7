#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/run/world.h"

namespace tress::experiments::hard_cases {

/// Bounds on a run of a scene besides those of the simulation guard (Guard).
struct SceneCriteria {
  double stretch = 0.5;    // of a piece, over its length; the guard's own bound
  double depth = 0;        // m, in a body, beyond that at the start; 0: allowed_depth()
  double energy_gain = 0;  // J, kinetic, elastic and of effects; 0: the guard's bound
};

/// Watches a scene at every step; scene and world must outlive it.
class SceneGauge {
 public:
  struct Criterion {
    std::string_view name;
    std::string_view words;
    double limit;
    std::function<double()> read;
    std::function<std::string()> where;  // "strand 0, point 3"
    double largest = 0;
  };

  /// Starts from the present state of the world.
  SceneGauge(const Scene& scene, World& world, const SceneCriteria& criteria);

  /// After a step: the violated criterion, null if all hold.
  const Criterion* broken();
  /// The criterion nearest to its limit.
  const Criterion& nearest() const;

 private:
  double energy() const;
  double depth();
  std::string stretched_place() const;
  std::string place(std::size_t point, std::string_view what) const;

  const Scene& scene_;
  World& world_;
  Effects bodies_;
  std::size_t deepest_ = 0;  // point
  std::vector<Criterion> criteria_;
};

}  // namespace tress::experiments::hard_cases
