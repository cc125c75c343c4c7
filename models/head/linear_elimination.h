#pragma once

#include <array>
#include <cstddef>

#include "models/head/point_loads.h"
#include "models/head/reduced_parts.h"
#include "models/strand/strain.h"

/// Elements of two times three unknowns: means and half differences.
namespace tress::models {

/// Matrices of the means, then of the halves. The derivatives d_k of a point along the
/// unknowns are their columns.
template <class T>
using OfBoth = std::array<Matrix3<T>, 2>;

/// Inertia of an element before its unknowns are eliminated (UneliminatedInertia).
template <class T>
struct LinearInertia {
  ArticulatedInertia<T> sum;         // inertia at fixed unknowns
  std::array<Symmetric3<T>, 2> own;  // H_kk of means, and of halves
  Matrix3<T> mixed;                  // H_kk of means (rows) and halves
  OfBoth<T> of_force, of_moment;     // rows k
};

/// Sums of d_k . B d_l over points, by blocks of means and halves.
template <class T>
struct LinearMoments {
  std::array<Symmetric3<T>, 2> inner;  // of means, of halves
  Matrix3<T> mixed;                    // of means (rows) and halves

  /// Adds a point with the derivatives d, B d given.
  void add(const OfBoth<T>& d, const OfBoth<T>& b_d) {
    for (std::size_t f = 0; f < 2; ++f) {
      inner[f] = inner[f] + upper(d[f].transposed(), b_d[f].transposed());
    }
    mixed = mixed + d[0].transposed() * b_d[1];
  }
};

/// Sums of loads over an element (LoadSums).
template <class T>
struct LinearLoadSums : RigidLoadSums<T> {
  LinearStrainOf<T> unknown;      // sum of d^T f
  LinearMoments<T> moments;       // sums of d^T B d
  OfBoth<T> of_force, of_moment;  // rows j: sum B d_j, sum P x B d_j

  /// Adds the terms of the unknowns, which move the point by d, to add_force().
  void add_force_of_unknowns(const OfBoth<T>& d, const Vec3<T>& f) {
    unknown.mean = unknown.mean + d[0].back(f);
    unknown.half = unknown.half + d[1].back(f);
  }
  /// Adds the terms of the unknowns, which move the point by d, to add_block().
  void add_block_of_unknowns(const Vec3<T>& p, const OfBoth<T>& d,
                             const Symmetric3<T>& block) {
    const OfBoth<T> b_d{block * d[0], block * d[1]};
    for (std::size_t f = 0; f < 2; ++f) {
      of_force[f] = of_force[f] + b_d[f].transposed();
      of_moment[f] = of_moment[f] + cross_times(p, b_d[f]).transposed();
    }
    moments.add(d, b_d);
  }
};

/// Sums over the points of an element: the wrench of inertia and drag about the start,
/// its work on the unknowns, and moments of length w.
template <class T>
struct LinearSums {
  Vec3<T> force, moment;      // of inertia and drag
  LinearStrainOf<T> unknown;  // their work
  T one{};                    // sum of w
  Vec3<T> first;              // sum of w P
  Symmetric3<T> second;       // sum of w P P^T
  OfBoth<T> momentum, spin;   // rows k: sum of w d_k, of w P x d_k
  LinearMoments<T> moments;   // sums of w d_k . d_l

  /// Adds a force on a point at p that the unknowns move by d.
  void add_force(const Vec3<T>& p, const OfBoth<T>& d, const Vec3<T>& f) {
    force = force + f;
    moment = moment + cross(p, f);
    unknown.mean = unknown.mean + d[0].back(f);
    unknown.half = unknown.half + d[1].back(f);
  }
  /// Adds the moments of a point of weight w at p that the unknowns move by d.
  void add_moments(const T& w, const Vec3<T>& p, const OfBoth<T>& d) {
    const Vec3<T> wp = w * p;
    one += w;
    first = first + wp;
    second = second + Symmetric3<T>{wp.x * p.x, wp.y * p.y, wp.z * p.z,
                                    wp.x * p.y, wp.x * p.z, wp.y * p.z};
    const OfBoth<T> w_d{w * d[0], w * d[1]};
    for (std::size_t f = 0; f < 2; ++f) {
      momentum[f] = momentum[f] + w_d[f].transposed();
      spin[f] = spin[f] + cross_times(p, w_d[f]).transposed();
    }
    moments.add(d, w_d);
  }
};

/// Factors of an element's elimination: the means first, then the halves without them.
template <class T>
struct LinearFactors {
  std::array<Symmetric3<T>, 2> pivot;  // inverse, of each
  Matrix3<T> across;                   // P_mean H_mean,half
  OfBoth<T> of_force, of_moment;       // rows k
  LinearStrainOf<T> unknown;           // were the start to stay

  /// Returns the articulated inertia without the unknowns, to whose diagonal in S it adds
  /// `tangent`.
  ArticulatedInertia<T> eliminate(const LinearStrainOf<T>& tangent, bool twist,
                                  const LinearInertia<T>& from) {
    of_force = from.of_force;
    of_moment = from.of_moment;
    pivot[0] = inverse_of_modes(with(from.own[0], tangent.mean), twist);
    across = pivot[0] * from.mixed;
    const Matrix3<T> back = across.transposed();
    pivot[1] = inverse_of_modes(
        with(from.own[1], tangent.half) - upper(back, from.mixed.transposed()), twist);
    of_force[1] = of_force[1] - back * of_force[0];
    of_moment[1] = of_moment[1] - back * of_moment[0];
    ArticulatedInertia<T> left = from.sum;
    for (std::size_t f = 0; f < 2; ++f) {
      const Matrix3<T> z_l = pivot[f] * of_force[f], z_a = pivot[f] * of_moment[f];
      const Matrix3<T> by_force = of_force[f].transposed(),
                       by_moment = of_moment[f].transposed();
      left = {left.ll - upper(by_force, z_l.transposed()),
              left.aa - upper(by_moment, z_a.transposed()), left.la - by_force * z_a};
    }
    return left;
  }
  /// Eliminates the unknowns from the wrench on the start. `b`: right side of the
  /// unknowns.
  void reduce(const LinearStrainOf<T>& b, WrenchOf<T>& wrench) {
    unknown.mean = pivot[0] * b.mean;
    unknown.half = pivot[1] * (b.half - across.back(b.mean));
    wrench.force =
        wrench.force + of_force[0].back(unknown.mean) + of_force[1].back(unknown.half);
    wrench.moment =
        wrench.moment + of_moment[0].back(unknown.mean) + of_moment[1].back(unknown.half);
  }
  /// Returns the unknowns where the accelerations of the start change by l and a.
  LinearStrainOf<T> unknowns(const Vec3<T>& l, const Vec3<T>& a) const {
    const auto left = [&](std::size_t f, const Vec3<T>& own) {
      return own - pivot[f] * (of_force[f] * l + of_moment[f] * a);
    };
    LinearStrainOf<T> own;
    own.half = left(1, unknown.half);
    own.mean = left(0, unknown.mean) - across * own.half;
    return own;
  }

 private:
  static Symmetric3<T> with(Symmetric3<T> m, const Vec3<T>& diagonal) {
    m.xx += diagonal.x;
    m.yy += diagonal.y;
    m.zz += diagonal.z;
    return m;
  }
};

}  // namespace tress::models
