#pragma once

#include <array>

#include "models/maximal/kernel/algebra.h"
#include "models/maximal/kernel/spring_joint.h"

namespace tress::models {

/// Data of an edge between sweeps.
template <class T>
struct SpringPlaced : SpringDirection<T> {
  Vec3<T> rate;  // of the edge, seen from the root
  Vec3<T> own;   // residual of the springs by its change (along t, m1, m2)
};
/// An edge and the joint before it, with symmetric derivatives.
template <class T>
struct SpringStiffPlaced : SpringPlaced<T> {
  T along, across;  // stiffness against it: by stretching
  /// Stiffness of the joint.
  TurnForm<T> before,
      after;      // of the joint before it: by the turns of the edge before and its
  T mixed[2][2];  // [before][after]
};
/// Derivatives of the springs' residuals, rows and columns along t, m1, m2.
template <class T>
struct SpringExactPlaced : SpringPlaced<T> {
  Matrix3<T> own_by_own;  // derivatives of its residual by its own change
  // Of the moments on it by the edge before, and the other way round: their rows m1, m2.
  Vec3<T> by_before[2], on_before[2];  // rows of the joint's blocks
};

/// Elimination of an edge with a symmetric matrix. Everything beyond an edge is, after
/// it, a quadratic form of the change of its start and of the turn of the edge before,
///
///     x.A x/2 + x.C y + y.D y/2 - f.x - g.y,
///
/// 3 + 2 unknowns, where banded elimination over nodes keeps 6. The stiffness along an
/// edge, 1e5 times the others, enters one pivot and no sum.
template <class T>
struct SpringStiffElimination {
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Quadratic form of two turns.
  using Form = TurnForm<T>;
  /// Geometry and stresses at a state.
  using Placed = SpringStiffPlaced<T>;
  /// Factors of an edge.
  struct Factor {
    Vec along, one, two;  // A Y + C: forces by changes of the edge
    Vec left1, left2;     // of the turns' forces once the length has answered
    T by_along, w1, w2;   // pivots, and what is left of the turns
    Form turns;           // pivots of the turns
    Vec own;              // change by the residual
  };
  /// A, C, D of everything beyond an edge; before eliminate() with the inertia and load
  /// of the node at its end.
  struct Beyond {
    Symmetric3<T> of_x{};  // block A
    Vec c1{}, c2{};        // columns of C
    Form of_y{};           // block D

    /// Adds the mass of the node at the edge's end.
    void add_inertia(const T& mass) {
      of_x.xx += mass;
      of_x.yy += mass;
      of_x.zz += mass;
    }
    /// Adds the derivatives of loads on that node.
    void add_block(const Symmetric3<T>& of_load) { of_x = of_x + of_load; }
  };
  /// f, g.
  struct Right {
    Vec f{};         // force on the start
    T g1{0}, g2{0};  // moments on the edge before
  };

  /// Eliminates an edge with all that follows.
  template <class Pivots>
  static void eliminate(const Placed& e, bool first, Beyond& beyond, Factor& factor,
                        Pivots&& pivots) {
    Symmetric3<T>& of_x = beyond.of_x;
    Vec &c1 = beyond.c1, &c2 = beyond.c2;
    Form& of_y = beyond.of_y;
    const Vec &t = e.frame.e0, &m1 = e.frame.e1, &m2 = e.frame.e2;
    const Vec one = of_x * m1, two = of_x * m2;
    factor.along = of_x * t;
    factor.one = one + c1;
    factor.two = two + c2;
    const T pivot = dot(t, factor.along) + e.along;
    const T mixed1 = dot(t, factor.one), mixed2 = dot(t, factor.two);
    const T xx = dot(m1, one) + T(2) * dot(m1, c1) + of_y.xx + e.across + e.after.xx,
            xy = dot(m1, two) + dot(m1, c2) + dot(m2, c1) + of_y.xy + e.after.xy,
            yy = dot(m2, two) + T(2) * dot(m2, c2) + of_y.yy + e.across + e.after.yy;
    factor.by_along = T(1) / pivot;
    factor.w1 = mixed1 * factor.by_along;
    factor.w2 = mixed2 * factor.by_along;
    const T p = xx - factor.w1 * mixed1, r = xy - factor.w1 * mixed2,
            s = yy - factor.w2 * mixed2;
    const T determinant = p * s - r * r;
    pivots(pivot, pivot);
    pivots(p, xx);
    pivots(determinant, p * yy);
    const T by = T(1) / determinant;
    const Form turns{s * by, -(r * by), p * by};
    factor.turns = turns;
    if (first) return;  // the root does not move
    factor.left1 = factor.one - factor.w1 * factor.along;
    factor.left2 = factor.two - factor.w2 * factor.along;
    const Vec &b1 = factor.left1, &b2 = factor.left2;
    const auto h1 = answer(turns, e.mixed[0][0], e.mixed[0][1]),
               h2 = answer(turns, e.mixed[1][0], e.mixed[1][1]);
    c1 = Vec{} - h1[0] * b1 - h1[1] * b2;
    c2 = Vec{} - h2[0] * b1 - h2[1] * b2;
    of_y = {e.before.xx - e.mixed[0][0] * h1[0] - e.mixed[0][1] * h1[1],
            e.before.xy - e.mixed[0][0] * h2[0] - e.mixed[0][1] * h2[1],
            e.before.yy - e.mixed[1][0] * h2[0] - e.mixed[1][1] * h2[1]};
    add_square(of_x, -factor.by_along, factor.along);
    add_square(of_x, -turns.xx, b1);
    add_square(of_x, -turns.yy, b2);
    add_product(of_x, T(-2) * turns.xy, b1, b2);
  }

  /// Reduces the right-hand sides of an edge, given the residuals of the node at its end
  /// and of its springs in its frame. Passes the remainder to the start and to the edge
  /// before.
  static void reduce(const Placed& e, bool first, Factor& factor, const Vec& force,
                     const Vec& springs, Right& right) {
    Vec& f = right.f;
    f = f + force;
    factor.own = {dot(e.frame.e0, f) + springs.x,
                  dot(e.frame.e1, f) + right.g1 + springs.y,
                  dot(e.frame.e2, f) + right.g2 + springs.z};
    if (first) return;
    const T p1 = factor.own.y - factor.w1 * factor.own.x,
            p2 = factor.own.z - factor.w2 * factor.own.x;
    const auto own = answer(factor.turns, p1, p2);
    f = f - (factor.by_along * factor.own.x) * factor.along - own[0] * factor.left1 -
        own[1] * factor.left2;
    right.g1 = -(e.mixed[0][0] * own[0] + e.mixed[0][1] * own[1]);
    right.g2 = -(e.mixed[1][0] * own[0] + e.mixed[1][1] * own[1]);
  }

  /// Change of an edge (along t, m1, m2) whose start moves by x, by that of the edge
  /// before, of which the first has none.
  static Vec change(const Placed& e, const Factor& factor, bool first, const Vec& x,
                    const Vec& before) {
    const T along = factor.own.x - dot(factor.along, x);
    T one = factor.own.y - dot(factor.one, x), two = factor.own.z - dot(factor.two, x);
    if (!first) {
      one = one - e.mixed[0][0] * before.y - e.mixed[1][0] * before.z;
      two = two - e.mixed[0][1] * before.y - e.mixed[1][1] * before.z;
    }
    one = one - factor.w1 * along;
    two = two - factor.w2 * along;
    const T y = factor.turns.xx * one + factor.turns.xy * two,
            z = factor.turns.xy * one + factor.turns.yy * two;
    return {factor.by_along * along - factor.w1 * y - factor.w2 * z, y, z};
  }

 private:
  static std::array<T, 2> answer(const Form& turns, const T& x, const T& y) {
    return {turns.xx * x + turns.xy * y, turns.xy * x + turns.yy * y};
  }
};

/// Elimination of an edge with second derivatives, of which those of friction are not
/// symmetric. All that follows an edge responds to a change x of its start and y of the
/// edge before with a force and a moment,
///
///     A x + C y - f,    E x + D y - g.
template <class T>
struct SpringExactElimination {
  /// Vector of these scalars.
  using Vec = Vec3<T>;
  /// Matrix of these scalars.
  using Matrix = Matrix3<T>;
  /// Geometry and stresses at a state.
  using Placed = SpringExactPlaced<T>;
  /// Factors of an edge.
  struct Factor {
    Matrix pivot;            // inverse
    Matrix of_x, of_before;  // change of the edge by both
    Matrix to_x;             // force by its change
    Vec own;                 // change by the residual
  };
  /// A, D, C, E; the first rows of D and E are 0.
  struct Beyond {
    Matrix of_x{}, of_y{}, xy{}, yx{};  // blocks of the matrix

    /// Adds the mass of the node at the edge's end.
    void add_inertia(const T& mass) {
      of_x.row[0].x += mass;
      of_x.row[1].y += mass;
      of_x.row[2].z += mass;
    }
    /// Adds the derivatives of loads on that node.
    void add_block(const Matrix& of_load) { of_x = of_x + of_load; }
  };
  /// f, g.
  struct Right {
    Vec f{}, g{};  // force on the start, moments on the edge before
  };

  /// `along`: stiffness against stretching times `pos`, the weight of positions;
  /// `tension`: with which the edge resists turns.
  template <class Pivots>
  static void eliminate(const Placed& e, bool first, const T& pos, const T& along,
                        const T& tension, Beyond& beyond, Factor& factor,
                        Pivots&& pivots) {
    Matrix &of_x = beyond.of_x, &of_y = beyond.of_y, &xy = beyond.xy, &yx = beyond.yx;
    const Matrix frame = Matrix::columns(e.frame.e0, e.frame.e1, e.frame.e2),
                 back = frame.transposed();
    factor.to_x = of_x * frame + xy;
    Matrix h = back * factor.to_x + yx * frame + of_y + e.own_by_own;
    h.row[0].x += along;
    const T pull = pos * tension * e.inverse_length;
    h.row[1].y += pull;
    h.row[2].z += pull;
    // Turns count by the length.
    const T turn1 = pos * e.inverse_length * e.own.y,
            turn2 = pos * e.inverse_length * e.own.z;
    h.row[0].y -= turn1;
    h.row[1].x -= turn1;
    h.row[0].z -= turn2;
    h.row[2].x -= turn2;
    check(h, pivots);
    factor.pivot = inverse(h);
    factor.of_x = factor.pivot * (back * of_x + yx);
    if (first) return;
    factor.of_before = dyad(factor.pivot.column(1), e.by_before[0]) +
                       dyad(factor.pivot.column(2), e.by_before[1]);
    of_x = of_x - factor.to_x * factor.of_x;
    xy = T(-1) * (factor.to_x * factor.of_before);
    for (int k = 0; k < 2; ++k) {
      yx.row[k + 1] = Vec{} - factor.of_x.back(e.on_before[k]);
      of_y.row[k + 1] = Vec{} - factor.of_before.back(e.on_before[k]);
    }
  }

  /// Eliminates the residual of an edge.
  static void reduce(const Placed& e, bool first, Factor& factor, const Vec& force,
                     const Vec& springs, Right& right) {
    right.f = right.f + force;
    factor.own = factor.pivot * (e.frame.back(right.f) + right.g + springs);
    if (first) return;
    right.f = right.f - factor.to_x * factor.own;
    right.g = {T(0), -dot(e.on_before[0], factor.own), -dot(e.on_before[1], factor.own)};
  }

  /// Returns the change of an edge.
  static Vec change(const Placed& /*e*/, const Factor& factor, bool first, const Vec& x,
                    const Vec& before) {
    const Vec own = factor.own - factor.of_x * x;
    return first ? own : own - factor.of_before * before;
  }
};

}  // namespace tress::models
