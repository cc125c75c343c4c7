#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "models/clothoid/clothoid.h"
#include "models/head/linear_elimination.h"
#include "models/head/reduced_kernel.h"
#include "models/strand/strain.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Elements whose Darboux vector is linear in arc length. The unknowns (1/m) are its mean
/// and half its difference between the ends: a Kind of models/head/reduced_kernel.h, with
/// the equations of models/clothoid/super_clothoid.h and the kinematics of
/// models/clothoid/clothoid.h. Its axes are those of its start. Halves of the rotors of
/// two elements turn with the tip between them. Points are those of the rule, which also
/// integrates the kinematics.
template <class T>
struct ClothoidKind {
 private:
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Material = ReducedMaterial<T>;
  using Motion = ReducedMotion<T>;
  using Wrench = WrenchOf<T>;
  using Hanging = ArticulatedInertia<T>;
  using Both = OfBoth<T>;

 public:
  using Real = T;                      // scalar: a pack of SIMD lanes
  using Unknowns = LinearStrainOf<T>;  // of an element
  using Loads = LinearLoadSums<T>;     // sums of loads of effects
  using Inertia = LinearInertia<T>;    // what carry() fills
  using Clothoid = ClothoidOf<T, 3>;   // shape of an element
  using Along = typename Clothoid::Along;
  using Rule = typename Clothoid::Rule;  // integrals between its points

  /// Geometry and motion of an element that the sweeps share.
  struct Kept {
    Vec v, omega, a, alpha;      // motion of its start
    Vec position;                // position of its tip
    Matrix rotation;             // E at the tip
    Both slope, turn;            // dP/dkappa_k, W e_k at the tip, as columns
    Vec turning;                 // W kappa' at the tip
    Clothoid shape;              // along the element
    Along moving, accelerating;  // P', P''
  };

  /// Stiffness of the first element over that of others.
  static constexpr double first_stiffness = 1;
  /// Shares of an element's rotor that turn with the root and with the last tip.
  static constexpr double rotors_of_root = 0.5, rotors_of_last = 0.5;
  /// Whether elements are straight, and whether eliminate() may lose digits.
  static constexpr bool straight = false, cancels = true;
  /// Returns unknowns in units of `length`, over those in m: `length`.
  static double unit(double length) { return length; }
  /// Returns the stiffness of a mean over the bending stiffness.
  static double moment(double length) { return length; }
  /// Returns the unknowns of element i. `shape`: natural or initial.
  static LinearStrain at_rest(const Strand& strand, std::size_t i,
                              tress::Vec Segment::*shape) {
    const Segment& own = strand.segments[i];
    return {own.*shape, shape == &Segment::natural ? own.natural_half : own.initial_half};
  }

  /// Replaces the motion of the start by that of the tip, and fills e. Reads
  /// `acceleration` only if accelerated.
  template <bool accelerated>
  static void move(const Rule& rule, const Material& m, const Unknowns& q,
                   const Unknowns& rate, const Unknowns& acceleration, Motion& at,
                   Kept& e) {
    e.v = at.v;
    e.omega = at.omega;
    e.a = at.a;
    e.alpha = at.alpha;
    std::construct_at(&e.shape, q, m.length, rule);
    e.position = e.shape.position().tip;
    const auto& tip = e.shape.rotation({});
    e.rotation = Matrix::columns(tip.e0, tip.e1, tip.e2);
    for (int f = 0; f < 2; ++f) {
      e.slope[at_function(f)] =
          columns(f, [&](int k) { return e.shape.slope_of(k).tip; });
      e.turn[at_function(f)] = columns(f, [&](int k) { return e.shape.turn_of(k).tip; });
    }
    e.moving = e.shape.first(rate);
    Vec spinning = e.shape.dW(rate, rate).value;
    if constexpr (accelerated) {
      e.accelerating = e.shape.acceleration(rate, acceleration);
      spinning = spinning + e.turn[0] * acceleration.mean + e.turn[1] * acceleration.half;
    } else {
      e.accelerating = e.shape.second(rate, rate);
    }
    e.turning = e.turn[0] * rate.mean + e.turn[1] * rate.half;
    const Vec arm = cross(at.omega, e.position), &moved = e.moving.tip;
    at.a = e.rotation.back(at.a + cross(at.alpha, e.position) + e.accelerating.tip +
                           cross(at.omega, arm + T(2) * moved));
    at.alpha = e.rotation.back(at.alpha + spinning + cross(at.omega, e.turning));
    at.v = e.rotation.back(at.v + arm + moved);
    at.omega = e.rotation.back(at.omega + e.turning);
  }

  /// Returns the wrench on the last tip, with which half a rotor turns.
  static Wrench last_wrench(const Material& m, const Motion& tip) {
    return {{}, rotor_moment(T(0.5) * m.rotor, tip.omega, tip.alpha)};
  }
  /// Returns the inertia on the last tip, with which half a rotor turns.
  static Hanging last(const Material& m, const T& acc) {
    Hanging end{};
    end.aa.xx += acc * (T(0.5) * m.rotor);
    return end;
  }
  /// Returns the inertia of the section's twist by its half difference, which turns
  /// neither end (reduced_strand()).
  static T section_inertia(const Material& m) {
    return T(1.0 / 30) * m.rotor * m.length * m.length;
  }

  /// Elastic and viscous moments, and the diagonal that they and the section's inertia
  /// add to S.
  struct Bending {
    Unknowns moment, tangent;  // moment on the unknowns, and diagonal in S
  };
  /// Returns the moments of an element. The half differences have a third of the means'
  /// stiffness and friction.
  static Bending bending(const Material& m, Weights w, const Unknowns& q,
                         const Unknowns& rest, const Unknowns& v) {
    const Unknowns strain = q - rest;
    const auto moment = [&](const Vec& x, const Vec& rate) {
      return times(m.stiffness, x) + m.friction * rate;
    };
    const T third(1.0 / 3), damping = T(w.vel) * m.friction;
    const Vec tangent = T(w.pos) * m.stiffness + Vec{damping, damping, damping};
    Bending all{{moment(strain.mean, v.mean), third * moment(strain.half, v.half)},
                {tangent, third * tangent}};
    all.tangent.half.x += T(w.acc) * section_inertia(m);
    return all;
  }
  /// Adds the elastic energy of the strain q, and the kinetic energy of the section's
  /// twist.
  static void add_energies(const Material& m, const Unknowns& q, const Unknowns& v,
                           T& elastic, T& kinetic) {
    elastic += T(0.5) * (weighed_square(m.stiffness, q.mean) +
                         T(1.0 / 3) * weighed_square(m.stiffness, q.half));
    kinetic += T(0.5) * section_inertia(m) * v.half.x * v.half.x;
  }

  using Sums = LinearSums<T>;  // sums over the points of an element
  /// Computes the sums over the points, without moments if accelerated. Reads
  /// `acceleration` only then.
  template <bool accelerated, class Kernel>
  static void add_up(const Kernel& kernel, const Material& m, const Unknowns& /*q*/,
                     const Unknowns& /*rate*/, const Unknowns& acceleration,
                     const Kept& e, Sums& sums) {
    sums = {};
    for (int k = 0; k < kernel.points(); ++k) {
      const T weight = kernel.rule().weight(k) * m.length;
      const Vec p = e.shape.position()[k];
      const Vec force = weight * inertial(m, e, k);
      const Both slope = slopes(e, k);
      sums.add_force(p, slope, force);
      if constexpr (!accelerated) sums.add_moments(weight, p, slope);
    }
    if constexpr (accelerated) {
      sums.unknown.half.x += section_inertia(m) * acceleration.half.x;
    }
  }
  /// Returns inertia and drag per length of point k.
  static Vec inertial(const Material& m, const Kept& e, int k) {
    const Vec p = e.shape.position()[k], u = e.moving[k], arm = cross(e.omega, p);
    return m.density * (e.a + cross(e.alpha, p) + e.accelerating[k] +
                        cross(e.omega, arm + T(2) * u)) +
           m.drag * (e.v + arm + u);
  }
  /// Returns d_k at point k, as columns of means and of halves.
  static Both slopes(const Kept& e, int k) {
    const auto of = [&](int f) {
      return columns(f, [&](int unknown) { return e.shape.slope_of(unknown)[k]; });
    };
    return {of(0), of(1)};
  }

  /// Moves the hanging wrench from the tip to the start and adds that of the element,
  /// inertia less loads. `unknown` receives the right side of the unknowns, `of_effects`
  /// is null without loads. One code with and without loads: the same bits for strands
  /// that have none.
  static void bear(const Unknowns& /*q*/, const Unknowns& /*rate*/, const Sums& sums,
                   const Loads* of_effects, const Kept& e, Wrench& wrench,
                   Unknowns& unknown) {
    unknown = {};
    lift(e, wrench, unknown);
    wrench.force = sums.force + wrench.force;
    wrench.moment = sums.moment + wrench.moment;
    unknown = unknown - sums.unknown;
    if (of_effects == nullptr) [[likely]] {
      return;
    }
    of_effects->add_to(wrench.force, Vec{} - of_effects->force);
    of_effects->add_to(wrench.moment, Vec{} - of_effects->moment);
    of_effects->add_to(unknown.mean, of_effects->unknown.mean);
    of_effects->add_to(unknown.half, of_effects->unknown.half);
  }
  /// Returns `unknown`, which bear() has completed.
  static const Unknowns& felt(const Kept& /*e*/, const Wrench& /*wrench*/,
                              const Unknowns& unknown) {
    return unknown;
  }
  /// Adds the moment of the rotor at the start.
  static void pass_wrench(const Material& m, const Kept& e, Wrench& wrench) {
    wrench.moment = wrench.moment + rotor_moment(m.rotor, e.omega, e.alpha);
  }
  /// Moves a wrench from the tip to the start and subtracts from b what the unknowns
  /// feel.
  static void lift(const Kept& e, Wrench& wrench, Unknowns& b) {
    const Vec force = e.rotation * wrench.force, moment = e.rotation * wrench.moment;
    b.mean = b.mean - e.slope[0].back(force) - e.turn[0].back(moment);
    b.half = b.half - e.slope[1].back(force) - e.turn[1].back(moment);
    wrench = {force, moment + cross(e.position, force)};
  }

  /// Moves the hanging inertia from the tip to the start and adds that of the element.
  static void carry(const Material& /*m*/, const ReducedInertia<T>& weights,
                    const Unknowns& /*q*/, const Unknowns& /*rate*/, const Sums& sums,
                    const Hanging& hanging, const Loads* of_effects, const Kept& e,
                    Inertia& to) {
    const T& inertia = weights.of_length;
    const HangingOnTip<T> on_tip(e.rotation, e.position, hanging);
    Hanging& all = to.sum;
    all.ll = on_tip.ll;
    all.la = on_tip.f_turn;
    all.aa = upper(on_tip.m_turn + cross_times(e.position, on_tip.f_turn));
    add_mass(inertia * sums.one, inertia * sums.first, inertia * sums.second, all);
    Both force, moment;
    for (std::size_t f = 0; f < 2; ++f) {
      force[f] = on_tip.force(e.slope[f], e.turn[f]);
      moment[f] = on_tip.moment(e.slope[f], e.turn[f]);
      to.of_force[f] = force[f].transposed() + inertia * sums.momentum[f];
      to.of_moment[f] = (moment[f] + cross_times(e.position, force[f])).transposed() +
                        inertia * sums.spin[f];
      to.own[f] = upper(e.slope[f].transposed(), force[f].transposed()) +
                  upper(e.turn[f].transposed(), moment[f].transposed()) +
                  inertia * sums.moments.inner[f];
    }
    to.mixed = e.slope[0].transposed() * force[1] + e.turn[0].transposed() * moment[1] +
               inertia * sums.moments.mixed;
    if (of_effects == nullptr) [[likely]] {
      return;
    }
    of_effects->add_to(all.ll, of_effects->ll);
    of_effects->add_to(all.la, of_effects->la);
    of_effects->add_to(all.aa, of_effects->aa);
    of_effects->add_to(to.mixed, of_effects->moments.mixed);
    for (std::size_t f = 0; f < 2; ++f) {
      of_effects->add_to(to.of_force[f], of_effects->of_force[f]);
      of_effects->add_to(to.of_moment[f], of_effects->of_moment[f]);
      of_effects->add_to(to.own[f], of_effects->moments.inner[f]);
    }
  }

  using Joint = LinearFactors<T>;  // factors of eliminate()
  /// Returns the articulated inertia without the unknowns, to whose diagonal in S it adds
  /// `tangent`.
  template <class Element>
  static Hanging eliminate(const Unknowns& tangent, bool twist, const Inertia& from,
                           Element& /*e*/, Joint& joint) {
    return joint.eliminate(tangent, twist, from);
  }
  /// Eliminates the unknowns from the wrench on the start. `b`: right side of the
  /// unknowns.
  template <class Element>
  static void reduce(const Unknowns& b, bool /*twist*/, Joint& joint, Element& /*e*/,
                     Wrench& wrench) {
    joint.reduce(b, wrench);
  }
  /// Returns the unknowns. Replaces the changes of linear and angular acceleration, l and
  /// a, of the start by those of the tip.
  template <class Element>
  static Unknowns follow(const Element& e, bool /*twist*/, const Joint& joint, Vec& l,
                         Vec& a) {
    const Unknowns own = joint.unknowns(l, a);
    const auto& tip = e.kept;
    l = tip.rotation.back(l + cross(a, tip.position) + tip.slope[0] * own.mean +
                          tip.slope[1] * own.half);
    a = tip.rotation.back(a + tip.turn[0] * own.mean + tip.turn[1] * own.half);
    return own;
  }
  /// Adds the inertia of the rotor at the start.
  static void pass(const Material& m, const T& acc, const Kept& /*e*/, Hanging& sum) {
    sum.aa.xx += acc * m.rotor;
  }

  /// Kinematics alone, seen from the start.
  class Shape {
   public:
    /// Integrates along the element.
    Shape(const Rule& rule, const Unknowns& q, const Unknowns& rate, const T& length)
        : curve_(q, length, rule),
          turning_(curve_.turn(rate)),
          moving_(curve_.moved(turning_)) {}

    /// Returns position and velocity of a point.
    SeenPoint<T> at(const PointPlace<T>& point) const {
      return {curve_.position()[point.number], moving_[point.number]};
    }
    /// Returns position, velocity and turn of the tip.
    [[gnu::always_inline]] SeenTip<T> tip() const {
      const auto& f = curve_.rotation({});
      return {curve_.position().tip, moving_.tip, Matrix::columns(f.e0, f.e1, f.e2),
              turning_.tip};
    }

   private:
    ClothoidCurveOf<T> curve_;
    typename ClothoidCurveOf<T>::Along turning_, moving_;
  };

  /// Does nothing: the frame of the start is that of the tip before.
  static void enter(const Kept& /*e*/, FrameOf<T>& /*frame*/) {}
  /// Replaces the frame of the start by that of the tip.
  static void go_on(const Kept& e, FrameOf<T>& frame) {
    frame = frame *
            FrameOf<T>{e.rotation.column(0), e.rotation.column(1), e.rotation.column(2)};
  }

  /// Points on which effects act, in the element's axes.
  class Points {
   public:
    /// Takes an element whose state e must outlive the points.
    Points(const Kept& e, const Unknowns& /*q*/, const Unknowns& /*rate*/,
           const T& /*length*/)
        : e_(e) {}

    /// Returns the position of a point.
    Vec position(const PointPlace<T>& at) const { return e_.shape.position()[at.number]; }
    /// Returns the velocity of a point, which is at `position`.
    Vec velocity(const PointPlace<T>& at, const Vec& position) const {
      return e_.v + cross(e_.omega, position) + e_.moving[at.number];
    }
    /// Returns the tangent at a point.
    Vec tangent(const PointPlace<T>& at) const { return e_.shape.tangent(at.number); }
    /// Adds a force on a point.
    void add_force(const PointPlace<T>& at, const Vec& position, const Vec& force,
                   Loads& sums) const {
      sums.add_force(position, force);
      sums.add_force_of_unknowns(slopes(e_, at.number), force);
    }
    /// Adds the derivatives B of the load on a point (PointLoad).
    void add_block(const PointPlace<T>& at, const Vec& position,
                   const Symmetric3<T>& block, Loads& sums) const {
      sums.add_block(position, block);
      sums.add_block_of_unknowns(position, slopes(e_, at.number), block);
    }

   private:
    const Kept& e_;
  };

  /// Returns the matrix whose columns are those of the three unknowns of function f.
  template <class Of>
  static Matrix columns(int f, Of of) {
    return Matrix::columns(of(3 * f), of(3 * f + 1), of(3 * f + 2));
  }

 private:
  static constexpr std::size_t at_function(int f) { return static_cast<std::size_t>(f); }
  static Vec times(const Vec& a, const Vec& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
  }
};

}  // namespace tress::models
