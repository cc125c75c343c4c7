#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

#include "contract/basics.h"
#include "math/instructions.h"
#include "math/lane_choice.h"
#include "models/head/head.h"
#include "models/head/head_units.h"
#include "models/head/lane_root.h"
#include "models/head/near_bodies.h"
#include "models/maximal/nodal_strand.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Writes the tensions of `n` edges at q, of `per_element` numbers each, in lanes with
/// `which` > 0. Material: their stretch (force per lengthening) and length at rest.
template <int per_element, class Material, class T>
void take_tensions(const Material& m, std::size_t n, const T* q, const T& which,
                   T* tensions) {
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3<T> edge = load3(q + per_element * i);
    const T square = dot(edge, edge);
    tensions[i] = where_less(
        T(0), which, m.stretch * (square * inverse_sqrt(square) - m.length), tensions[i]);
  }
}

/// Common code of LaneModels (models/head/lane_model.h) whose strands are chains of
/// edges. Edges are numbered from the root. An edge has `per_element` numbers: the vector
/// along it (3) in axes of the world, then numbers without unit. The rate of the first
/// edge is that of its end. Flat as ReducedLoads.
template <class Pack, int per_element>
class EdgeModel {
 public:
  /// Scalar: a number, or a pack of SIMD lanes.
  using Real = Pack;
  /// Vector of these scalars.
  using V = Vec3<Real>;
  /// Frame and motion of the root.
  using Clamp = LaneClamp<Real>;
  static constexpr bool straight = true;         // whether elements are straight
  static constexpr bool takes_bodies = true;     // whether bodies may touch them
  static constexpr double most_stretched = 1.5;  // runs end where an edge is longer
  static constexpr double newton_part = 1e-2;    // as Block::newton_part()
  /// Remedy of errors.
  static constexpr const char* use_others =
      "use super_helix, or run the strands one by one";

  /// Reads the options common to all such models. `units`, which are whole with the first
  /// strand, must outlive this.
  EdgeModel(const LaneOptions& options, const HeadUnits& units)
      : units_(units),
        n_(static_cast<std::size_t>(options.elements)),
        drag_(options.drag),
        mass_damping_(options.mass_damping) {}

  /// A strand's root and the numbers of an edge that its Material has in any model: its
  /// length, mass, drag on velocities, stiffness E A/l against stretch, and typical rate.
  template <class Strand>
  void describe_edges(const models::Strand& strand, const Vec& centre,
                      const HeadUnits& units, int lane, Strand& to) const {
    const Segment& first = strand.segments.front();
    const double l = units.length, tau = units.time, unit_mass = units.mass();
    const double density = strand.material.density * first.section.area();
    set_lane(to.root.from, lane, (1 / l) * (strand.root.position - centre));
    set_lane(to.root.frame, lane, strand.root.frame);
    set_lane(to.material.length, lane, first.length / l);
    set_lane(to.material.mass, lane, density * first.length / unit_mass);
    set_lane(to.material.drag, lane,
             (drag_ + mass_damping_ * density) * first.length * tau / unit_mass);
    set_lane(to.material.stretch, lane,
             strand.material.youngs_modulus * first.section.area() / first.length * tau *
                 tau / unit_mass);
    set_lane(to.material.rate, lane, typical_rate(strand) * tau);
  }
  /// Returns the mass of a strand, in units of the batch.
  template <class Strand>
  double mass(const Strand& strand, int lane) const {
    return static_cast<double>(n_) * lane_of(strand.material.mass, lane);
  }

  /// Returns the length of a strand.
  template <class Strand>
  Real length(const Strand& strand) const {
    return Real(static_cast<double>(n_)) * strand.material.length;
  }
  /// Returns the length of an edge.
  template <class Strand>
  Real element_length(const Strand& strand) const {
    return strand.material.length;
  }
  /// Returns the number of edges.
  std::size_t elements() const { return n_; }
  /// Returns the number of unknowns.
  std::size_t unknowns() const { return per_element * n_; }
  /// Returns the unit of unknown k, m or 1.
  double unit(const HeadUnits& units, std::size_t k) const {
    return k % per_element < 3 ? units.length : 1;
  }

  /// Returns the size of dq: displacements of nodes over edges, and all other entries as
  /// in the System of a single strand.
  template <class Strand>
  Real coordinate_size(const Strand& strand, const Real* dq) const {
    V node{};
    Real far(0), turned(0);
    for (std::size_t i = 0; i < n_; ++i) {
      node = node + load3(dq + per_element * i);
      far = larger(larger(far, magnitude(node.x)),
                   larger(magnitude(node.y), magnitude(node.z)));
      for (std::size_t k = 3; k < per_element; ++k) {
        turned = larger(turned, magnitude(dq[per_element * i + k]));
      }
    }
    return larger(far / strand.material.length, turned);
  }
  /// Places are known to a rounding of the longest strand, sizes are over edges.
  template <class Strand>
  double resolved(const Strand& strand, Weights w, int lane) const {
    constexpr double eps = std::numeric_limits<typename Real::Scalar>::epsilon();
    return eps / lane_of(strand.material.length, lane) *
           std::max(1.0, w.vel / (w.pos * lane_of(strand.material.rate, lane)));
  }

  /// Returns frame and motion of the root for a motion of the head.
  template <class Strand>
  TRESS_FLATTEN Clamp clamp(const Strand& strand, const RootPose& pose) const {
    const V from = frame_of(pose.frame) * strand.root.from, omega(pose.omega);
    return {frame_of(pose.frame) * strand.root.frame, V(pose.v) + cross(omega, from),
            omega};
  }
  /// The first edge starts at the root, wherever that has gone.
  template <class Strand>
  TRESS_FLATTEN void predict(const Strand& strand, const RootPose& from,
                             const RootPose& to, double h, const Real* q, const Real* v,
                             Real* q_bar) const {
    for (std::size_t k = 0; k < unknowns(); ++k) q_bar[k] = q[k] + Real(h) * v[k];
    const Frame turned{to.frame.e0 - from.frame.e0, to.frame.e1 - from.frame.e1,
                       to.frame.e2 - from.frame.e2};
    const V moved = V(to.x - from.x) + frame_of(turned) * strand.root.from;
    store3(load3(q_bar) - moved, q_bar);
  }
  /// Calls use(i, velocity) for root and ends of edges.
  template <class Strand, class Use>
  TRESS_FLATTEN void velocities(const Strand& strand, const RootPose& pose,
                                const Real* /*q*/, const Real* v, Use use) const {
    use(0, clamp(strand, pose).v);
    V at{};  // the first rate is that of a place, not of an edge
    for (std::size_t i = 0; i < n_; ++i) {
      at = at + load3(v + per_element * i);
      use(i + 1, at);
    }
  }
  /// Calls use(i, position) for root and ends of edges.
  template <class Strand, class Use>
  TRESS_FLATTEN void positions(const Strand& strand, const Frame& head, const Real* q,
                               Use use) const {
    V at = root_at(strand, head);
    use(0, at);
    for (std::size_t i = 0; i < n_; ++i) {
      at = at + load3(q + per_element * i);
      use(i + 1, at);
    }
  }

  /// Begins the loads of a stage, the `loads` (EdgeLoads) of a model's Scratch.
  template <class Strand, class Scratch>
  void find_loads(const Strand& strand, std::span<const NearBody> bodies,
                  const RootPose& pose, const HeadUnits& /*units*/, double h,
                  const Real* q, const Real* v, Scratch& scratch) const {
    scratch.loads.meet(bodies, units_, h, root_at(strand, pose.frame), strand.material, q,
                       v, per_element);
  }
  /// Returns those at a state of the stage; null: none.
  template <class Strand, class Scratch>
  const auto* loads_at(const Strand& strand, const Real* q, const Real* v,
                       Scratch& scratch) const {
    return scratch.loads.at(units_, strand.material, q, v, per_element);
  }

  /// The root, seen from the head's position.
  template <class Strand>
  static V root_at(const Strand& strand, const Frame& head) {
    return frame_of(head) * strand.root.from;
  }

 private:
  static FrameOf<Real> frame_of(const Frame& f) { return {f.e0, f.e1, f.e2}; }

  const HeadUnits& units_;
  std::size_t n_;
  double drag_, mass_damping_;  // kg/(m s), 1/s
};

}  // namespace tress::models
