#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "models/head/exact/exact_kernel.h"
#include "models/head/head_motion.h"
#include "models/head/reduced_energies.h"
#include "models/head/reduced_kernel.h"
#include "models/head/reduced_loads.h"
#include "models/head/reduced_material.h"
#include "models/motion/root_motion.h"
#include "models/reduced/reduced_strand.h"

namespace tress::models {

/// ReducedKernel with its exact Jacobian as a LaneModel.
template <class Kind>
class ReducedModel {
  using V = Vec3<typename Kind::Real>;
  using Kernel = ReducedKernel<Kind>;
  using Unknowns = typename Kind::Unknowns;
  static constexpr std::size_t per_element = 3 * sizeof(Unknowns) / sizeof(V);

 public:
  using Real = typename Kind::Real;  // scalar: a number, or a pack of SIMD lanes
  /// Whether the Jacobian is exact and again() exists; whether find_loads() exists.
  static constexpr bool iterates = true, takes_bodies = true;
  static constexpr bool takes_stresses = false;     // take_stresses() does not exist
  static constexpr bool straight = Kind::straight;  // whether elements are straight
  static constexpr double most_stretched = 1;  // largest length of a strand over length()
  /// Tolerance of Newton's method over that of a step's error.
  static constexpr double newton_part = 0.03;
  /// Remedy in error messages on effects that the model does not take.
  static constexpr const char* use_others =
      "use a method of one linear solve, or run the strands one by one";

  /// Data of a strand that steps do not change.
  struct Strand {
    LaneRoot<Real> root;             // position and frame in the head
    ReducedMaterial<Real> material;  // properties of the elements
    Real by_scale, time;             // 1 over a typical unknown, 1 over a typical rate
  };
  /// Rest shape of an element alone: an array of these is read as an array of unknowns.
  struct Element {
    Unknowns rest;                          // unknowns at rest
    static constexpr std::size_t kept = 0;  // count of numbers that steps change
    /// Writes the numbers of a lane that steps change: none.
    void keep(int /*lane*/, double* /*to*/) const {}
    /// Restores what keep() wrote: nothing.
    void recall(int /*lane*/, const double* /*from*/) {}
  };
  using Clamp = ReducedMotion<Real>;  // motion of the root, in its own components
  /// Working memory of one thread.
  struct Scratch {
    /// Allocates for a block of `model`, which must outlive it.
    explicit Scratch(const ReducedModel& model)
        : elements(model.elements()),
          factors(model.elements()),
          loads(model.kernel_, model.units_) {}
    std::vector<typename Kernel::Scratch> elements;  // state of the elements
    /// Factors of the exact Jacobian (elements).
    std::vector<typename ExactKernel<Kind>::Factors> factors;
    ReducedLoads<Kind> loads;  // loads of bodies
    // Set by find_loads().
    std::span<const NearBody> bodies;  // bodies that may touch the strands
    V from;                            // positions of the roots from that of the head, m
    FrameOf<Real> frame;               // frames of the roots in the world
    double h = 0;                      // length of the step, s
  };

  /// `units`, which are whole with the first strand, must outlive it.
  ReducedModel(const LaneOptions& options, const HeadUnits& units)
      : options_(options),
        units_(units),
        n_(static_cast<std::size_t>(options.elements)),
        gravity_((units.time * units.time / units.length) * options.gravity),
        kernel_(options.elements, options.points, options.twist),
        exact_(kernel_),
        energies_(kernel_) {}

  /// Returns the number of elements of a strand.
  std::size_t elements() const { return n_; }
  /// Returns the number of unknowns of a strand.
  std::size_t unknowns() const { return per_element * n_; }
  /// Returns the unit of an unknown in SI: 1 over the unit of length, or 1 (rad).
  double unit(const HeadUnits& units, std::size_t /*k*/) const {
    return 1 / Kind::unit(units.length);
  }
  /// Returns the mass of the strand in a lane, in units of the batch.
  double mass(const Strand& strand, int lane) const {
    return static_cast<double>(n_) *
           lane_of(strand.material.density * strand.material.length, lane);
  }
  /// Returns the length of each strand, in units of the batch.
  Real length(const Strand& strand) const {
    return Real(static_cast<double>(n_)) * strand.material.length;
  }
  /// Returns the length of an element of each strand, in units of the batch.
  Real element_length(const Strand& strand) const { return strand.material.length; }
  /// Returns the positions of the roots from that of the head, in axes of the world.
  static V root_at(const Strand& strand, const Frame& head) {
    return frame_of(head) * strand.root.from;
  }

  /// Writes a strand, its elements and the initial state of ReducedHead to one lane.
  /// `centre`: position of the head.
  void describe(const models::Strand& strand, const Vec& centre, const HeadUnits& units,
                int lane, Strand& to, Element* elements, Real* q, Real* v) const {
    set_lane(to.root.from, lane, (1 / units.length) * (strand.root.position - centre));
    set_lane(to.root.frame, lane, strand.root.frame);
    set_material<Kind>(strand, options_, units, lane, to.material);
    const double scale = Kind::unit(units.length) * reduced_scale(strand, Kind::straight);
    set_lane(to.by_scale, lane, 1 / scale);
    set_lane(to.time, lane, 1 / (reduced_rate(strand) * units.time));
    for (std::size_t i = 0; i < n_; ++i) {
      const auto start = start_of<Kind>(strand, options_, units, i);
      set_lane(elements[i].rest, lane, start.rest);
      set_lane(by_element(q)[i], lane, start.initial);
      set_lane(by_element(v)[i], lane, decltype(start.rest){});
    }
  }

  /// Returns the motion of the root for a motion of the head.
  Clamp clamp(const Strand& strand, const RootPose& pose) const {
    const auto in_head = [&](const Vec& x) { return pose.frame.back(x); };
    return root_motion<Real>(
        strand.root, {in_head(pose.v), in_head(pose.omega), in_head(pose.a - gravity_),
                      in_head(pose.alpha)});
  }
  /// Returns 0 and changes nothing: the model has no reference frames.
  Real renew(Element* /*elements*/, const Clamp& /*clamp*/, Real* /*q*/,
             Real* /*v*/) const {
    return Real(0);
  }
  /// Writes q + h v to q_bar.
  void predict(const Strand& /*strand*/, const RootPose& /*from*/, const RootPose& /*to*/,
               double h, const Real* q, const Real* v, Real* q_bar) const {
    for (std::size_t k = 0; k < unknowns(); ++k) q_bar[k] = q[k] + Real(h) * v[k];
  }

  /// Notes the bodies; newton() and again() find the loads at their states.
  void find_loads(const Strand& strand, std::span<const NearBody> bodies,
                  const RootPose& pose, const HeadUnits& units, double h,
                  const Real* /*q*/, const Real* /*v*/, Scratch& scratch) const {
    scratch.bodies = bodies;
    scratch.from = Real(units.length) * root_at(strand, pose.frame);
    scratch.frame = frame_of(pose.frame) * strand.root.frame;
    scratch.h = h;
  }

  /// Computes Newton's correction. Returns its size over a typical unknown, NaN in lanes
  /// where it is not finite.
  Real newton(const Strand& strand, const Element* elements, const Clamp& clamp,
              Weights w, const Real* q, const Real* v, const Real* a, Real* correction,
              Scratch& scratch) const {
    const auto end = move(strand, clamp, q, v, a, scratch);
    const ExactPoint<Real>* const* loads = nullptr;
    if (!scratch.bodies.empty()) {
      loads = scratch.loads.find_exact(block_of(strand, scratch), by_element(v),
                                       scratch.elements.data());
    }
    return size(
        strand, w,
        exact_.newton(strand.material, end, loads, &elements->rest, w, by_element(q),
                      by_element(v), by_element(a), by_element(correction),
                      scratch.elements.data(), scratch.factors.data()));
  }
  /// Computes a correction with the matrix of the last newton(); returns as newton().
  Real again(const Strand& strand, const Element* elements, const Clamp& clamp, Weights w,
             const Real* q, const Real* v, const Real* a, Real* correction,
             Scratch& scratch) const {
    const auto end = move(strand, clamp, q, v, a, scratch);
    const typename Kind::Loads* const* loads = nullptr;
    if (!scratch.bodies.empty()) {
      loads = scratch.loads.find(block_of(strand, scratch), by_element(v),
                                 scratch.elements.data());
    }
    return size(strand, w,
                exact_.again(strand.material, end, loads, &elements->rest, by_element(v),
                             by_element(a), by_element(correction),
                             scratch.elements.data(), scratch.factors.data()));
  }
  /// Returns the largest entry of dq in each lane over a typical unknown.
  Real coordinate_size(const Strand& strand, const Real* dq) const {
    Real most(0);
    for (std::size_t k = 0; k < unknowns(); ++k) most = larger(most, magnitude(dq[k]));
    return strand.by_scale * most;
  }
  /// Returns the size below which a correction of newton() is a rounding error.
  double resolved(const Strand& strand, Weights w, int lane) const {
    constexpr double eps = std::numeric_limits<typename Real::Scalar>::epsilon();
    return eps * std::max(1.0, w.vel / w.pos * lane_of(strand.time, lane));
  }

  /// Calls use(i, position) for root (i = 0) and tips, seen from the position of the
  /// head.
  template <class Use>
  void positions(const Strand& strand, const Frame& head, const Real* q, Use use) const {
    run_along(strand, head, {}, q, q,
              [&](std::size_t i, const V& at, const V& /*u*/) { use(i, at); });
  }
  /// Calls use(i, velocity) for root (i = 0) and tips, in axes of the world.
  template <class Use>
  void velocities(const Strand& strand, const RootPose& pose, const Real* q,
                  const Real* v, Use use) const {
    run_along(strand, pose.frame, clamp(strand, pose), q, v,
              [&](std::size_t i, const V& /*at*/, const V& u) { use(i, u); });
  }
  /// Returns the energies of the strands at (q, v), in units of the batch.
  TRESS_FLATTEN LaneEnergies<Real> energies(const Strand& strand, const Element* elements,
                                            const RootPose& pose, const Real* q,
                                            const Real* v) const {
    return energies_(
        strand.material, clamp(strand, pose), root_at(strand, pose.frame),
        frame_of(pose.frame) * strand.root.frame, [&](int i) { return elements[i].rest; },
        by_element(q), by_element(v));
  }

 private:
  static FrameOf<Real> frame_of(const Frame& f) { return {f.e0, f.e1, f.e2}; }
  // Vec3 is three of them, LinearStrainOf two of these.
  static const Unknowns* by_element(const Real* x) {
    return reinterpret_cast<const Unknowns*>(x);
  }
  static Unknowns* by_element(Real* x) { return reinterpret_cast<Unknowns*>(x); }

  ReducedMotion<Real> move(const Strand& strand, const Clamp& clamp, const Real* q,
                           const Real* v, const Real* a, Scratch& scratch) const {
    return exact_.move(strand.material, clamp, by_element(q), by_element(v),
                       by_element(a), scratch.elements.data(), scratch.factors.data());
  }
  static typename ReducedLoads<Kind>::Block block_of(const Strand& strand,
                                                     const Scratch& scratch) {
    return {&strand.material, scratch.from, scratch.frame,  0,
            scratch.h,        Vec{},        scratch.bodies, {}};
  }
  static Real size(const Strand& strand, Weights w, const Real& most) {
    return larger(Real(w.pos), Real(w.vel) * strand.time) * strand.by_scale * most;
  }

  template <class Use>
  TRESS_FLATTEN void run_along(const Strand& strand, const Frame& head, const Clamp& root,
                               const Real* q, const Real* v, Use use) const {
    FrameOf<Real> frame = frame_of(head) * strand.root.frame;
    V at = root_at(strand, head), velocity = root.v, omega = root.omega;
    use(0, at, frame * velocity);
    for (std::size_t i = 0; i < n_; ++i) {
      const SeenTip<Real> tip =
          typename Kind::Shape(kernel_.rule(), by_element(q)[i], by_element(v)[i],
                               strand.material.length)
              .tip();
      at = at + frame * tip.position;
      frame = frame * FrameOf<Real>{tip.rotation.column(0), tip.rotation.column(1),
                                    tip.rotation.column(2)};
      velocity = tip.rotation.back(velocity + cross(omega, tip.position) + tip.velocity);
      omega = tip.rotation.back(omega + tip.turning);
      use(i + 1, at, frame * velocity);
    }
  }

  LaneOptions options_;
  const HeadUnits& units_;
  std::size_t n_;
  Vec gravity_;
  Kernel kernel_;
  ExactKernel<Kind> exact_;
  ReducedEnergies<Kind> energies_;
};

}  // namespace tress::models
