#pragma once

#include <span>
#include <type_traits>

#include "math/instructions.h"
#include "models/head/head_units.h"
#include "models/head/maximal/node_loads.h"

namespace tress::models {

/// Loads of bodies on the ends of a strand's edges in a stage. `exact`: ExactLoads of
/// each state; else PointLoads of the first state, for the whole step.
template <class T, bool exact>
class EdgeLoads {
 public:
  /// Load on the node at an edge's end.
  using Load = std::conditional_t<exact, NodeLoad<T, ExactLoad>, NodeLoad<T, PointLoad>>;

  /// Allocates for a number of edges.
  explicit EdgeLoads(std::size_t edges) : loads_(edges) {}

  /// Begins a stage at (q, v) with the bodies that may touch the strands, which outlive
  /// it. Arguments as NodeLoads::find; `m`: the Material of the edges.
  template <class Material>
  void meet(std::span<const NearBody> bodies, const HeadUnits& units, double h,
            const Vec3<T>& root, const Material& m, const T* q, const T* v,
            std::size_t of_edge) {
    bodies_ = bodies;
    root_ = root;
    if constexpr (!exact) found_ = find(units, h, m, q, v, of_edge);
  }
  /// Returns the loads at a state of the stage; null: none.
  template <class Material>
  const Load* at(const HeadUnits& units, const Material& m, const T* q, const T* v,
                 std::size_t of_edge) {
    if constexpr (!exact) return found_;
    return find(units, 0, m, q, v, of_edge);
  }

 private:
  template <class Material>
  const Load* find(const HeadUnits& units, double h, const Material& m, const T* q,
                   const T* v, std::size_t of_edge) {
    const Load* loads = nullptr;
    by_registers_of<T>([&] {
      loads = loads_.find(bodies_, units, h, root_, m.length, m.drag, q, v, of_edge);
    });
    return loads;
  }

  std::conditional_t<exact, NodeLoads<T, ExactLoad>, NodeLoads<T, PointLoad>> loads_;
  std::span<const NearBody> bodies_;
  Vec3<T> root_;  // from the head's position
  const Load* found_ = nullptr;
};

}  // namespace tress::models
