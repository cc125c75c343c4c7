#pragma once

#include <array>
#include <span>
#include <string>

#include "contract/layers.h"
#include "contract/parameters.h"
#include "math/lane_choice.h"
#include "math/vec3.h"

namespace tress::models {

/// Force per length (N/m) between two strands. It depends on the gap d from the other
/// strand's nearest point and the velocity u relative to that point:
///
///     F = K (P - rho)+ d/rho - D w(rho) u,    rho^2 = |d|^2 + (P/1000)^2
///     w = 1 up to P, 1 - 3 s^2 + 2 s^3 from P to the outer radius, s in [0, 1]; 0 beyond
///
/// K (P - d) and D follow [Wang, thesis, NCTU, section 5.2]. The thesis gives K = 2e-6, D
/// = 2e-5 or 2e-6 and P_inner = 3 mm, without units, for strands of segments of about l =
/// 1 cm. We read them as N/m and N s/m per segment. Per length, K/l = 2e-4 N/m^2 and D/l
/// = 2e-3 or 2e-4 N s/m^2 do not depend on the discretisation. Our reconstruction
/// consists of these units, rho in place of |d|, w and the outer radius. With rho F is
/// smooth and finite where strands coincide, and beyond P/10 F changes by less than 1e-4
/// relative. The force of K has a kink at P, w does not.
class ContactLaw {
 public:
  /// Coefficients of the law.
  struct Values {
    double stiffness;  // K, N/m^2
    double viscosity;  // D, N s/m^2
    double inner;      // P, m
    double outer;      // m
  };
  /// Row-major 3x3.
  using Matrix = std::array<double, 9>;
  /// Derivatives of the force.
  struct Slopes {
    Matrix by_gap;       // derivative by d, N/m^2
    double by_velocity;  // times the identity
  };

  /// Throws InputError naming `where` unless the outer radius exceeds the inner one.
  ContactLaw(const Values& values, const std::string& where);
  /// Constructs a law from the values of contact_parameters().
  ContactLaw(const Parameters& parameters, const std::string& where);

  /// Returns the distance below which strands repel, m.
  double inner() const { return law_.inner; }
  /// Returns the distance beyond which the force is 0, m.
  double reach() const { return law_.viscosity > 0 ? law_.outer : law_.inner; }

  /// F = push d - drag u, dF/du = -drag I, and
  /// dF/dd = push I + (push_slope d - drag_slope u) d^T.
  template <class T>
  struct Factors {
    T push, drag, push_slope, drag_slope;  // factors for a gap d
  };
  /// Computes the factors for one gap, or one per lane of a pack.
  template <class T>
  Factors<T> factors(const Vec3<T>& d) const noexcept;

  /// Returns the force per length F at gap d and velocity u, N/m.
  Vec force(const Vec& d, const Vec& u) const noexcept;
  /// Returns the derivatives of the force.
  Slopes slopes(const Vec& d, const Vec& u) const noexcept;
  /// Potential of the repulsion, J/m.
  double potential(const Vec& d) const noexcept;

 private:
  static constexpr double rounded_off = 1e-3;  // of P: rho against |d|

  double rho(const Vec& d) const noexcept;

  Values law_;
};

template <class T>
[[gnu::always_inline]] inline ContactLaw::Factors<T> ContactLaw::factors(
    const Vec3<T>& d) const noexcept {
  const double off = rounded_off * law_.inner, width = law_.outer - law_.inner;
  const T rho = square_root(dot(d, d) + T(off * off)), inverse = T(1) / rho;
  const T over = T(law_.inner) * inverse;  // P/rho
  const T s = larger(smaller((rho - T(law_.inner)) * T(1 / width), T(1)), T(0));
  return {larger(T(law_.stiffness) * (over - T(1)), T(0)),
          T(law_.viscosity) * (T(1) - s * s * (T(3) - T(2) * s)),
          where_less(T(1), over, T(-law_.stiffness) * over * inverse * inverse, T(0)),
          T(-6 * law_.viscosity / width) * s * (T(1) - s) * inverse};
}

/// The table entries that give a ContactLaw.
std::span<const Parameter> contact_parameters();

}  // namespace tress::models
