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

struct UniformFlow {
  static constexpr bool uniform = true;
  Vec w;
  Vec velocity(const Vec&) const { return w; }
  Mat3 gradient(const Vec&) const { return {}; }
};

struct StillAir {
  using Flow = StillAir;
  static constexpr bool uniform = true;
  StillAir at(double) const { return {}; }
  static constexpr Vec velocity(const Vec&) { return {}; }
  static constexpr Mat3 gradient(const Vec&) { return {}; }
};

struct SteadyWind {
  using Flow = UniformFlow;
  Vec mean;
  UniformFlow at(double) const { return {mean}; }
};

/// A constant times sin(2 pi frequency t).
struct SineWind {
  using Flow = UniformFlow;
  Vec peak;
  double frequency = 0;  // 1/s
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
  static constexpr int waves = 24;

  struct Flow {
    static constexpr bool uniform = false;
    const Gusts* gusts;
    double t;
    Vec velocity(const Vec& x) const { return gusts->velocity(t, x); }
    Mat3 gradient(const Vec& x) const { return gusts->gradient(t, x); }
  };

  /// Constructs a field of gusts. `rms`: root mean square of |w - U| over space (m/s).
  /// `length`: typical wave length (m, > 0). `time`: turnover time of an eddy of that
  /// length in the frame of the mean wind (s, > 0). Equal seeds give equal fields on
  /// every machine.
  Gusts(Vec mean, double rms, double length, double time, std::uint64_t seed);

  Flow at(double t) const { return {this, t}; }
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
