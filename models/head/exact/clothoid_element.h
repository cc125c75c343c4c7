#pragma once

#include "models/head/clothoid_strand.h"
#include "models/head/exact/exact_element.h"

namespace tress::models {

/// ExactElement of linear Darboux vectors, with the equations of
/// models/reduced/exact_tangent.h. The derivatives along the unknowns are those of
/// models/clothoid/clothoid.h, which one strand by itself uses as well.
template <class T>
class ExactElement<ClothoidKind<T>> {
  using Kind = ClothoidKind<T>;
  using Clothoid = typename Kind::Clothoid;
  using Directions = typename Clothoid::Directions;
  static constexpr std::size_t dofs = Clothoid::dofs, functions = 2;
  static_assert(dofs == 3 * functions);

 public:
  /// Kernel of the sweeps along a strand.
  using Kernel = ReducedKernel<Kind>;
  /// Vector of scalars.
  using Vec = Vec3<T>;
  /// Matrix of scalars.
  using Matrix = Matrix3<T>;
  /// Data of an element that steps do not change.
  using Material = ReducedMaterial<T>;
  /// Unknowns of an element.
  using Unknowns = typename Kind::Unknowns;
  /// Elimination of an element.
  using Elimination = ExactElimination<T, functions>;
  /// Factors of an element.
  using Factors = typename Elimination::Factors;
  /// Columns of an element.
  using Columns = typename Elimination::Columns;
  /// Columns of displacements.
  using Places = typename Elimination::Places;
  /// Response of all that hangs on a tip.
  using Hanging = typename Elimination::Hanging;

  /// Prepares the equations of an element at a state, whose motion is in `kept`.
  ExactElement(const Kernel& kernel, const Material& m, Weights w, const Unknowns& /*q*/,
               const Unknowns& v, const Unknowns& a, const typename Kind::Kept& kept)
      : kernel_(kernel),
        m_(m),
        acc_(w.acc),
        vel_(w.vel),
        pos_(w.pos),
        v_(v),
        a_(a),
        kept_(kept) {
    kept.shape.derivatives(v, a, velocity_, acceleration_, curvature_, &tips_);
  }

  /// Computes the element's own factors with the wrench on its tip: A, B, C, D, R and H.
  void own(const Hanging& hanging, Factors& e, Columns& to) const {
    e.rotation = kept_.rotation;
    e.position = kept_.position;
    e.slope = kept_.slope;
    e.turn = kept_.turn;
    move_tip(e);
    for (auto& x : to.x) x = {};
    inertial(to);
    take_tip(hanging, to);
  }

  /// Adds elastic and viscous moments, and the inertia of the section.
  void add_bending(const typename Kernel::Bending& bending, Columns& to) const {
    to.unknown[0] = to.unknown[0] + bending.moment.mean;
    to.unknown[1] = to.unknown[1] + bending.moment.half;
    to.unknown[1].x += Kind::section_inertia(m_) * a_.half.x;
    to.x[0].own[0] = to.x[0].own[0] + Inertia::diagonal(bending.tangent.mean);
    to.x[1].own[1] = to.x[1].own[1] + Inertia::diagonal(bending.tangent.half);
  }

  /// Adds the loads on the element's points; see ExactElement of other elements.
  void add_loads(const ExactPoint<T>* loads, Factors& e, Columns& to,
                 Places& places) const {
    T some(0);
    Columns all = to;
    Places all_places = places;
    for (int k = 0; k < kernel_.points(); ++k) {
      const ExactPoint<T>& at = loads[k];
      if (!any_less(T(0), at.some)) continue;
      some = larger(some, at.some);
      const Vec& f = at.load.force;
      const Matrix &by_x = at.load.by_x, &by_u = at.load.by_u;
      const Vec p = kept_.shape.position()[k], moving = kept_.moving[k];
      const Vec u = kept_.v + cross(kept_.omega, p) + moving;
      add_force(k, Vec{} - f, all);
      for (std::size_t unknown = 0; unknown < dofs; ++unknown) {
        const Vec slope = slope_of(unknown)[k];
        const Vec change =
            pos_ * (cross(kept_.omega, slope) + velocity_[unknown][k]) + vel_ * slope;
        add_column(k, unknown, pos_ * (by_x * slope) + by_u * change, Vec{} - f, all);
      }
      const auto slopes = Kind::slopes(kept_, k);
      const auto add = [&](const Matrix& force, Column& column) {
        column.force = column.force + force;
        column.moment = column.moment + cross_times(p, force);
        for (std::size_t g = 0; g < functions; ++g) {
          column.own[g] = column.own[g] + slopes[g].transposed() * force;
        }
      };
      add(by_x, all_places[0]);
      add(Matrix{} - cross_matrix(f) - times_cross(by_x, p) - times_cross(by_u, u),
          all_places[1]);
      add(by_u, all.state[Elimination::velocity]);
      add(Matrix{} - times_cross(by_u, p), all.state[Elimination::omega]);
    }
    Elimination::put(some, all.force, to.force);
    Elimination::put(some, all.moment, to.moment);
    for (std::size_t g = 0; g < functions; ++g) {
      Elimination::put(some, all.unknown[g], to.unknown[g]);
      Elimination::put(some, all.x[g], to.x[g]);
      Elimination::put(some, all_places[g], places[g]);
    }
    for (const auto state : {Elimination::velocity, Elimination::omega}) {
      Elimination::put(some, all.state[state], to.state[state]);
    }
    e.placed = larger(e.placed, some);
  }

 private:
  using Inertia = ExactInertia<T, functions>;
  using Column = typename Elimination::Column;

  static void put_column(std::size_t unknown, const Vec& x,
                         std::array<Matrix, functions>& to) {
    set_column(to[unknown / 3], unknown % 3, x);
  }
  static void set_column(Matrix& m, std::size_t k, const Vec& x) {
    T Vec::*const entry = k == 0 ? &Vec::x : k == 1 ? &Vec::y : &Vec::z;
    m.row[0].*entry = x.x;
    m.row[1].*entry = x.y;
    m.row[2].*entry = x.z;
  }
  static void add_to_column(Matrix& m, std::size_t k, const Vec& x) {
    T Vec::*const entry = k == 0 ? &Vec::x : k == 1 ? &Vec::y : &Vec::z;
    m.row[0].*entry += x.x;
    m.row[1].*entry += x.y;
    m.row[2].*entry += x.z;
  }
  const auto& slope_of(std::size_t k) const {
    return kept_.shape.slope_of(static_cast<int>(k));
  }
  const auto& turn_of(std::size_t k) const {
    return kept_.shape.turn_of(static_cast<int>(k));
  }

  /// Moves the tip by a change dq. The tip then turns by theta, and d(E^T y) = E^T (dy +
  /// y x theta).
  void move_tip(Factors& e) const {
    const Vec &omega = kept_.omega, &alpha = kept_.alpha, &p = kept_.position,
              &u = kept_.moving.tip;
    const Vec arm = cross(omega, p);
    const Vec tip_v = kept_.v + arm + u, tip_omega = omega + kept_.turning;
    const Vec tip_a =
        kept_.a + cross(alpha, p) + kept_.accelerating.tip + cross(omega, arm + T(2) * u);
    const Vec tip_alpha = alpha + spinning() + cross(omega, kept_.turning);
    for (std::size_t k = 0; k < dofs; ++k) {
      const Vec &slope = slope_of(k).tip, &turn = turn_of(k).tip,
                &bent = velocity_[k].tip, &turned = tips_.turned[k];
      const Vec theta = pos_ * turn, carried = cross(omega, slope);
      put_column(k, pos_ * (carried + bent) + vel_ * slope + cross(tip_v, theta),
                 e.tip[0]);
      put_column(k, pos_ * turned + vel_ * turn + cross(tip_omega, theta), e.tip[1]);
      put_column(k,
                 pos_ * (cross(alpha, slope) + cross(omega, carried + T(2) * bent) +
                         acceleration_[k].tip) +
                     (T(2) * vel_) * (carried + bent) + acc_ * slope +
                     cross(tip_a, theta),
                 e.tip[2]);
      put_column(k,
                 pos_ * (tips_.spinning[k] + cross(omega, turned)) +
                     vel_ * (turned + tips_.by_rate[k] + cross(omega, turn)) +
                     acc_ * turn + cross(tip_alpha, theta),
                 e.tip[3]);
    }
    e.of_omega = Inertia::turning_with(omega, p, u);
    e.of_turning = cross_matrix(Vec{} - kept_.turning);
  }
  /// Rate of the tip's turning at no rate of the start's.
  Vec spinning() const {
    return kept_.shape.dW(v_, v_).value + kept_.turn[0] * a_.mean +
           kept_.turn[1] * a_.half;
  }

  /// Adds a force at point k to the residual.
  void add_force(int k, const Vec& force, Columns& to) const {
    const auto slopes = Kind::slopes(kept_, k);
    to.force = to.force + force;
    to.moment = to.moment + cross(Vec(kept_.shape.position()[k]), force);
    for (std::size_t g = 0; g < functions; ++g) {
      to.unknown[g] = to.unknown[g] + slopes[g].back(force);
    }
  }
  /// Adds the derivative of a force at point k along an unknown, and that of its work.
  void add_column(int k, std::size_t unknown, const Vec& change, const Vec& force,
                  Columns& to) const {
    const Vec p = kept_.shape.position()[k], slope = slope_of(unknown)[k];
    Column& column = to.x[unknown / 3];
    const std::size_t own = unknown % 3;
    add_to_column(column.force, own, change);
    add_to_column(column.moment, own, cross(p, change) + pos_ * cross(slope, force));
    for (std::size_t g = 0; g < functions; ++g) {
      const auto felt = [&](std::size_t l) {
        return dot(Vec(slope_of(l)[k]), change) +
               pos_ * dot(Vec(curvature_[unknown][l][k]), force);
      };
      add_to_column(column.own[g], own, {felt(3 * g), felt(3 * g + 1), felt(3 * g + 2)});
    }
  }

  /// Inertia and drag, by the unknowns and by the state of the start.
  void inertial(Columns& to) const {
    const Vec &omega = kept_.omega, &alpha = kept_.alpha;
    ElementSums<T, functions> sums{};
    to.force = to.moment = Vec{};
    for (Vec& x : to.unknown) x = Vec{};
    for (int k = 0; k < kernel_.points(); ++k) {
      const T weight = kernel_.rule().weight(k) * m_.length;
      const Vec force = weight * Kind::inertial(m_, kept_, k);
      add_force(k, force, to);
      const T mass = weight * m_.density, drag = weight * m_.drag;
      for (std::size_t unknown = 0; unknown < dofs; ++unknown) {
        const Vec slope = slope_of(unknown)[k], bent = velocity_[unknown][k];
        const Vec carried = cross(omega, slope);
        const Vec change =
            mass * (acc_ * slope + (T(2) * vel_) * (carried + bent) +
                    pos_ * (cross(alpha, slope) + cross(omega, carried + T(2) * bent) +
                            Vec(acceleration_[unknown][k]))) +
            drag * (vel_ * slope + pos_ * (carried + bent));
        add_column(k, unknown, change, force, to);
      }
      add_up(k, weight, sums);
    }
    Inertia::add(m_, {kept_.v, omega, kept_.a, alpha}, sums, to);
  }
  void add_up(int k, const T& weight, ElementSums<T, functions>& sums) const {
    const Vec p = kept_.shape.position()[k], u = kept_.moving[k], wp = weight * p;
    const Vec& omega = kept_.omega;
    sums.one += weight;
    sums.first = sums.first + wp;
    sums.second = sums.second + Symmetric3<T>{wp.x * p.x, wp.y * p.y, wp.z * p.z,
                                              wp.x * p.y, wp.x * p.z, wp.y * p.z};
    sums.moved = sums.moved + weight * u;
    sums.moving = sums.moving + dyad(u, wp);
    const T along = dot(p, omega);
    for (std::size_t unknown = 0; unknown < dofs; ++unknown) {
      const Vec d = slope_of(unknown)[k], wd = weight * d;
      const std::size_t g = unknown / 3, row = unknown % 3;
      sums.momentum[g].row[row] = sums.momentum[g].row[row] + wd;
      sums.spin[g].row[row] = sums.spin[g].row[row] + cross(p, wd);
      sums.convective[g].row[row] =
          sums.convective[g].row[row] +
          weight * (dot(d, omega) * p + along * d - (T(2) * dot(d, p)) * omega +
                    T(2) * cross(u, d));
    }
  }

  /// Adds the wrench on the tip, which turns with the tip and acts on a changing lever.
  void take_tip(const Hanging& hanging, Columns& to) const {
    const Vec force = kept_.rotation * hanging.force,
              moment = kept_.rotation * hanging.moment, &p = kept_.position;
    to.force = to.force + force;
    to.moment = to.moment + moment + cross(p, force);
    for (std::size_t g = 0; g < functions; ++g) {
      to.unknown[g] =
          to.unknown[g] + kept_.slope[g].back(force) + kept_.turn[g].back(moment);
    }
    for (std::size_t k = 0; k < dofs; ++k) {
      const Vec theta = pos_ * turn_of(k).tip;
      const Vec d_force = cross(theta, force), d_moment = cross(theta, moment);
      Column& column = to.x[k / 3];
      const std::size_t own = k % 3;
      add_to_column(column.force, own, d_force);
      add_to_column(column.moment, own,
                    cross(p, d_force) + pos_ * cross(slope_of(k).tip, force) + d_moment);
      const Unknowns back = kept_.shape.turn_back(static_cast<int>(k), moment);
      const Vec* const by_turn[functions] = {&back.mean, &back.half};
      for (std::size_t g = 0; g < functions; ++g) {
        const auto bent = [&](std::size_t l) { return dot(curvature_[k][l].tip, force); };
        add_to_column(column.own[g], own,
                      kept_.slope[g].back(d_force) + kept_.turn[g].back(d_moment) +
                          pos_ * (Vec{bent(3 * g), bent(3 * g + 1), bent(3 * g + 2)} +
                                  *by_turn[g]));
      }
    }
  }

  const Kernel& kernel_;
  const Material& m_;
  T acc_, vel_, pos_;
  const Unknowns &v_, &a_;
  const typename Kind::Kept& kept_;
  Directions velocity_, acceleration_;  // dP'/dq_k, dP''/dq_k
  std::array<Directions, dofs> curvature_;
  typename Clothoid::TipTurns tips_;
};

}  // namespace tress::models
