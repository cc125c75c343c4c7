#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "math/instructions.h"
#include "models/head/head_units.h"
#include "models/head/near_bodies.h"
#include "models/head/point_loads.h"
#include "models/head/semidefinite.h"

namespace tress::models {

/// Load of effects on the node at an edge's end: PointLoad or ExactLoad.
template <class T, template <class> class Load>
struct NodeLoad {
  Load<T> load;  // load on the node
  T some;        // 1 in lanes with a load, 0 in others
};

/// Loads of bodies on the nodes of strands of edges, side by side; a node only if it is
/// near in some lane. PointLoads are those of one step, ExactLoads those of a state.
template <class T, template <class> class Load>
class NodeLoads {
 public:
  /// Vector of these scalars.
  using Vec3T = Vec3<T>;
  /// Load on one node.
  using OfNode = NodeLoad<T, Load>;

  /// Allocates for a number of edges.
  explicit NodeLoads(std::size_t edges) : loads_(edges), x_(edges), v_(edges) {}

  /// Computes the loads on the ends of edges; null: none. PointLoads are for the motion
  /// at the end of the step of h (s). `root` (from the head's position), `length` of an
  /// edge, `drag` on the velocity, q and v are in the batch's units; q and v have
  /// `of_edge` numbers per edge.
  TRESS_FLATTEN const OfNode* find(std::span<const NearBody> bodies,
                                   const HeadUnits& units, double h, Vec3T root,
                                   const T& length, const T& drag, const T* q, const T* v,
                                   std::size_t of_edge) {
    if (bodies.empty()) return nullptr;
    Vec3T rate{};
    for (std::size_t i = 0; i < x_.size(); ++i) {
      root = root + load3(q + of_edge * i);
      rate = rate + load3(v + of_edge * i);
      x_[i] = T(units.length) * root;
      v_[i] = T(units.speed()) * rate;
      loads_[i] = {{}, T(0)};
    }
    for (const NearBody& body : bodies) {
      std::visit([&](const auto& shape) { touch(body, shape, units, h, length); },
                 body.contact->body.shape());
    }
    bool loaded = false;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (!any_less(T(0), loads_[i].some)) continue;
      loaded = true;
      if constexpr (symmetric) {
        // Of all effects together, linear drag among them, as ReducedLoads.
        const T own = T(h / units.time) * part(i) * drag;
        Symmetric3<T>& block = loads_[i].load.block;
        shift(block, own);
        block = semidefinite(block, loads_[i].some);
        shift(block, -own);
      }
    }
    return loaded ? loads_.data() : nullptr;
  }

 private:
  static constexpr bool symmetric = std::is_same_v<Load<T>, PointLoad<T>>;

  /// Returns the share of an edge's length at the node at its end.
  T part(std::size_t i) const { return T(i + 1 < x_.size() ? 1 : 0.5); }

  template <class Shape>
  TRESS_FLATTEN void touch(const NearBody& body, const Shape& shape,
                           const HeadUnits& units, double h, const T& length) {
    const T o(0), one(1);
    const BodyTouch<T, Shape> of_body(body, shape,
                                      {{one, o, o}, {o, one, o}, {o, o, one}}, h);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const T w = part(i) * length, to_force = w * T(units.length / units.force());
      const Vec3T at = of_body.in_body(x_[i]);
      const auto velocity = [&] { return v_[i]; };
      if constexpr (symmetric) {
        of_body.touch(at, velocity, to_force, w * T(1 / units.density), loads_[i].load,
                      loads_[i].some);
      } else {
        of_body.touch(at, velocity, to_force, units, loads_[i].load, loads_[i].some);
      }
    }
  }
  static void shift(Symmetric3<T>& block, const T& by) {
    block.xx += by;
    block.yy += by;
    block.zz += by;
  }

  std::vector<OfNode> loads_;
  std::vector<Vec3T> x_, v_;  // m, m/s, from the head's position
};

}  // namespace tress::models
