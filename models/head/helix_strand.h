#pragma once

#include "models/head/helix_element.h"
#include "models/head/reduced_kernel.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Elements of constant Darboux vector, the unknowns (1/m): a Kind of
/// models/head/reduced_kernel.h, with the equations of models/reduced/super_helix.h. Its
/// axes are those of its start. Halves of the rotors of two elements turn with the tip
/// between them.
template <class T>
struct HelixKind {
  using Real = T;
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Material = ReducedMaterial<T>;
  using Motion = ReducedMotion<T>;
  using Sum = ArticulatedSum<T>;

  struct Kept {
    Vec v, omega, a, alpha;        // of its start
    Vec position;                  // of its tip
    Matrix slope, turn, rotation;  // dP/dkappa, W, E at the tip
  };

  static constexpr double first_stiffness = 1;
  static constexpr double rotors_of_root = 0.5, rotors_of_last = 0.5;
  static constexpr bool straight = false, eliminates = false;
  static double unit(double length) { return length; }
  static double moment(double length) { return length; }
  /// `shape`: natural or initial.
  static tress::Vec at_rest(const Strand& strand, std::size_t i,
                            tress::Vec Segment::*shape) {
    return strand.segments[i].*shape;
  }

  template <bool accelerated>
  static void move(const Material& m, const Vec& q, const Vec& rate,
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

  /// Half a rotor.
  static Sum last(const Material& m, const Motion& tip, const T& acc) {
    const T rotor = T(0.5) * m.rotor;
    Sum end{};
    end.moment = rotor_moment(rotor, tip.omega, tip.alpha);
    end.aa.xx += acc * rotor;
    return end;
  }

  template <bool accelerated, class Kernel>
  static void carry(const Kernel& kernel, const Material& m,
                    const typename Kernel::Inertia& weights, const Vec& q,
                    const Vec& rate, const Vec& acceleration, const Sum& hanging,
                    const LoadSums<T>* of_effects, const Kept& e,
                    typename Kernel::Uneliminated& to) {
    const T& inertia = weights.of_length;
    const HelixElement<T> element(q, rate);
    const LaneFunctions<T> functions(q, m.length);
    AlongHelix<T> load = element.inertial(m.density, m.drag, e.v, e.omega, e.a, e.alpha);
    if constexpr (accelerated) element.add_second(m.density, acceleration, load);
    HelixSums<T> sums;
    for (int k = 0; k < kernel.points(); ++k) {
      const T arc = T(kernel.at(k)) * m.length, weight = T(kernel.weight(k)) * m.length;
      const HelixFunctions<T> f = functions.at(arc);
      sums.add(weight, arc, f);
      sums.add_force(weight * load.at(arc, f), arc, f);
    }
    const HelixMoments<T> points(element, q, sums);
    // What hangs on the tip, in the components of the start.
    const Symmetric3<T> ll = congruent(e.rotation, hanging.ll),
                        aa = congruent(e.rotation, hanging.aa);
    const Matrix la = e.rotation * hanging.la * e.rotation.transposed(),
                 al = la.transposed();
    const Vec tip_force = e.rotation * hanging.force,
              tip_moment = e.rotation * hanging.moment;
    // Wrench that the tip answers with when the start turns, or the unknowns change: the
    // tip then moves by -[P]x and by dP/dkappa, W.
    const Vec& tip = e.position;
    const Matrix f_turn = la - times_cross(full(ll), tip),
                 f_own = ll * e.slope + la * e.turn;
    const Matrix m_turn = full(aa) - times_cross(al, tip),
                 m_own = al * e.slope + aa * e.turn;
    const Vec p = inertia * points.first;
    const T mass = inertia * sums.one;
    Sum& all = to.sum;
    all = {sums.force + tip_force,
           points.moment + tip_moment + cross(tip, tip_force),
           ll,
           {},
           {}};
    all.ll.xx += mass;
    all.ll.yy += mass;
    all.ll.zz += mass;
    all.la = f_turn - cross_matrix(p);
    const Symmetric3<T> pp = inertia * points.second;
    all.aa = upper(m_turn + cross_times(tip, f_turn)) - pp;
    const T trace = pp.xx + pp.yy + pp.zz;
    all.aa.xx += trace;
    all.aa.yy += trace;
    all.aa.zz += trace;
    // Columns of H_lk and H_ak by rows.
    to.of_force = f_own.transposed() + inertia * points.momentum;
    to.of_moment = (m_own + cross_times(tip, f_own)).transposed() + inertia * points.spin;
    to.own = upper(e.slope.transposed(), f_own.transposed()) +
             upper(e.turn.transposed(), m_own.transposed()) + inertia * points.inner;
    to.unknown =
        Vec{} - points.unknown - e.slope.back(tip_force) - e.turn.back(tip_moment);
    // One code with and without loads: the same bits for strands that have none. The
    // wrench is that of inertia less loads.
    if (of_effects == nullptr) [[likely]] {
      return;
    }
    of_effects->add_to(all.force, Vec{} - of_effects->force);
    of_effects->add_to(all.moment, Vec{} - of_effects->moment);
    of_effects->add_to(to.unknown, of_effects->unknown);
    of_effects->add_to(all.ll, of_effects->ll);
    of_effects->add_to(all.la, of_effects->la);
    of_effects->add_to(all.aa, of_effects->aa);
    of_effects->add_to(to.of_force, of_effects->of_force);
    of_effects->add_to(to.of_moment, of_effects->of_moment);
    of_effects->add_to(to.own, of_effects->inner);
  }

  /// The rotor at its start.
  static void pass(const Material& m, const T& acc, const Kept& e, Sum& sum) {
    sum.moment = sum.moment + rotor_moment(m.rotor, e.omega, e.alpha);
    sum.aa.xx += acc * m.rotor;
  }

  static void arrive(const Kept& /*e*/, Vec& /*l*/, Vec& /*a*/) {}
  static void leave(const Kept& e, const Vec& own, Vec& l, Vec& a) {
    l = e.rotation.back(l + cross(a, e.position) + e.slope * own);
    a = e.rotation.back(a + e.turn * own);
  }

  /// Kinematics alone.
  class Shape {
   public:
    Shape(const Vec& q, const Vec& rate, const T& length)
        : element_(q, rate), functions_(q, length), rate_(rate), length_(length) {}

    SeenPoint<T> at(const T& arc) const {
      const HelixFunctions<T> f = functions_.at(arc);
      return {element_.position(arc, f), element_.slope(f) * rate_};
    }
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

  /// The frame of its axes, from that of the tip before, and on to its tip's.
  static void enter(const Kept& /*e*/, FrameOf<T>& /*frame*/) {}
  static void go_on(const Kept& e, FrameOf<T>& frame) {
    frame = frame *
            FrameOf<T>{e.rotation.column(0), e.rotation.column(1), e.rotation.column(2)};
  }

  /// Points on which effects act, in its axes.
  class Points {
   public:
    Points(const Kept& e, const Vec& q, const Vec& rate, const T& length)
        : e_(e), element_(q, rate), functions_(q, length), rate_(rate) {}

    Vec position(const T& arc) const {
      return element_.position(arc, functions_.at(arc));
    }
    Vec velocity(const T& arc, const Vec& position) const {
      return e_.v + cross(e_.omega, position) +
             element_.slope(functions_.at(arc)) * rate_;
    }
    Vec tangent(const T& arc) const {
      const HelixFunctions<T> f = functions_.at(arc);
      return Vec{T(1), T(0), T(0)} + f.S * element_.u() + f.A * element_.z();
    }
    void add(const T& arc, const Vec& position, const PointLoad<T>& load,
             LoadSums<T>& sums) const {
      sums.add(position, load);
      sums.add_unknowns(position, element_.slope(functions_.at(arc)), load);
    }

   private:
    const Kept& e_;
    HelixElement<T> element_;
    LaneFunctions<T> functions_;
    Vec rate_;
  };
};

/// Newton's step of clamped super-helices, side by side.
template <class T>
using HelixStrand = ReducedKernel<HelixKind<T>>;

}  // namespace tress::models
