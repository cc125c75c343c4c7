#pragma once

#include <algorithm>
#include <concepts>
#include <utility>

#include "models/head/helix_sums.h"
#include "models/head/lane_numbers.h"
#include "models/head/reduced_kernel.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Elements of constant Darboux vector, the unknowns (1/m): a Kind of
/// models/head/reduced_kernel.h, with the equations of models/reduced/super_helix.h. Its
/// axes are those of its start. Halves of the rotors of two elements turn with the tip
/// between them.
template <class T>
struct HelixKind {
 private:
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Material = ReducedMaterial<T>;
  using Motion = ReducedMotion<T>;
  using Wrench = WrenchOf<T>;
  using Hanging = ArticulatedInertia<T>;

 public:
  using Real = T;        // scalar: a number, or a pack of SIMD lanes
  using Unknowns = Vec;  // of an element
  using Rule = NoRule;   // points need no numbers of their own

  /// Geometry and motion of an element that the sweeps share.
  struct Kept {
    Vec v, omega, a, alpha;        // motion of its start
    Vec position;                  // position of its tip
    Matrix slope, turn, rotation;  // dP/dkappa, W, E at the tip
  };

  /// Stiffness of the first element over that of others.
  static constexpr double first_stiffness = 1;
  /// Shares of an element's rotor that turn with the root and with the last tip.
  static constexpr double rotors_of_root = 0.5, rotors_of_last = 0.5;
  /// Whether elements are straight, and whether eliminate() may lose digits.
  static constexpr bool straight = false, cancels = true;
  /// Returns unknowns in units of `length`, over those in m: `length`.
  static double unit(double length) { return length; }
  /// Returns the stiffness of an unknown over the bending stiffness.
  static double moment(double length) { return length; }
  /// Returns the unknowns of element i. `shape`: natural or initial.
  static tress::Vec at_rest(const Strand& strand, std::size_t i,
                            tress::Vec Segment::*shape) {
    return strand.segments[i].*shape;
  }

  /// Replaces the motion of the start by that of the tip, and fills e. Reads
  /// `acceleration` only if accelerated.
  template <bool accelerated>
  static void move(const Rule& /*rule*/, const Material& m, const Vec& q, const Vec& rate,
                   const Vec& acceleration, Motion& at, Kept& e) {
    e.v = at.v;
    e.omega = at.omega;
    e.a = at.a;
    e.alpha = at.alpha;
    const HelixElement<T> element(q, rate);
    const LaneFunctions<T> functions(q, m.length);
    const HelixFunctions<T> f = functions.at(m.length);
    const auto turn = element.turn(m.length, f, functions.x2());
    e.position = element.position(m.length, f);
    e.slope = element.slope(f);
    e.turn = turn.turn;
    e.rotation = turn.rotation;
    const Vec arm = cross(at.omega, e.position), moved = e.slope * rate;
    Vec own = element.bias(f), turning = turn.bias;
    if constexpr (accelerated) {
      own = own + e.slope * acceleration;
      turning = turning + e.turn * acceleration;
    }
    at.a = e.rotation.back(at.a + cross(at.alpha, e.position) + own +
                           cross(at.omega, arm + T(2) * moved));
    at.alpha = e.rotation.back(at.alpha + turning + cross(at.omega, turn.velocity));
    at.v = e.rotation.back(at.v + arm + moved);
    at.omega = e.rotation.back(at.omega + turn.velocity);
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

  using Loads = LoadSums<T>;               // sums of loads of effects
  using Inertia = UneliminatedInertia<T>;  // what carry() fills
  using Sums = HelixSums<T>;               // sums over the points of an element
  /// Computes the sums over the points. Reads `acceleration` only if accelerated.
  template <bool accelerated, class Kernel>
  static void add_up(const Kernel& kernel, const Material& m, const Vec& q,
                     const Vec& rate, const Vec& acceleration, const Kept& e,
                     Sums& sums) {
    const HelixElement<T> element(q, rate);
    const LaneFunctions<T> functions(q, m.length);
    AlongHelix<T> load = element.inertial(m.density, m.drag, e.v, e.omega, e.a, e.alpha);
    if constexpr (accelerated) element.add_second(m.density, acceleration, load);
    if constexpr (std::same_as<T, double>) {  // its points are in lanes
      HelixSums<Pack> packs;
      add_up_points<Pack>(kernel, functions, load, m.length, packs);
      const std::span<const Pack> each = models::numbers_of<Pack>(std::as_const(packs));
      std::ranges::transform(each, models::numbers_of<double>(sums).begin(),
                             [](const Pack& x) { return sum(x); });
    } else {
      sums = {};
      add_up_points<T>(kernel, functions, load, m.length, sums);
    }
  }

  /// Moves the hanging wrench from the tip to the start and adds that of the element,
  /// inertia less loads. `unknown` receives the right side of the unknowns, `of_effects`
  /// is null without loads. One code with and without loads: the same bits for strands
  /// that have none.
  static void bear(const Vec& q, const Vec& rate, const Sums& sums,
                   const LoadSums<T>* of_effects, const Kept& e, Wrench& wrench,
                   Vec& unknown) {
    const HelixWork<T> work(
        HelixElement<T>(q, rate),
        {sums.force_s, sums.force_A, sums.force_B, sums.force_A1, sums.force_B1});
    unknown = {};
    lift(e, wrench, unknown);
    wrench.force = sums.force + wrench.force;
    wrench.moment = work.moment + wrench.moment;
    unknown = unknown - work.unknown;
    if (of_effects == nullptr) [[likely]] {
      return;
    }
    of_effects->add_to(wrench.force, Vec{} - of_effects->force);
    of_effects->add_to(wrench.moment, Vec{} - of_effects->moment);
    of_effects->add_to(unknown, of_effects->unknown);
  }
  /// Returns `unknown`, which bear() has completed.
  static const Vec& felt(const Kept& /*e*/, const Wrench& /*wrench*/,
                         const Vec& unknown) {
    return unknown;
  }
  /// Adds the moment of the rotor at the start.
  static void pass_wrench(const Material& m, const Kept& e, Wrench& wrench) {
    wrench.moment = wrench.moment + rotor_moment(m.rotor, e.omega, e.alpha);
  }

  /// Moves the hanging inertia from the tip to the start and adds that of the element.
  static void carry(const Material& /*m*/, const ReducedInertia<T>& weights, const Vec& q,
                    const Vec& rate, const Sums& sums, const Hanging& hanging,
                    const LoadSums<T>* of_effects, const Kept& e,
                    UneliminatedInertia<T>& to) {
    const T& inertia = weights.of_length;
    const HelixMoments<T> points(HelixElement<T>(q, rate), q, sums);
    const Vec& tip = e.position;
    const HangingOnTip<T> on_tip(e.rotation, tip, hanging);
    const Matrix f_own = on_tip.force(e.slope, e.turn),
                 m_own = on_tip.moment(e.slope, e.turn);
    Hanging& all = to.sum;
    all.ll = on_tip.ll;
    all.la = on_tip.f_turn;
    all.aa = upper(on_tip.m_turn + cross_times(tip, on_tip.f_turn));
    add_mass(inertia * sums.one, inertia * points.first, inertia * points.second, all);
    // Columns of H_lk and H_ak by rows.
    to.of_force = f_own.transposed() + inertia * points.momentum;
    to.of_moment = (m_own + cross_times(tip, f_own)).transposed() + inertia * points.spin;
    to.own = upper(e.slope.transposed(), f_own.transposed()) +
             upper(e.turn.transposed(), m_own.transposed()) + inertia * points.inner;
    if (of_effects == nullptr) [[likely]] {
      return;
    }
    of_effects->add_to(all.ll, of_effects->ll);
    of_effects->add_to(all.la, of_effects->la);
    of_effects->add_to(all.aa, of_effects->aa);
    of_effects->add_to(to.of_force, of_effects->of_force);
    of_effects->add_to(to.of_moment, of_effects->of_moment);
    of_effects->add_to(to.own, of_effects->inner);
  }

  /// Moves a wrench from the tip to the start and subtracts from b what the unknowns
  /// feel.
  static void lift(const Kept& e, Wrench& wrench, Vec& b) {
    const Vec force = e.rotation * wrench.force, moment = e.rotation * wrench.moment;
    b = b - e.slope.back(force) - e.turn.back(moment);
    wrench = {force, moment + cross(e.position, force)};
  }
  /// Does nothing: the frame of the start is that of the tip before.
  static void set_back(const Kept& /*e*/, Wrench& /*wrench*/) {}

  /// Nothing: the Element of eliminate() stores all factors.
  struct Joint {};
  /// Returns the articulated inertia without the unknowns, to whose diagonal in S it adds
  /// `tangent`. Stores the factors in e.
  template <class Element>
  static Hanging eliminate(const Vec& tangent, bool twist, UneliminatedInertia<T>& from,
                           Element& e, Joint& /*joint*/) {
    from.own.xx += tangent.x;
    from.own.yy += tangent.y;
    from.own.zz += tangent.z;
    e.of_force = from.of_force;
    e.of_moment = from.of_moment;
    e.pivot = inverse_of_modes(from.own, twist);
    const Matrix z_l = e.pivot * e.of_force, z_a = e.pivot * e.of_moment;
    const Matrix by_force = e.of_force.transposed(), by_moment = e.of_moment.transposed();
    return {from.sum.ll - upper(by_force, z_l.transposed()),
            from.sum.aa - upper(by_moment, z_a.transposed()),
            from.sum.la - by_force * z_a};
  }
  /// Eliminates the unknowns from the wrench on the start. `b`: right side of the
  /// unknowns.
  template <class Element>
  static void reduce(const Vec& b, bool /*twist*/, const Joint& /*joint*/, Element& e,
                     Wrench& wrench) {
    e.unknown = e.pivot * b;
    wrench.force = wrench.force + e.of_force.back(e.unknown);
    wrench.moment = wrench.moment + e.of_moment.back(e.unknown);
  }
  /// Returns the unknowns. Replaces the changes of linear and angular acceleration, l and
  /// a, of the start by those of the tip.
  template <class Element>
  static Vec follow(const Element& e, bool /*twist*/, const Joint& /*joint*/, Vec& l,
                    Vec& a) {
    const Vec own = e.unknown - e.pivot * (e.of_force * l + e.of_moment * a);
    l = e.kept.rotation.back(l + cross(a, e.kept.position) + e.kept.slope * own);
    a = e.kept.rotation.back(a + e.kept.turn * own);
    return own;
  }

  /// Adds the inertia of the rotor at the start.
  static void pass(const Material& m, const T& acc, const Kept& /*e*/, Hanging& sum) {
    sum.aa.xx += acc * m.rotor;
  }

  /// Kinematics alone, seen from the start.
  class Shape {
   public:
    /// Prepares the functions of the element.
    Shape(const Rule& /*rule*/, const Vec& q, const Vec& rate, const T& length)
        : element_(q, rate), functions_(q, length), rate_(rate), length_(length) {}

    /// Returns position and velocity of a point.
    SeenPoint<T> at(const PointPlace<T>& point) const {
      const HelixFunctions<T> f = functions_.at(point.arc);
      return {element_.position(point.arc, f), element_.slope(f) * rate_};
    }
    /// Returns position, velocity and turn of the tip.
    [[gnu::always_inline]] SeenTip<T> tip() const {
      const HelixFunctions<T> f = functions_.at(length_);
      const auto turn = element_.turn(length_, f, functions_.x2());
      return {element_.position(length_, f), element_.slope(f) * rate_, turn.rotation,
              turn.velocity};
    }

   private:
    HelixElement<T> element_;
    LaneFunctions<T> functions_;
    Vec rate_;
    T length_;
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
    Points(const Kept& e, const Vec& q, const Vec& rate, const T& length)
        : e_(e), element_(q, rate), functions_(q, length), rate_(rate) {}

    /// Returns the position of a point.
    Vec position(const PointPlace<T>& at) const {
      return element_.position(at.arc, functions_.at(at.arc));
    }
    /// Returns the velocity of a point, which is at `position`.
    Vec velocity(const PointPlace<T>& at, const Vec& position) const {
      return e_.v + cross(e_.omega, position) +
             element_.slope(functions_.at(at.arc)) * rate_;
    }
    /// Returns the tangent at a point.
    Vec tangent(const PointPlace<T>& at) const {
      const HelixFunctions<T> f = functions_.at(at.arc);
      return Vec{T(1), T(0), T(0)} + f.S * element_.u() + f.A * element_.z();
    }
    /// Adds a force on a point.
    void add_force(const PointPlace<T>& at, const Vec& position, const Vec& force,
                   LoadSums<T>& sums) const {
      sums.add_force(position, force);
      sums.add_force_of_unknowns(element_.slope(functions_.at(at.arc)), force);
    }
    /// Adds the derivatives B of the load on a point (PointLoad).
    void add_block(const PointPlace<T>& at, const Vec& position,
                   const Symmetric3<T>& block, LoadSums<T>& sums) const {
      sums.add_block(position, block);
      sums.add_block_of_unknowns(position, element_.slope(functions_.at(at.arc)), block);
    }

   private:
    const Kept& e_;
    HelixElement<T> element_;
    LaneFunctions<T> functions_;
    Vec rate_;
  };

 private:
  template <class P, class Kernel>
  static void add_up_points(const Kernel& kernel, const LaneFunctions<T>& functions,
                            const AlongHelix<T>& of_load, const T& length,
                            HelixSums<P>& sums) {
    const AlongHelix<P> load{of_load.one, of_load.s,  of_load.A,  of_load.B,
                             of_load.A1,  of_load.B1, of_load.A2, of_load.B2};
    constexpr int step = std::same_as<T, P> ? 1 : P::lanes;
    for (int k = 0; k < kernel.points(); k += step) {
      const P arc = kernel.template at<P, step>(k) * P(length),
              weight = kernel.template weight<P, step>(k) * P(length);
      const HelixFunctions<P> f = functions.at(arc);
      sums.add(weight, arc, f);
      sums.add_force(weight * load.at(arc, f), arc, f);
    }
  }
};

/// Newton's step of clamped super-helices, side by side.
template <class T>
using HelixStrand = ReducedKernel<HelixKind<T>>;

}  // namespace tress::models
