#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "math/lane_choice.h"
#include "math/pack.h"

/// Elementary functions of packs in additions and multiplications only: a lane does not
/// depend on its neighbours, so results are the same bits for any number of lanes.
namespace tress {

/// 1/sqrt(x) for normal x > 0, within 2 roundings; NaN stays NaN. The guess from the
/// exponent is off by 3.4 % at most [Lomont 2003]; each of Newton's steps squares that,
/// times 3/2.
template <class Number, int width>
PackOf<Number, width> inverse_sqrt(const PackOf<Number, width>& x) {
  using T = PackOf<Number, width>;
  constexpr bool wide = sizeof(Number) == sizeof(double);
  using Whole = std::conditional_t<wide, std::int64_t, std::int32_t>;
  using Wholes __attribute__((vector_size(width * sizeof(Number)))) = Whole;
  constexpr auto guess = static_cast<Whole>(wide ? 0x5fe6eb50c7b537a9 : 0x5f375a86);
  const T half = T(0.5) * x;
  T y(reinterpret_cast<typename T::Vector>(guess - (reinterpret_cast<Wholes>(x.v) >> 1)));
  for (int step = 0; step < (wide ? 4 : 3); ++step) y = y + y * (T(0.5) - half * y * y);
  return y;
}

/// Sine and cosine of one angle.
template <class T>
struct SineCosine {
  T sine, cosine;  // the two values
};

/// Within 2^-51 (2^-22 in single precision) for |x| <= 1e4: the remainder r after
/// multiples of pi/2, |r| <= pi/4, into the Taylor series, whose first omitted term is
/// r^19/19!, 1e-19.
template <class Number, int width>
SineCosine<PackOf<Number, width>> sine_cosine(const PackOf<Number, width>& x) {
  using T = PackOf<Number, width>;
  constexpr bool wide = sizeof(Number) == sizeof(double);
  using Whole = std::conditional_t<wide, std::int64_t, std::int32_t>;
  using Wholes __attribute__((vector_size(width * sizeof(Number)))) = Whole;
  // Adding this leaves no fraction, and the integer in the last bits.
  const T rounding(wide ? 6755399441055744.0 : 12582912.0);
  const T shifted = T(0.63661977236758134) * x + rounding;
  const T turns = shifted - rounding;
  // pi/2 in parts of few enough bits that products with `turns` are exact
  // [Cody & Waite 1980].
  T r = x - turns * T(wide ? 1.5707963109016418 : 1.5703125);
  r = r - turns * T(wide ? 1.5893254712295857e-08 : 4.837512969970703125e-4);
  r = r - turns * T(wide ? 6.1232339957367660e-17 : 7.5497899548918821e-8);
  const T z = r * r;
  const auto sum = [&]<std::size_t n>(const double(&of)[n]) {
    T y(of[0]);
    for (std::size_t k = 1; k < n; ++k) y = y * z + T(of[k]);
    return y;
  };
  static constexpr double of_sine[] = {
      1 / 355687428096000.0, -1 / 1307674368000.0, 1 / 6227020800.0, -1 / 39916800.0,
      1 / 362880.0,          -1 / 5040.0,          1 / 120.0,        -1 / 6.0};
  static constexpr double of_cosine[] = {
      1 / 20922789888000.0, -1 / 87178291200.0, 1 / 479001600.0, -1 / 3628800.0,
      1 / 40320.0,          -1 / 720.0,         1 / 24.0};
  const T s = r + r * z * sum(of_sine);
  const T c = T(1) - (T(0.5) * z - z * z * sum(of_cosine));
  const Wholes quarter = reinterpret_cast<Wholes>(shifted.v);
  const auto odd = (quarter & 1) != 0, below = (quarter & 2) != 0,
             left = ((quarter + 1) & 2) != 0;
  const T sine(odd ? c.v : s.v), cosine(odd ? s.v : c.v);
  return {T(below ? -sine.v : sine.v), T(left ? -cosine.v : cosine.v)};
}

/// Returns the angle plus the whole turns that bring it nearest to `near`, which is less
/// than 10^6 turns away: unchanged, to the bit, within half a turn.
template <class Number, int width>
PackOf<Number, width> wound(const PackOf<Number, width>& angle,
                            const PackOf<Number, width>& near) {
  using T = PackOf<Number, width>;
  const T rounding(sizeof(Number) == sizeof(double) ? 6755399441055744.0 : 12582912.0);
  const T shifted = T(0.15915494309189535) * (near - angle) + rounding;
  return angle + T(6.2831853071795865) * (shifted - rounding);
}

/// The angle of (x, y) from the x axis, -pi to pi, within 2^-51 (2^-22). In (-0.66, 0.66)
/// the rational function of [Moshier 1989, Methods and Programs for Mathematical
/// Functions]; other ratios are reduced to it by pi/4 and pi/2.
template <class Number, int width>
class ArcTangent {
  using T = PackOf<Number, width>;

  static T small(const T& a) {
    const T z = a * a;
    const auto sum = [&]<std::size_t n>(const double(&of)[n]) {
      T y(of[0]);
      for (std::size_t k = 1; k < n; ++k) y = y * z + T(of[k]);
      return y;
    };
    static constexpr double above[] = {
        -8.750608600031904122785e-1, -1.615753718733365076637e1,
        -7.500855792314704667340e1, -1.228866684490136173410e2,
        -6.485021904942025371773e1};
    static constexpr double below[] = {1,
                                       2.485846490142306297962e1,
                                       1.650270098316988542046e2,
                                       4.328810604912902668951e2,
                                       4.853903996359136964868e2,
                                       1.945506571482613964425e2};
    return a + a * z * (sum(above) / sum(below));
  }

  using Numbers = std::array<Number, width>;

  /// A separate function with arguments by value: what a call might change could not
  /// stay in registers. Arguments are arrays, which all instruction sets pass in the
  /// same way (math/instructions.h).
  [[gnu::noinline]] static Numbers any(Numbers sine, Numbers cosine) {
    const T y(sine), x(cosine);
    const T ay = magnitude(y), ax = magnitude(x);
    const auto steep = ay.v > ax.v;
    const T few(steep ? ax.v : ay.v), many(steep ? ay.v : ax.v);
    // (1 - a)/(1 + a) where a = few/many is above tan(pi/8).
    const auto near_diagonal = few.v > (T(0.41421356237309503) * many).v;
    const T above(near_diagonal ? (few - many).v : few.v),
        below(near_diagonal ? (few + many).v : many.v);
    const T angle = small(above / below);
    T all(near_diagonal ? (angle + T(0.78539816339744828)).v : angle.v);
    all = T(steep ? (T(1.5707963267948966) - all).v : all.v);
    all = T(x.v < 0 ? (T(3.1415926535897931) - all).v : all.v);
    return T(y.v < 0 ? -all.v : all.v).numbers();
  }

 public:
  /// Returns the angle of (x, y) from the x axis, rad.
  static T of(const T& y, const T& x) {
    // The same operations and comparison as above for lanes that are as near to the axis.
    const T reach = T(0.41421356237309503) * x;
    if (!any_less(reach, magnitude(y))) [[likely]] {
      return small(y / x);
    }
    return T(any(y.numbers(), x.numbers()));
  }
};

/// Returns the angle of (x, y) from the x axis (rad), lane by lane, as ArcTangent.
template <class Number, int width>
PackOf<Number, width> arc_tangent(const PackOf<Number, width>& y,
                                  const PackOf<Number, width>& x) {
  return ArcTangent<Number, width>::of(y, x);
}

}  // namespace tress
