#pragma once

#include <array>

#include "math/lanes.h"

namespace tress {

/// The scalar functions of s and X = |kappa|^2 that describe a helix (w = |kappa|):
///
///     S = sin(ws)/w,  A = (1 - cos ws)/w^2,  B = (ws - sin ws)/w^3
///     A1 = A'(w)/w,  A2 = A1'(w)/w,  A3 = A2'(w)/w,  and the same for B
///
/// All are even in w, so the derivatives with respect to kappa are dA = A1 (kappa .
/// dkappa) and so on.
///
/// They are the powers s^1, s^2, ..., s^9 times functions of ws, which at w = 0 are 1,
/// 1/2, 1/6, -1/12, -1/60, 1/90, 1/630, -1/840, -1/7560.
template <class T>
struct HelixFunctions {
  T S, A, B, A1, B1, A2, B2, A3, B3;  // values of the functions above

  /// All functions, in the order in which they are computed.
  static constexpr T HelixFunctions::*all[] = {
      &HelixFunctions::S,  &HelixFunctions::A,  &HelixFunctions::B,
      &HelixFunctions::A1, &HelixFunctions::B1, &HelixFunctions::A2,
      &HelixFunctions::B2, &HelixFunctions::A3, &HelixFunctions::B3};
};

/// Sets one lane of all functions.
template <class T>
void set_lane(HelixFunctions<T>& to, int lane, const HelixFunctions<double>& f) {
  for (std::size_t i = 0; i < std::size(HelixFunctions<T>::all); ++i) {
    set_lane(to.*HelixFunctions<T>::all[i], lane, f.*HelixFunctions<double>::all[i]);
  }
}

namespace helix {

/// Taylor coefficients in X = (ws)^2 of the m-th derivative (1/w d/dw)^m of sum (-X)^k /
/// (2k + p)!, divided by its power of s. Each derivative maps c_k to 2 (k + 1) c_{k+1}.
template <int p, int m, int terms>
constexpr std::array<double, terms> taylor() {
  std::array<double, terms> c{};
  for (int k = 0; k < terms; ++k) {
    long double ck = (k + m) % 2 == 0 ? 1 : -1;
    for (int j = 1; j <= 2 * (k + m) + p; ++j) ck /= j;
    for (int j = 1; j <= m; ++j) ck *= 2 * (k + j);
    c[static_cast<std::size_t>(k)] = static_cast<double>(ck);
  }
  return c;
}

/// Evaluates the first `terms` terms of the Taylor series `taylor` in x.
template <int p, int m, int terms, class T>
T taylor_sum(const T& x) {
  static constexpr std::array<double, terms> c = taylor<p, m, terms>();
  T y = c[terms - 1];
  for (std::size_t k = terms - 1; k-- > 0;) y = y * x + c[k];
  return y;
}

/// Taylor series give b = B/s^3, its derivatives and A3/s^8. The others follow without
/// cancellation from the m-th derivatives of w^2 B = s - S and w B' + 3 B = s A.
///     S = s - w^2 B,  s A = 3 B + w^2 B1,  s A1 = 5 B1 + w^2 B2,  s A2 = 7 B2 + w^2 B3
/// This function is always inlined. Other sources may be compiled with other products
/// fused, and the linker would keep one version for all.
template <int terms, class T, class X>
[[gnu::always_inline]] inline HelixFunctions<T> series(const T& s, const X& x2) {
  const T ss = s * s;
  const T x = x2 * ss;
  const T b = taylor_sum<3, 0, terms>(x);
  const T b1 = taylor_sum<3, 1, terms>(x);
  const T b2 = taylor_sum<3, 2, terms>(x);
  const T b3 = taylor_sum<3, 3, terms>(x);
  const T a3 = taylor_sum<2, 3, terms>(x);
  const T s3 = s * ss, s4 = ss * ss, s5 = s3 * ss, s6 = s3 * s3;
  const T s7 = s4 * s3, s8 = s4 * s4, s9 = s5 * s4;
  return {.S = s * (1.0 - x * b),
          .A = ss * (3.0 * b + x * b1),
          .B = s3 * b,
          .A1 = s4 * (5.0 * b1 + x * b2),
          .B1 = s5 * b1,
          .A2 = s6 * (7.0 * b2 + x * b3),
          .B2 = s7 * b2,
          .A3 = s8 * a3,
          .B3 = s9 * b3};
}

/// Closed forms for one s; accurate for ws >= 3, approximately.
HelixFunctions<double> closed_forms(double s, double x2) noexcept;

/// Computes the functions from the sine and cosine of half = ws/2. S and A follow from
/// the half angle, free of cancellation. The others are successive derivatives of w^2 A =
/// 1 - cos ws and w^2 B = s - S, with S'(w)/w = B - s A:
///
///     w^2 A1 = s S - 2 A,  w^2 A2 = s S1 - 4 A1,  w^2 A3 = s S2 - 6 A2
///     w^2 B1 = -S1 - 2 B,  w^2 B2 = -S2 - 4 B1,   w^2 B3 = -S3 - 6 B2
///     S1 = B - s A, S2 = B1 - s A1, S3 = B2 - s A2
inline HelixFunctions<double> closed_forms(double s, double x2, double half, double sine,
                                           double cosine) noexcept {
  const double over = 1 / x2;
  HelixFunctions<double> f;
  f.S = s * (sine * cosine / half);
  f.A = 2 * sine * sine * over;
  f.B = (s - f.S) * over;
  const double S1 = f.B - s * f.A;
  f.A1 = (s * f.S - 2 * f.A) * over;
  f.B1 = -(S1 + 2 * f.B) * over;
  const double S2 = f.B1 - s * f.A1;
  f.A2 = (s * S1 - 4 * f.A1) * over;
  f.B2 = -(S2 + 4 * f.B1) * over;
  const double S3 = f.B2 - s * f.A2;
  f.A3 = (s * S2 - 6 * f.A2) * over;
  f.B3 = -(S3 + 6 * f.B2) * over;
  return f;
}

// Five terms truncate less than eps / 8 of the value up to ws = 0.17 (3!/13! X^5 for B,
// the worst case), nine less than eps up to 1.5, sixteen up to 4.5, where the alternating
// sums lose 4 bits; beyond, the closed forms are more accurate.
/// Bound of X = (ws)^2 up to which five terms of the series are enough.
inline constexpr double nearly_straight = 0.17 * 0.17;
inline constexpr double short_end = 1.5 * 1.5;  // as X = (ws)^2
/// Bound of X up to which sixteen terms are more accurate than the closed forms.
inline constexpr double long_end = 4.5 * 4.5;

/// Computes the functions of one helix by the method for its X.
inline HelixFunctions<double> one_by_one(double s, double x2) noexcept {
  return x2 * (s * s) <= long_end ? series<16>(s, x2) : closed_forms(s, x2);
}

/// Computes the functions lane by lane, each by the method for its own X.
template <class X>
HelixFunctions<Pack> one_by_one(const Pack& s, const X& x2) noexcept {
  HelixFunctions<Pack> all;
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    set_lane(all, lane, one_by_one(s[lane], lane_of(x2, lane)));
  }
  return all;
}

}  // namespace helix

/// Computes the functions for T = double or Pack. x2 = |kappa|^2 is one number per
/// element, or one per lane. `longest` is the largest |s| of the element, so that all its
/// points, and all elements of a pack, take the same branch.
///
/// Error bounds for given x2, eps = 2^-52: 8 eps relative for ws <= 2. Beyond ws = 2 the
/// functions have zeros. There errors are relative to the size of the oscillation
/// s^p/(ws)^m, or to the value at w = 0 where that is smaller. The exponents are m = 1,
/// 2, 2, 3, 4, 4, 5, 5, 6. The bound is 15 eps up to ws = 4.5, then 20 eps, then ws eps,
/// as ws itself is rounded; 1e-14 up to ws = 50. Cost: one of four paths, chosen by w
/// longest. They are branch-free power series up to 0.17, 1.5 and 4.5 (a full turn is
/// 6.3), and evaluation lane by lane beyond.
template <class T, class X>
HelixFunctions<T> helix_functions(const T& s, const X& x2, const X& longest) noexcept {
  const double x = largest(x2 * (longest * longest));
  if (x <= helix::nearly_straight) return helix::series<5>(s, x2);
  if (x <= helix::short_end) return helix::series<9>(s, x2);
  if (x <= helix::long_end) return helix::series<16>(s, x2);
  return helix::one_by_one(s, x2);
}

}  // namespace tress
