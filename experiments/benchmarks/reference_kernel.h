#pragma once

#include <cmath>
#include <cstddef>

/// Reference kernel for the timing of batches: times that depend on the machine are
/// published as multiples of this kernel's, measured in the same process. It takes one
/// step of linearly_implicit_euler of four straight or curled super-helices in SIMD
/// lanes, under gravity, with roots at rest, as fast as we know. Elements are short
/// enough for series of 8 terms. It shares no code with the library, so that a change
/// there does not change the reference; do not improve it.
///
/// The recursion is [Featherstone 1983] over spatial accelerations relative to the
/// velocity-dependent ones of each element's tip. All nine numbers of a matrix stay in
/// registers.
namespace tress::experiments::benchmarks::reference {

using Real __attribute__((vector_size(32))) = double;  // four strands
constexpr int lanes = 4;

struct Vec {
  Real x, y, z;
};
struct Matrix {
  Real m[3][3];
};

[[gnu::always_inline]] inline Real all(double x) { return Real{} + x; }
[[gnu::always_inline]] inline Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline Vec operator-(Vec a, Vec b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline Vec operator*(Real s, Vec a) {
  return {s * a.x, s * a.y, s * a.z};
}
[[gnu::always_inline]] inline Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[gnu::always_inline]] inline Real dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix c;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
      c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    }
  }
  return c;
}
[[gnu::always_inline]] inline Matrix operator+(Matrix a, const Matrix& b) {
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) a.m[i][j] += b.m[i][j];
  }
  return a;
}
[[gnu::always_inline]] inline Matrix transposed(const Matrix& a) {
  Matrix t;
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) t.m[i][j] = a.m[j][i];
  }
  return t;
}
[[gnu::always_inline]] inline Vec operator*(const Matrix& a, Vec v) {
  return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z,
          a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
          a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}
[[gnu::always_inline]] inline Vec back(const Matrix& a, Vec v) {
  return {a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z,
          a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
          a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z};
}

constexpr double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }
/// Coefficient k of S, A, B, A1, B1, A2, B2 (f = 0 ... 6) over their power of s: see
/// math/helix.h.
constexpr double coefficient(int f, int k) {
  return f < 3 ? (k % 2 == 0 ? 1.0 : -1.0) / factorial(2 * k + 1 + f)
               : 2 * (k + 1) * coefficient(f - 2, k + 1);
}
template <int f, int k = 0>
[[gnu::always_inline]] inline Real series(Real x) {
  constexpr double c = coefficient(f, k);
  if constexpr (k == 7) {
    return all(c);
  } else {
    return series<f, k + 1>(x) * x + all(c);
  }
}

struct Place {
  Vec position, velocity, acceleration;  // at kappa'' = 0
  Matrix slope;
};
struct Turn {
  Matrix rotation, turn;
  Vec velocity, acceleration;
};

[[gnu::always_inline]] inline Place place(Vec k, Vec v, double s) {
  const Real zero = all(0), x = all(s * s) * dot(k, k);
  const double s2 = s * s, s3 = s2 * s;
  const Real a = series<1>(x) * all(s2), b = series<2>(x) * all(s3),
             a1 = series<3>(x) * all(s2 * s2), b1 = series<4>(x) * all(s2 * s3),
             a2 = series<5>(x) * all(s3 * s3), b2 = series<6>(x) * all(s3 * s2 * s2);
  const Vec u{zero, k.z, -k.y}, z{-(k.y * k.y + k.z * k.z), k.x * k.y, k.x * k.z};
  const Vec r = a1 * u + b1 * z;
  const Vec c0 = b * Vec{zero, -u.z, u.y} + k.x * r;
  const Vec y1{zero, zero, all(-1)}, y2{zero, all(1), zero};
  const Vec c1 = a * y1 + b * (Vec{u.z, zero, zero} + cross(k, y1)) + k.y * r;
  const Vec c2 = a * y2 + b * (Vec{-u.y, zero, zero} + cross(k, y2)) + k.z * r;
  Place p;
  p.position = {all(s) + b * z.x, a * u.y + b * z.y, a * u.z + b * z.z};
  p.slope = {{{c0.x, c1.x, c2.x}, {c0.y, c1.y, c2.y}, {c0.z, c1.z, c2.z}}};
  p.velocity = p.slope * v;
  const Real kv = dot(k, v), vv = dot(v, v);
  const Vec du{zero, v.z, -v.y}, dz = cross(v, u) + cross(k, du);
  p.acceleration = (a2 * kv * kv + a1 * vv) * u + (all(2) * a1 * kv) * du +
                   (b2 * kv * kv + b1 * vv) * z + (all(2) * b1 * kv) * dz +
                   b * (all(2) * cross(v, du));
  return p;
}

[[gnu::always_inline]] inline Matrix of_cross(Vec k, Real n, Real a, Real b, Real c) {
  const Real xy = c * (k.x * k.y), xz = c * (k.x * k.z), yz = c * (k.y * k.z);
  return {{{a + c * (k.x * k.x - n), xy - b * k.z, xz + b * k.y},
           {xy + b * k.z, a + c * (k.y * k.y - n), yz - b * k.x},
           {xz - b * k.y, yz + b * k.x, a + c * (k.z * k.z - n)}}};
}
[[gnu::always_inline]] inline Turn turn(Vec k, Vec v, double s) {
  const Real n = dot(k, k), x = all(s * s) * n;
  const double s2 = s * s, s3 = s2 * s;
  const Real sine = series<0>(x) * all(s), a = series<1>(x) * all(s2),
             b = series<2>(x) * all(s3), a1 = series<3>(x) * all(s2 * s2),
             b1 = series<4>(x) * all(s2 * s3);
  Turn t;
  t.rotation = of_cross(k, n, all(1), sine, a);
  t.turn = of_cross(k, n, all(s), a, b);
  t.velocity = t.turn * v;
  const Real kv = dot(k, v);
  const Vec kxv = cross(k, v);
  t.acceleration = (a1 * kv) * kxv + (b1 * kv) * cross(k, kxv) + b * cross(v, kxv);
  return t;
}

/// A strand in consistent units.
struct Strand {
  int elements;
  double length;  // of an element
  double density, twist, bend, friction, gravity, step;
};
struct State {
  Vec k, rate, rest;  // of an element
};
struct Record {
  Matrix inverse, of_force, of_moment, rotation, slope, turn;
  Vec unknown, position, linear, angular, omega, gravity;
};

inline void step(const Strand& q, State* state, Record* records) {
  constexpr double at[4] = {0.069431844202973714, 0.33000947820757187,
                            0.66999052179242813, 0.93056815579702623};
  constexpr double weights[4] = {0.17392742256872693, 0.32607257743127307,
                                 0.32607257743127307, 0.17392742256872693};
  const Real zero = all(0);
  Vec omega{zero, zero, zero}, gravity{zero, zero, all(-q.gravity)};
  for (int i = 0; i < q.elements; ++i) {
    Record& r = records[i];
    r.omega = omega;
    r.gravity = gravity;
    const Place p = place(state[i].k, state[i].rate, q.length);
    const Turn t = turn(state[i].k, state[i].rate, q.length);
    r.position = p.position;
    r.slope = p.slope;
    r.rotation = t.rotation;
    r.turn = t.turn;
    r.linear = cross(omega, cross(omega, p.position)) +
               all(2) * cross(omega, p.velocity) + p.acceleration;
    r.angular = cross(omega, t.velocity) + t.acceleration;
    omega = back(t.rotation, omega + t.velocity);
    gravity = back(t.rotation, gravity);
  }
  Matrix ll0{}, la0{}, aa0{};
  Vec force{zero, zero, zero}, moment{zero, zero, zero};
  for (int i = q.elements - 1; i >= 0; --i) {
    Record& r = records[i];
    const Vec k = state[i].k, v = state[i].rate;
    Real mass = zero, xx = zero, yy = zero, zz = zero, xy = zero, xz = zero, yz = zero;
    Vec first{zero, zero, zero}, f_sum = first, t_sum = first, k_sum = first;
    Matrix momentum{}, spin{}, inner{};
#pragma GCC unroll 4
    for (int n = 0; n < 4; ++n) {
      const Place p = place(k, v, at[n] * q.length);
      const Real m = all(q.density * weights[n] * q.length);
      const Vec f =
          m * (r.gravity - (cross(r.omega, cross(r.omega, p.position)) +
                            all(2) * cross(r.omega, p.velocity) + p.acceleration));
      const Vec mp = m * p.position;
      mass += m;
      first = first + mp;
      xx += mp.x * p.position.x;
      yy += mp.y * p.position.y;
      zz += mp.z * p.position.z;
      xy += mp.x * p.position.y;
      xz += mp.x * p.position.z;
      yz += mp.y * p.position.z;
      f_sum = f_sum + f;
      t_sum = t_sum + cross(p.position, f);
      k_sum = k_sum + back(p.slope, f);
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        const Vec mc = m * Vec{p.slope.m[0][a], p.slope.m[1][a], p.slope.m[2][a]};
        const Vec t = cross(p.position, mc);
        momentum.m[0][a] += mc.x;
        momentum.m[1][a] += mc.y;
        momentum.m[2][a] += mc.z;
        spin.m[0][a] += t.x;
        spin.m[1][a] += t.y;
        spin.m[2][a] += t.z;
#pragma GCC unroll 3
        for (int b = a; b < 3; ++b) {
          inner.m[a][b] +=
              mc.x * p.slope.m[0][b] + mc.y * p.slope.m[1][b] + mc.z * p.slope.m[2][b];
        }
      }
    }
    const Matrix rt = transposed(r.rotation);
    const Matrix ll = r.rotation * ll0 * rt, la = r.rotation * la0 * rt,
                 aa = r.rotation * aa0 * rt, al = transposed(la);
    const Vec f1 = r.rotation * force - (ll * r.linear + la * r.angular),
              t1 = r.rotation * moment - (al * r.linear + aa * r.angular);
    const Vec& x = r.position;
    const Matrix arm = {{{zero, x.z, -x.y}, {-x.z, zero, x.x}, {x.y, -x.x, zero}}};
    const Matrix lw = ll * arm + la, aw = al * arm + aa, lk = ll * r.slope + la * r.turn,
                 ak = al * r.slope + aa * r.turn;
    const Matrix lever = transposed(arm);
    Matrix hww = lever * lw + aw, hwk = lever * lk + ak + spin,
           hkk = transposed(r.slope) * lk + transposed(r.turn) * ak;
    Matrix hll = ll, hlw = lw;
    const Matrix hlk = lk + momentum;
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      hll.m[a][a] += mass;
#pragma GCC unroll 3
      for (int b = a; b < 3; ++b) hkk.m[a][b] += inner.m[a][b];
    }
    hlw.m[0][1] += first.z;
    hlw.m[0][2] -= first.y;
    hlw.m[1][0] -= first.z;
    hlw.m[1][2] += first.x;
    hlw.m[2][0] += first.y;
    hlw.m[2][1] -= first.x;
    hww.m[0][0] += yy + zz;
    hww.m[1][1] += xx + zz;
    hww.m[2][2] += xx + yy;
    hww.m[0][1] -= xy;
    hww.m[1][0] -= xy;
    hww.m[0][2] -= xz;
    hww.m[2][0] -= xz;
    hww.m[1][2] -= yz;
    hww.m[2][1] -= yz;
    const double h = q.step, k0 = q.twist * q.length, k1 = q.bend * q.length,
                 c = q.friction * q.length;
    hkk.m[0][0] += all(h * h * k0 + h * c);
    hkk.m[1][1] += all(h * h * k1 + h * c);
    hkk.m[2][2] += all(h * h * k1 + h * c);
    const Vec strain = k - state[i].rest + all(h) * v;
    Vec own = k_sum + back(r.slope, f1) + back(r.turn, t1);
    own.x -= all(k0) * strain.x + all(c) * v.x;
    own.y -= all(k1) * strain.y + all(c) * v.y;
    own.z -= all(k1) * strain.z + all(c) * v.z;
    const Real m00 = hkk.m[0][0], m01 = hkk.m[0][1], m02 = hkk.m[0][2], m11 = hkk.m[1][1],
               m12 = hkk.m[1][2], m22 = hkk.m[2][2];
    const Real i0 = m11 * m22 - m12 * m12, i1 = m02 * m12 - m01 * m22,
               i2 = m01 * m12 - m02 * m11;
    const Real by = all(1) / (m00 * i0 + m01 * i1 + m02 * i2);
    const Real i12 = (m01 * m02 - m00 * m12) * by;
    r.inverse = {{{i0 * by, i1 * by, i2 * by},
                  {i1 * by, (m00 * m22 - m02 * m02) * by, i12},
                  {i2 * by, i12, (m00 * m11 - m01 * m01) * by}}};
    r.of_force = transposed(hlk);
    r.of_moment = transposed(hwk);
    r.unknown = own;
    const Matrix gl = hlk * r.inverse, gw = hwk * r.inverse;
    const Matrix s1 = gl * r.of_force, s2 = gl * r.of_moment, s3 = gw * r.of_moment;
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
#pragma GCC unroll 3
      for (int b = 0; b < 3; ++b) {
        ll0.m[a][b] = hll.m[a][b] - s1.m[a][b];
        la0.m[a][b] = hlw.m[a][b] - s2.m[a][b];
        aa0.m[a][b] = hww.m[a][b] - s3.m[a][b];
      }
    }
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
#pragma GCC unroll 2
      for (int b = 0; b < a; ++b) {
        ll0.m[a][b] = ll0.m[b][a] = all(0.5) * (ll0.m[a][b] + ll0.m[b][a]);
        aa0.m[a][b] = aa0.m[b][a] = all(0.5) * (aa0.m[a][b] + aa0.m[b][a]);
      }
    }
    force = f_sum + f1 - gl * own;
    moment = t_sum + t1 + cross(x, f1) - gw * own;
  }
  Vec linear{zero, zero, zero}, angular{zero, zero, zero};
  for (int i = 0; i < q.elements; ++i) {
    const Record& r = records[i];
    const Vec a = r.inverse * (r.unknown - (r.of_force * linear + r.of_moment * angular));
    const Vec l = linear + cross(angular, r.position) + r.slope * a + r.linear,
              w = angular + r.turn * a + r.angular;
    linear = back(r.rotation, l);
    angular = back(r.rotation, w);
    state[i].rate = state[i].rate + all(q.step) * a;
    state[i].k = state[i].k + all(q.step) * state[i].rate;
  }
}

}  // namespace tress::experiments::benchmarks::reference
