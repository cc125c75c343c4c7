#pragma once

#include "models/head/exact/varied_element.h"
#include "models/head/helix_strand.h"

namespace tress::models {

/// An element of constant Darboux vector kappa (models/head/helix_element.h). Functions
/// of arc length depend on kappa by dA = A1 (kappa . dkappa); the coefficients that they
/// have in positions and forces are polynomials.
template <class T>
class VariedElement<HelixKind<T>> {
 public:
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Data of an element that steps do not change.
  using Material = ReducedMaterial<T>;

  /// Prepares an element at a state.
  VariedElement(const Material& m, Weights w, const Vec& q, const Vec& rate,
                const Vec& acceleration)
      : m_(m),
        k_(q),
        along_(T(w.pos) * q),
        functions_(q, m.length),
        rate_(varied_alike(rate, T(w.vel))),
        second_(varied_alike(acceleration, T(w.acc))),
        element_(varied_alike(q, T(w.pos)), rate_) {}

  /// Returns the motion of the tip.
  VariedTip<T> tip() const {
    const HelixFunctions<Varied<T>> f =
        varied_functions(functions_.at(m_.length), along_);
    const auto turn =
        element_.turn(Varied<T>(m_.length), f, varied(functions_.x2(), T(2) * along_));
    VariedTip<T> tip;
    tip.position = element_.position(Varied<T>(m_.length), f);
    tip.slope = element_.slope(f);
    tip.turn = turn.turn;
    tip.velocity = tip.slope * rate_;
    tip.acceleration = element_.bias(f) + tip.slope * second_;
    tip.turning = turn.velocity;
    tip.spinning = turn.bias + turn.turn * second_;
    tip.rotation = value_of(turn.rotation);
    return tip;
  }

  /// Returns the motion of the point at an arc length.
  VariedPoint<T> point(const T& arc) const {
    const HelixFunctions<Varied<T>> f = varied_functions(functions_.at(arc), along_);
    const Matrix3<Varied<T>> slope = element_.slope(f);
    return {element_.position(Varied<T>(arc), f), slope * rate_, slope};
  }
  /// Transforms from the components of the element's axes to those of its start.
  template <class X>
  const X& in_start(const X& x) const {
    return x;
  }

  /// `from`: motion of its start.
  template <class Kernel>
  VariedWrench<T> inertial(const Kernel& kernel, const ReducedMotion<T>& from,
                           ElementSums<T>& sums) const {
    AlongHelix<Varied<T>> load =
        element_.inertial(m_.density, m_.drag, from.v, from.omega, from.a, from.alpha);
    element_.add_second(m_.density, second_, load);
    const AlongHelix<T> whole = each_of(load, [](const auto& x) { return value_of(x); });
    const auto part = [&](std::size_t k) {
      return each_of(load, [k](const auto& x) { return part_of(x, k); });
    };
    const AlongHelix<T> parts[3] = {part(0), part(1), part(2)};
    HelixSums<T> of_points, of_parts[3], of_functions;
    Vec force_A2, force_B2;
    for (int i = 0; i < kernel.points(); ++i) {
      const T arc = T(kernel.at(i)) * m_.length, weight = T(kernel.weight(i)) * m_.length;
      const HelixFunctions<T> f = functions_.at(arc);
      of_points.add(weight, arc, f);
      const Vec force = weight * whole.at(arc, f);
      of_points.add_force(force, arc, f);
      force_A2 = force_A2 + f.A2 * force;
      force_B2 = force_B2 + f.B2 * force;
      of_functions.add_force(weight * whole.slope(f), arc, f);
      for (int k = 0; k < 3; ++k) {
        of_parts[k].add_force(weight * parts[k].by_functions(f), arc, f);
      }
    }
    of_functions.force_A = of_functions.force_A + of_points.force_A1;
    of_functions.force_B = of_functions.force_B + of_points.force_B1;
    of_functions.force_A1 = of_functions.force_A1 + force_A2;
    of_functions.force_B1 = of_functions.force_B1 + force_B2;
    add_up(of_points, from.omega, sums);
    return wrench(of_points, of_functions, of_parts);
  }

 private:
  using Vector = VariedVec<T>;

  template <class Take>
  static AlongHelix<T> each_of(const AlongHelix<Varied<T>>& x, Take take) {
    return {take(x.one), take(x.s),  take(x.A),  take(x.B),
            take(x.A1),  take(x.B1), take(x.A2), take(x.B2)};
  }

  /// Sums of forces times functions: their values, what functions add to derivatives and
  /// what coefficients do.
  VariedWrench<T> wrench(const HelixSums<T>& of_points, const HelixSums<T>& of_functions,
                         const HelixSums<T> (&of_parts)[3]) const {
    const auto whole = [&](Vec HelixSums<T>::*x) {
      const auto part = [&](std::size_t k, const T& along) {
        return of_parts[k].*x + along * (of_functions.*x);
      };
      return with_parts<T>(of_points.*x, part(0, along_.x), part(1, along_.y),
                           part(2, along_.z));
    };
    const HelixWork<Varied<T>> work(
        element_, {whole(&HelixSums<T>::force_s), whole(&HelixSums<T>::force_A),
                   whole(&HelixSums<T>::force_B), whole(&HelixSums<T>::force_A1),
                   whole(&HelixSums<T>::force_B1)});
    return {whole(&HelixSums<T>::force), work.moment, work.unknown};
  }

  void add_up(const HelixSums<T>& m, const Vec& omega, ElementSums<T>& to) const {
    const Vec rate = value_of(rate_);
    const HelixElement<T> element(k_, rate);
    const HelixMoments<T> points(element, k_, m);
    to.one = m.one;
    to.first = points.first;
    to.second = points.second;
    to.momentum[0] = points.momentum;
    to.spin[0] = points.spin;

    // d_j = kappa_j r + B l_j + A m_j, P = s e0 + A u + B z.
    const Vec &u = element.u(), &z = element.z();
    const T k_v = dot(k_, rate);
    const Vec l_v = element.along_l(rate), u_v{T(0), rate.z, -rate.y};
    const auto times_p = [&](const T& s, const T& a, const T& b) {
      return Vec{s + b * z.x, a * u.y + b * z.y, a * u.z + b * z.z};
    };
    const auto times_r = [&](const T& a, const T& b) {
      return Vec{b * z.x, a * u.y + b * z.y, a * u.z + b * z.z};
    };
    const Vec a_p = times_p(m.sA, m.AA, m.AB), b_p = times_p(m.sB, m.AB, m.BB),
              a_r = times_r(m.AA1, m.AB1), b_r = times_r(m.BA1, m.BB1);
    const Matrix r_p =
        dyad(u, times_p(m.sA1, m.AA1, m.BA1)) + dyad(z, times_p(m.sB1, m.AB1, m.BB1));
    to.moved = points.momentum.back(rate);
    to.moving = k_v * r_p + dyad(l_v, b_p) + dyad(u_v, a_p);

    const T trace = r_p.row[0].x + r_p.row[1].y + r_p.row[2].z;
    const Vec of_k = r_p * omega + r_p.back(omega) - T(2) * trace * omega +
                     T(2) * (cross(l_v, b_r) + cross(u_v, a_r));
    // P' x d_j but for kappa_j r.
    const Vec by_l = T(2) * (k_v * b_r + m.BB * l_v + m.AB * u_v),
              by_m = T(2) * (k_v * a_r + m.AB * l_v + m.AA * u_v);
    // What is linear in x = l_j with y = sum w B P, and so on.
    const auto felt = [&](const Vec& x, const Vec& y, const Vec& by) {
      return dot(y, omega) * x + dot(x, omega) * y - T(2) * dot(x, y) * omega +
             cross(by, x);
    };
    const T o(0), one(1), two(2);
    to.convective[0] = {{k_.x * of_k + felt({o, k_.y, k_.z}, b_p, by_l),
                         k_.y * of_k + felt({-two * k_.y, k_.x, o}, b_p, by_l) +
                             felt({o, o, -one}, a_p, by_m),
                         k_.z * of_k + felt({-two * k_.z, o, k_.x}, b_p, by_l) +
                             felt({o, one, o}, a_p, by_m)}};
  }

  const Material& m_;
  Vec k_, along_;
  LaneFunctions<T> functions_;
  Vector rate_, second_;
  HelixElement<Varied<T>> element_;
};

}  // namespace tress::models
