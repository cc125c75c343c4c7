#pragma once

#include "models/head/helix_element.h"

namespace tress::models {

/// Sums over the points of an element: weight w times products of the functions, and
/// forces times functions.
template <class T>
struct HelixSums {
  T one{}, s{}, A{}, B{}, A1{}, B1{};  // sums of w times one function
  T ss{}, sA{}, sB{}, sA1{}, sB1{};    // sums of w s times one function
  /// Sums of w times two functions.
  T AA{}, AB{}, BB{}, AA1{}, AB1{}, BA1{}, BB1{}, A1A1{}, A1B1{}, B1B1{};
  /// Sums of forces times one function.
  Vec3<T> force, force_s, force_A, force_B, force_A1, force_B1;

  /// Adds a point of weight w at arc length `arc`, where the functions are f.
  void add(const T& w, const T& arc, const HelixFunctions<T>& f) {
    const T with_s = w * arc, with_a = w * f.A, with_b = w * f.B, with_a1 = w * f.A1,
            with_b1 = w * f.B1;
    one += w;
    s += with_s;
    A += with_a;
    B += with_b;
    A1 += with_a1;
    B1 += with_b1;
    ss += with_s * arc;
    sA += with_s * f.A;
    sB += with_s * f.B;
    sA1 += with_s * f.A1;
    sB1 += with_s * f.B1;
    AA += with_a * f.A;
    AB += with_a * f.B;
    BB += with_b * f.B;
    AA1 += with_a * f.A1;
    AB1 += with_a * f.B1;
    BA1 += with_b * f.A1;
    BB1 += with_b * f.B1;
    A1A1 += with_a1 * f.A1;
    A1B1 += with_a1 * f.B1;
    B1B1 += with_b1 * f.B1;
  }
  /// Adds the force f_w at a point.
  void add_force(const Vec3<T>& f_w, const T& arc, const HelixFunctions<T>& f) {
    force = force + f_w;
    force_s = force_s + arc * f_w;
    force_A = force_A + f.A * f_w;
    force_B = force_B + f.B * f_w;
    force_A1 = force_A1 + f.A1 * f_w;
    force_B1 = force_B1 + f.B1 * f_w;
  }
};

/// Sums of forces times functions.
template <class T>
struct HelixForces {
  Vec3<T> s, A, B, A1, B1;  // sums of forces times one function
};
/// Moment of the forces about the start, sum P x f, and their work on the unknowns, sum
/// d_j . f with d_j = dP/dkappa_j.
template <class T>
struct HelixWork {
  Vec3<T> moment, unknown;  // sum P x f, and sum d_j . f for j = 0 to 2

  /// Computes both from the element's vectors and the sums f.
  HelixWork(const HelixElement<T>& element, const HelixForces<T>& f) {
    using Number = typename HelixElement<T>::Number;
    const Vec3<Number> e0{Number(1), Number(0), Number(0)};
    const Vec3<T>&u = element.u(), &z = element.z();
    moment = cross(e0, f.s) + cross(u, f.A) + cross(z, f.B);
    const T f_r = dot(u, f.A1) + dot(z, f.B1);
    unknown = f_r * element.k() + element.back(f.B, f.A);
  }
};

/// Moments of inertia of an element, sums over its points of weight w, with d_j =
/// dP/dkappa_j.
template <class T>
struct HelixMoments {
  Vec3<T> first;         // sum w P
  Symmetric3<T> second;  // sum w P P^T
  Matrix3<T> momentum;   // rows j: sum w d_j
  Matrix3<T> spin;       // rows j: sum w P x d_j
  Symmetric3<T> inner;   // sum w d_i . d_j

  /// Computes the moments from the element's vectors, kappa = k and the sums m.
  HelixMoments(const HelixElement<T>& element, const Vec3<T>& k, const HelixSums<T>& m) {
    using Vec = Vec3<T>;
    const Vec &u = element.u(), &z = element.z();
    const Vec e0{T(1), T(0), T(0)};
    const auto combined = [&](const T& s, const T& a, const T& b) {  // s e0 + a u + b z
      return Vec{s + b * z.x, a * u.y + b * z.y, a * u.z + b * z.z};
    };
    const auto spread = [&](const T& a, const T& b) {  // a u + b z
      return Vec{b * z.x, a * u.y + b * z.y, a * u.z + b * z.z};
    };
    first = combined(m.s, m.A, m.B);
    const Vec s_p = combined(m.ss, m.sA, m.sB), a_p = combined(m.sA, m.AA, m.AB),
              b_p = combined(m.sB, m.AB, m.BB);  // sums of w times s P, A P, B P
    // P P^T = e0 (s P)^T + u (A P)^T + z (B P)^T.
    second = {s_p.x + z.x * b_p.x, u.y * a_p.y + z.y * b_p.y, u.z * a_p.z + z.z * b_p.z,
              s_p.y + z.x * b_p.y, s_p.z + z.x * b_p.z,       u.y * a_p.z + z.y * b_p.z};
    const Vec r = spread(m.A1, m.B1);
    const Vec a_r = spread(m.AA1, m.AB1), b_r = spread(m.BA1, m.BB1);
    const Vec u_z = cross(u, z);
    // P x r.
    const Vec p_r = cross(e0, spread(m.sA1, m.sB1)) + (m.AB1 - m.BA1) * u_z;
    const T r_r = m.A1A1 * dot(u, u) + m.B1B1 * dot(z, z);  // u . z = 0
    const Vec l[3] = {
        {T(0), k.y, k.z}, {T(-2) * k.y, k.x, T(0)}, {T(-2) * k.z, T(0), k.x}};
    momentum = {{k.x * r + m.B * l[0], k.y * r + m.B * l[1], k.z * r + m.B * l[2]}};
    momentum.row[1].z -= m.A;
    momentum.row[2].y += m.A;
    spin = {{k.x * p_r + cross(b_p, l[0]), k.y * p_r + cross(b_p, l[1]),
             k.z * p_r + cross(b_p, l[2])}};
    // a_p x m_1 = a_p x -e2, a_p x m_2 = a_p x e1.
    spin.row[1] = spin.row[1] + Vec{-a_p.y, a_p.x, T(0)};
    spin.row[2] = spin.row[2] + Vec{-a_p.z, T(0), a_p.x};
    const Vec g = element.back(b_r, a_r);
    const T xx = k.x * k.x, yy = k.y * k.y, zz = k.z * k.z, xy = k.x * k.y,
            xz = k.x * k.z, yz = k.y * k.z;
    inner = {xx * r_r + T(2) * k.x * g.x + m.BB * (yy + zz),
             yy * r_r + T(2) * k.y * g.y + m.BB * (T(4) * yy + xx) + m.AA,
             zz * r_r + T(2) * k.z * g.z + m.BB * (T(4) * zz + xx) + m.AA,
             xy * (r_r + m.BB) + k.x * g.y + k.y * g.x - m.AB * k.z,
             xz * (r_r + m.BB) + k.x * g.z + k.z * g.x + m.AB * k.y,
             yz * (r_r + T(4) * m.BB) + k.y * g.z + k.z * g.y};
  }
};

}  // namespace tress::models
