#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "contract/layers.h"
#include "math/mat3.h"

/// Velocity fields of the air, w(t, x) in m/s. at(t) is the flow at one instant; a
/// uniform flow does not read x.
namespace tress::models {

/// Air that moves with one velocity.
struct UniformFlow {
  static constexpr bool uniform = true;  // the velocity does not depend on the place
  Vec w;                                 // velocity, m/s
  /// Returns the velocity, m/s.
  Vec velocity(const Vec&) const { return w; }
  /// Returns 0 everywhere.
  Mat3 gradient(const Vec&) const { return {}; }
};

/// Air at rest.
struct StillAir {
  /// Flow at an instant.
  using Flow = StillAir;
  static constexpr bool uniform = true;  // the velocity does not depend on the place
  /// Returns the flow at t (s).
  StillAir at(double) const { return {}; }
  /// Returns 0 everywhere.
  static constexpr Vec velocity(const Vec&) { return {}; }
  /// Returns 0 everywhere.
  static constexpr Mat3 gradient(const Vec&) { return {}; }
};

/// Wind of constant velocity.
struct SteadyWind {
  /// Flow at an instant.
  using Flow = UniformFlow;
  Vec mean;  // velocity, m/s
  /// Returns the flow at t (s).
  UniformFlow at(double) const { return {mean}; }
};

/// A constant times sin(2 pi frequency t).
struct SineWind {
  /// Flow at an instant.
  using Flow = UniformFlow;
  Vec peak;              // largest velocity, m/s
  double frequency = 0;  // 1/s
  /// Returns the flow at t (s).
  UniformFlow at(double t) const {
    return {std::sin(2 * std::numbers::pi * frequency * t) * peak};
  }
};

/// Gusts carried along by a mean wind U: w = U + curl psi, so that div w = 0 exactly
/// [Bridson, Houriham & Nordenstam 2007, Curl-noise for procedural fluid flow, section
/// 2]. The smooth noise psi consists of random waves [Kraichnan 1970, Phys. Fluids 13,
/// 22]
///
///     psi = sum_m (e_m x k_m)/|k_m|^2 sin a_m,    w = U + sum_m e_m cos a_m,
///     a_m = k_m.(x - U t) + omega_m t + phase_m,  e_m.k_m = 0
///
/// with isotropic random directions and wave lengths from 2 to 1/2 of the given one.
/// Speeds scale as l^(1/3) and times as l^(2/3), as for eddies of size l in turbulence
/// [Kolmogorov 1941]. All derivatives are exact. Cost: `waves` sines per point and call.
class Gusts {
 public:
  static constexpr int waves = 24;  // number of waves

  /// The field at one instant.
  struct Flow {
    static constexpr bool uniform = false;  // the velocity depends on the place
    const Gusts* gusts;                     // field of gusts
    double t;                               // time, s
    /// Returns the velocity at a place, m/s.
    Vec velocity(const Vec& x) const { return gusts->velocity(t, x); }
    /// Returns the velocity gradient at a place, 1/s.
    Mat3 gradient(const Vec& x) const { return gusts->gradient(t, x); }
  };

  /// Constructs a field of gusts. `rms`: root mean square of |w - U| over space (m/s).
  /// `length`: typical wave length (m, > 0). `time`: turnover time of an eddy of that
  /// length in the frame of the mean wind (s, > 0). Equal seeds give equal fields on
  /// every machine.
  Gusts(Vec mean, double rms, double length, double time, std::uint64_t seed);

  /// Returns the flow at t (s).
  Flow at(double t) const { return {this, t}; }
  /// Returns the velocity at a place, m/s.
  Vec velocity(double t, const Vec& x) const;
  /// Returns the velocity gradient dw_i/dx_j, 1/s.
  Mat3 gradient(double t, const Vec& x) const;

 private:
  struct Wave {
    Vec e;             // m/s
    Vec k;             // 1/m
    double frequency;  // omega - k.U, rad/s
    double phase;
    double angle(double t, const Vec& x) const {
      return dot(k, x) + frequency * t + phase;
    }
  };

  Vec mean_;
  std::vector<Wave> waves_;
};

}  // namespace tress::models
