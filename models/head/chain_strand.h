#pragma once

#include "models/head/helix_element.h"
#include "models/head/reduced_kernel.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Rigid links behind ball joints whose rotation vectors are the unknowns (rad) [Hadap,
/// Magnenat-Thalmann 2001; Hadap 2006]. A Kind of models/head/reduced_kernel.h, with the
/// equations of models/reduced/articulated_chain.h. A joint of rotation vector theta
/// turns like an element of length 1 that winds by theta (models/head/helix_element.h):
/// with K = [theta]x
///
///     E = I + S K + A K^2      from the link's axes to those of the link before
///     W = I + A K + B K^2      angular velocity = W theta', in the latter
///
/// regular for |theta| < 2 pi. The axes are those of the link: in them the link lies on
/// e0 and does not move. Sums over its points are therefore closed, carrying a wrench
/// from one end to the other takes a few products, and the unknowns enter by E^T W = W^T
/// alone. Cost: O(elements), whatever the number of points, at which effects act.
template <class T>
struct ChainKind {
 private:
  using Vec = Vec3<T>;
  using Matrix = Matrix3<T>;
  using Material = ReducedMaterial<T>;
  using Motion = ReducedMotion<T>;
  using Wrench = WrenchOf<T>;
  using Hanging = ArticulatedInertia<T>;

 public:
  using Real = T;                          // scalar: a number, or a pack of SIMD lanes
  using Unknowns = Vec;                    // of an element
  using Rule = NoRule;                     // points need no numbers of their own
  using Loads = LoadSums<T>;               // sums of loads of effects
  using Inertia = UneliminatedInertia<T>;  // what carry() fills

  /// Geometry and loads of a link that the sweeps share.
  struct Kept {
    Vec v, omega;           // motion of its joint, in the link's axes
    Vec force, moment;      // of inertia and drag, about its joint
    Vec position;           // of its tip
    Matrix rotation, turn;  // E, W
  };

  /// Stiffness of the clamp's joint over that of others, which are twice as long.
  static constexpr double first_stiffness = 2;
  /// Shares of an element's rotor that turn with the root and with the last tip.
  static constexpr double rotors_of_root = 0, rotors_of_last = 1;
  /// Whether elements are straight, and whether eliminate() may lose digits.
  static constexpr bool straight = true, cancels = false;
  /// Returns unknowns in units of `length`, over those in m: 1, since they are angles.
  static double unit(double /*length*/) { return 1; }
  /// Returns the stiffness of an unknown over the bending stiffness.
  static double moment(double length) { return 1 / length; }
  /// Returns the unknowns of joint i, half of the angles of each adjacent link. `shape`:
  /// natural or initial.
  static tress::Vec at_rest(const Strand& strand, std::size_t i,
                            tress::Vec Segment::*shape) {
    const Segment& own = strand.segments[i];
    tress::Vec angle = own.length / 2 * (own.*shape);
    if (i == 0) return angle;
    const Segment& before = strand.segments[i - 1];
    return angle + before.length / 2 * (before.*shape);
  }

  /// Replaces the motion of the tip before by that of the tip, and fills e. Reads
  /// `acceleration` only if accelerated.
  template <bool accelerated>
  static void move(const Rule& /*rule*/, const Material& m, const Vec& q, const Vec& rate,
                   const Vec& acceleration, Motion& at, Kept& e) {
    const auto joint = turn_of(q, rate);
    e.rotation = joint.rotation;
    e.turn = joint.turn;
    Vec turning = joint.bias;
    if constexpr (accelerated) turning = turning + e.turn * acceleration;
    at.alpha = e.rotation.back(at.alpha + turning + cross(at.omega, joint.velocity));
    at.omega = e.rotation.back(at.omega + joint.velocity);
    at.v = e.rotation.back(at.v);
    at.a = e.rotation.back(at.a);
    e.v = at.v;
    e.omega = at.omega;
    const T o(0);
    e.position = {m.length, o, o};
    // At the distance s the velocity is v + s `moving`, the acceleration a + s `bent`.
    const Vec &w = at.omega, moving{o, w.z, -w.y};
    const Vec bent = Vec{o, at.alpha.z, -at.alpha.y} + cross(w, moving);
    const Vec near = m.density * at.a + m.drag * at.v,
              far = m.density * bent + m.drag * moving;
    const T first = T(0.5) * m.length * m.length, second = T(2.0 / 3) * first * m.length;
    e.force = m.length * near + first * far;
    const Vec arm = first * near + second * far;
    e.moment = Vec{o, -arm.z, arm.y} + rotor_moment(m.rotor, w, at.alpha);
    at.v = at.v + m.length * moving;
    at.a = at.a + m.length * bent;
  }

  /// Nothing: sums over the points of a link are closed.
  struct Sums {};
  /// Does nothing: sums over the points of a link are closed.
  template <bool accelerated, class Kernel>
  static void add_up(const Kernel& /*kernel*/, const Material& /*m*/, const Vec& /*q*/,
                     const Vec& /*rate*/, const Vec& /*acceleration*/, const Kept& /*e*/,
                     Sums& /*sums*/) {}

  /// Returns the wrench on the last tip: none.
  static Wrench last_wrench(const Material& /*m*/, const Motion& /*tip*/) { return {}; }
  /// Moves the hanging wrench from the tip to the joint and adds that of the link,
  /// inertia less loads. `of_effects`: loads, or null. One code with and without loads:
  /// the same bits for strands that have none.
  static void bear(const Vec& /*q*/, const Vec& /*rate*/, const Sums& /*sums*/,
                   const LoadSums<T>* of_effects, const Kept& e, Wrench& wrench,
                   Vec& unknown) {
    unknown = {};
    lift(e, wrench, unknown);
    wrench.force = e.force + wrench.force;
    wrench.moment = e.moment + wrench.moment;
    if (of_effects == nullptr) [[likely]] {
      return;
    }
    of_effects->add_to(wrench.force, Vec{} - of_effects->force);
    of_effects->add_to(wrench.moment, Vec{} - of_effects->moment);
  }
  /// Returns what the unknowns feel of the wrench on the joint.
  static Vec felt(const Kept& e, const Wrench& wrench, const Vec& /*unknown*/) {
    return Vec{} - e.turn * wrench.moment;
  }
  /// Turns the wrench into the axes of the link before.
  static void pass_wrench(const Material& /*m*/, const Kept& e, Wrench& wrench) {
    set_back(e, wrench);
  }

  /// Returns the inertia on the last tip: none.
  static Hanging last(const Material& /*m*/, const T& /*acc*/) { return {}; }
  /// Moves the hanging inertia from the tip to the joint and adds that of the link. `to`
  /// receives the sum only.
  static void carry(const Material& m, const ReducedInertia<T>& inertia, const Vec& /*q*/,
                    const Vec& /*rate*/, const Sums& /*sums*/, const Hanging& hanging,
                    const LoadSums<T>* of_effects, const Kept& /*e*/,
                    UneliminatedInertia<T>& to) {
    const T& l = m.length;
    const T mass = inertia.of_length * l, first = T(0.5) * l * mass,
            second = T(2.0 / 3) * l * first;
    Hanging& all = to.sum;
    // By a turn of the link the tip moves by -[l e0]x.
    const Symmetric3<T>& ll = hanging.ll;
    const Matrix& la = hanging.la;
    all.la.row[0] = {la.row[0].x, la.row[0].y - l * ll.xz, la.row[0].z + l * ll.xy};
    all.la.row[1] = {la.row[1].x, la.row[1].y - l * ll.yz, la.row[1].z + l * ll.yy};
    all.la.row[2] = {la.row[2].x, la.row[2].y - l * ll.zz, la.row[2].z + l * ll.yz};
    const Symmetric3<T>& aa = hanging.aa;
    all.aa = {aa.xx + inertia.acc * m.rotor,
              aa.yy - l * (la.row[2].y + all.la.row[2].y) + second,
              aa.zz + l * (la.row[1].z + all.la.row[1].z) + second,
              aa.xy - l * la.row[2].x,
              aa.xz + l * la.row[1].x,
              aa.yz + l * (la.row[1].y - all.la.row[2].z)};
    all.la.row[1].z += first;
    all.la.row[2].y -= first;
    all.ll = ll;
    all.ll.xx += mass;
    all.ll.yy += mass;
    all.ll.zz += mass;
    if (of_effects == nullptr) [[likely]] {
      return;
    }
    of_effects->add_to(all.ll, of_effects->ll);
    of_effects->add_to(all.la, of_effects->la);
    of_effects->add_to(all.aa, of_effects->aa);
  }

  /// Turns the articulated inertia into the axes of the link before.
  static void pass(const Material& /*m*/, const T& /*acc*/, const Kept& e, Hanging& sum) {
    const Matrix& r = e.rotation;
    sum = {congruent(r, sum.ll), congruent(r, sum.aa), r * sum.la * r.transposed()};
  }

  /// The unknowns of a turn y: x_k = of[k].y and y = sum x_k w_k, w_k the rows of W.
  /// Without twist the sum has the last two terms and y is normal to `normal`.
  struct OfTurn {
    OfTurn() = default;
    /// Computes D from W.
    OfTurn(const Matrix& w, bool twist) {
      const Vec across = cross(w.row[1], w.row[2]), first = twist ? w.row[0] : across;
      const T by = T(1) / dot(first, across);
      of[0] = by * across;
      of[1] = by * cross(w.row[2], first);
      of[2] = by * cross(first, w.row[1]);
      if (!twist) normal = square_root(by) * across;
    }
    Vec of[3];   // rows of D
    Vec normal;  // unit vector, without twist only
  };

  /// Factors of eliminate().
  struct Joint {
    OfTurn of;                // turn y by the unknowns
    Symmetric3<T> stiffness;  // D^T K D
    Vec about;                // m_n
  };
  /// Eliminates the joint's unknown from the articulated inertia. The unknown is the turn
  /// y = W^T x of the link by the joint, in the link's axes, with x = D y. K and b are
  /// the joint's stiffness in S and its moment. The link responds to accelerations (l, a
  /// + y) with the wrench (f, m) + [ll la; la^T aa]. It needs
  ///
  ///     y = -P (m + D^T b + la^T l + aa a),    P = (aa + D^T K D)^-1
  ///
  /// and passes on, where I - aa P = D^T K D P,
  ///
  ///     aa' = aa P D^T K D       m' = D^T K D P m - aa P D^T b
  ///     la' = la P D^T K D       f' = f - la P (m + D^T b)
  ///     ll' = ll - la P la^T
  ///
  /// A joint that is soft compared with the inertia of its step passes on little but its
  /// own stiffness. In the form I - H H_kk^-1 H^T that is a difference of numbers larger
  /// by aa/K. Rounding of the links' spin, whose inertia is smaller by the square of
  /// their slenderness, would leave no digit. Here nothing cancels, however soft or stiff
  /// the joint. Without twist y is normal to n, about which the joint is infinitely
  /// stiff. With any stiffness about n in Q = (aa + D^T K D + k n n^T)^-1, and m_n = Q
  /// n/(n.Q n),
  ///
  ///     P = Q - Q n m_n^T,    I - aa P = D^T K D P + n m_n^T
  template <class Element>
  static Hanging eliminate(const Vec& tangent, bool twist,
                           const UneliminatedInertia<T>& from, Element& e, Joint& joint) {
    const Hanging& all = from.sum;
    joint.of = OfTurn(e.kept.turn, twist);
    const OfTurn& x = joint.of;
    const T first = twist ? tangent.x : T(0);
    const Matrix stiffer{{first * x.of[0], tangent.y * x.of[1], tangent.z * x.of[2]}};
    const Symmetric3<T> k =
        upper(stiffer.transposed(), Matrix::columns(x.of[0], x.of[1], x.of[2]));
    joint.stiffness = k;
    const Matrix inertia = full(all.aa);
    Symmetric3<T> p = all.aa + k;
    if (!twist) p = p + (k.xx + k.yy + k.zz) * squared(x.normal);
    p = inverse(p);
    if (!twist) {
      const Vec turned = p * x.normal;
      joint.about = (T(1) / dot(x.normal, turned)) * turned;
      p = p - upper(dyad(turned, joint.about));
    }
    const Matrix shift = all.la * full(p), turn = inertia * full(p);
    e.pivot = p;
    e.of_force = all.la.transposed();
    e.of_moment = inertia;
    Hanging passed;
    passed.aa = upper(turn, full(k));
    passed.la = shift * full(k);
    passed.ll = all.ll - upper(shift, all.la);
    if (!twist) {
      passed.aa = passed.aa + upper(dyad(all.aa * joint.about, x.normal));
      passed.la = passed.la + dyad(all.la * joint.about, x.normal);
    }
    return passed;
  }
  /// Eliminates the unknowns from the wrench on the joint and prepares follow(). `b`:
  /// moment of the joint on its unknowns, less that of its stiffness.
  template <class Element>
  static void reduce(const Vec& b, bool twist, const Joint& joint, Element& e,
                     Wrench& wrench) {
    const Vec(&x)[3] = joint.of.of;
    Vec own = b.y * x[1] + b.z * x[2];
    if (twist) own = own + b.x * x[0];
    const Vec freed = e.pivot * wrench.moment, held = e.pivot * own;
    e.unknown = held - freed;
    wrench.force = wrench.force + e.of_force.back(e.unknown);
    Vec passed = joint.stiffness * freed + e.of_moment * held;
    if (!twist) passed = passed + dot(joint.about, wrench.moment) * joint.of.normal;
    wrench.moment = passed;
  }
  /// Returns the unknowns. Replaces the changes of linear and angular acceleration, l and
  /// a, of the tip before by those of the tip.
  template <class Element>
  static Vec follow(const Element& e, bool twist, const Joint& joint, Vec& l, Vec& a) {
    const Vec(&x)[3] = joint.of.of;
    l = e.kept.rotation.back(l);
    a = e.kept.rotation.back(a);
    const Vec y = e.unknown - e.pivot * (e.of_force * l + e.of_moment * a);
    a = a + y;
    l = l + cross(a, e.kept.position);
    return {twist ? dot(x[0], y) : T(0), dot(x[1], y), dot(x[2], y)};
  }

  /// Moves a wrench from the tip to the joint. The unknowns feel it as a turn of the link
  /// (reduce()).
  static void lift(const Kept& e, Wrench& wrench, Vec& /*b*/) {
    const Vec lever = e.position.x * wrench.force;
    wrench.moment = wrench.moment + Vec{T(0), -lever.z, lever.y};
  }
  /// Turns a wrench into the axes of the link before.
  static void set_back(const Kept& e, Wrench& wrench) {
    wrench = {e.rotation * wrench.force, e.rotation * wrench.moment};
  }

  /// Kinematics alone, seen from the joint in the axes of the link before.
  class Shape {
   public:
    /// Computes the turn of the joint.
    Shape(const Rule& /*rule*/, const Vec& q, const Vec& rate, const T& length)
        : joint_(turn_of(q, rate)),
          along_(joint_.rotation.column(0)),
          moving_(cross(joint_.velocity, along_)),
          length_(length) {}

    /// Returns position and velocity of a point.
    SeenPoint<T> at(const PointPlace<T>& point) const {
      return {point.arc * along_, point.arc * moving_};
    }
    /// Returns position, velocity and turn of the tip.
    [[gnu::always_inline]] SeenTip<T> tip() const {
      return {length_ * along_, length_ * moving_, joint_.rotation, joint_.velocity};
    }

   private:
    typename HelixElement<T>::Turn joint_;
    Vec along_, moving_;
    T length_;
  };

  /// Replaces the frame of the tip before by that of the link.
  static void enter(const Kept& e, FrameOf<T>& frame) {
    frame = frame *
            FrameOf<T>{e.rotation.column(0), e.rotation.column(1), e.rotation.column(2)};
  }
  /// Does nothing: the frame of the tip is that of the link.
  static void go_on(const Kept& /*e*/, FrameOf<T>& /*frame*/) {}

  /// Points on which effects act, in the link's axes.
  class Points {
   public:
    /// Takes a link whose state e must outlive the points.
    Points(const Kept& e, const Vec& /*q*/, const Vec& /*rate*/, const T& /*length*/)
        : e_(e) {}

    /// Returns the position of a point.
    Vec position(const PointPlace<T>& at) const { return {at.arc, T(0), T(0)}; }
    /// Returns the velocity of the point at `position`.
    Vec velocity(const PointPlace<T>& /*at*/, const Vec& position) const {
      return e_.v + cross(e_.omega, position);
    }
    /// Returns the tangent at any point.
    Vec tangent(const PointPlace<T>& /*at*/) const { return {T(1), T(0), T(0)}; }
    /// Adds a force on a point. The unknowns move the point as a turn of the link does.
    void add_force(const PointPlace<T>& /*at*/, const Vec& position, const Vec& force,
                   LoadSums<T>& sums) const {
      sums.add_force(position, force);
    }
    /// Adds the derivatives B of the load on a point (PointLoad).
    void add_block(const PointPlace<T>& /*at*/, const Vec& position,
                   const Symmetric3<T>& block, LoadSums<T>& sums) const {
      sums.add_block(position, block);
    }

   private:
    const Kept& e_;
  };

 private:
  static Symmetric3<T> squared(const Vec& n) {
    return {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
  }

  static typename HelixElement<T>::Turn turn_of(const Vec& theta, const Vec& rate) {
    const T one(1);
    const LaneFunctions<T> functions(theta, one);
    return HelixElement<T>(theta, rate).turn(one, functions.at(one), functions.x2());
  }
};

/// Newton's step of clamped chains of rigid links, side by side.
template <class T>
using ChainStrand = ReducedKernel<ChainKind<T>>;

}  // namespace tress::models
