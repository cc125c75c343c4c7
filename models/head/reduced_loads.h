#pragma once

#include <span>
#include <vector>

#include "math/instructions.h"
#include "models/head/head_units.h"
#include "models/head/near_bodies.h"
#include "models/head/reduced_kernel.h"

namespace tress::models {

/// Loads of effects on the points of a block of strands in one step, found between the
/// sweeps of ReducedKernel. Bodies act on all strands at once, on the points of elements
/// whose ball comes near enough. Other effects act strand by strand, as in ReducedSystem.
/// Elements without loads cost nothing. Compiled without fused products, whose choice
/// depends on the number of lanes: results are bit-identical.
template <class Kind>
class ReducedLoads {
  using T = typename Kind::Real;
  using Vec3T = Vec3<T>;
  using Kernel = ReducedKernel<Kind>;
  using Element = typename Kernel::Scratch;
  using Unknowns = typename Kind::Unknowns;
  using Loads = typename Kind::Loads;

 public:
  /// Allocates for the elements of a kernel, which must outlive it.
  ReducedLoads(const Kernel& kernel, const HeadUnits& units)
      : kernel_(kernel),
        units_(units),
        n_(static_cast<std::size_t>(kernel.elements())),
        points_(static_cast<std::size_t>(kernel.points())),
        starts_(n_),
        at_(points_),
        exact_at_(n_ * points_),
        sums_(n_),
        loads_(n_),
        exact_(n_) {}

  /// A block in one step: bodies that may touch it, and of each
  /// strand the other effects. `from`, `frame`: of the roots, seen from the head's
  /// position along the axes of the world, m.
  struct Block {
    const ReducedMaterial<T>* material;  // properties of the elements
    Vec3T from;                          // positions of the roots
    FrameOf<T> frame;                    // frames of the roots
    double t, h;                         // end and length of the step, s
    Vec head;                            // position of the head, m
    std::span<const NearBody> bodies;    // bodies that may touch the block
    std::span<const std::vector<const Effect*>> others;  // (strands), or empty
  };
  /// Finds the loads of each element, or null, from the motion at the step's end.
  const Loads* const* find(const Block& block, const Unknowns* v,
                           const Element* elements);
  /// Finds the loads of bodies point by point, with all derivatives.
  const ExactPoint<T>* const* find_exact(const Block& block, const Unknowns* v,
                                         const Element* elements);

 private:
  struct Start {
    Vec3T x;           // m, from the head's position
    FrameOf<T> frame;  // of the element's axes
    Vec3T chord;       // to the tip
  };
  using Point = LoadedPoint<T, PointLoad<T>>;

  using OnElement = typename Kind::Points;

  void look_around(const Block& block, const Element* elements);
  void place(const Element* elements);
  bool element(std::size_t i, const Unknowns& rate, const Element& e, bool others);
  const ExactPoint<T>* exact(std::size_t i, const Unknowns& rate, const Element& e);
  bool add_up(std::size_t i, const OnElement& points);
  void look_for(const NearBody& body, std::span<char> near) const;
  template <class Shape, class Load>
  void touch(const NearBody& body, const Shape& shape, std::size_t i,
             const OnElement& points, LoadedPoint<T, Load>* at) const;
  void take_others(const Unknowns* v, const Element* elements);
  void take_others(int lane);
  void put(std::size_t i, int lane);

  PointPlace<T> place_of(std::size_t k) const {
    return kernel_.place(static_cast<int>(k), block_.material->length);
  }
  T weight_of(std::size_t k) const {
    return T(kernel_.weight(static_cast<int>(k))) * block_.material->length;
  }

  const Kernel& kernel_;
  HeadUnits units_;
  std::size_t n_, points_;
  Block block_{};
  std::vector<Start> starts_;
  std::vector<char> near_;  // (bodies, elements) whether one may touch the other
  std::vector<Point> at_;   // of an element
  std::vector<ExactPoint<T>> exact_at_;
  std::vector<Loads> sums_;
  std::vector<const Loads*> loads_;
  std::vector<const ExactPoint<T>*> exact_;
  // Of effects other than bodies, by points.
  std::vector<PointLoad<T>> others_;
  std::vector<T> some_;
  std::vector<Vec3T> x_, v_, tangent_;
  std::vector<double> of_x_, of_v_, of_tangent_, mass_, length_, arc_, load_, blocks_;
};

}  // namespace tress::models
