#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "contract/layers.h"
#include "math/vec3.h"

namespace tress::models {

/// Position (m) and its first three derivatives with respect to the curve's parameter.
struct CurvePoint {
  Vec c, d1, d2, d3;  // position and derivatives
};

/// A smooth curve in space. The parameter is any s for a wire, and the time (s) for the
/// prescribed motion of an anchor. Callers may pass their own.
class Curve {
 public:
  virtual ~Curve() = default;
  /// Evaluates the curve at s.
  virtual CurvePoint at(double s) const noexcept = 0;
  /// Evaluates at s, as after the teleport at `since` (by_time.h).
  virtual CurvePoint at(double s, double /*since*/) const noexcept { return at(s); }
};

/// c(s) = origin + drift w + sum_{k=1} cosine_k cos(k w) + sine_k sin(k w),  w = rate s +
/// phase. One harmonic gives circles, ellipses, helices (with drift), shaking and
/// circular motion; three give the trefoil knot.
class FourierCurve final : public Curve {
 public:
  /// Coefficients of one harmonic.
  struct Harmonic {
    Vec cosine, sine;  // m
  };
  /// Parameters of the formula.
  struct Shape {
    Vec origin, drift;                // m, m per radian
    std::vector<Harmonic> harmonics;  // harmonics from k = 1 on
    double rate = 1;                  // radians per unit of s
    double phase = 0;                 // rad
  };

  /// Makes a curve of this shape.
  explicit FourierCurve(Shape shape) : shape_(std::move(shape)) {}

  /// Evaluates the position for any scalar.
  template <class T>
  Vec3<T> position(const T& s) const {
    using std::cos, std::sin;
    const T w = T(shape_.rate) * s + T(shape_.phase);
    Vec3<T> c = Vec3<T>(shape_.origin) + w * Vec3<T>(shape_.drift);
    double k = 0;
    for (const Harmonic& h : shape_.harmonics) {
      const T kw = T(k += 1) * w;
      c = c + cos(kw) * Vec3<T>(h.cosine) + sin(kw) * Vec3<T>(h.sine);
    }
    return c;
  }

  CurvePoint at(double s) const noexcept override;

 private:
  Shape shape_;
};

/// centre + a cos(s) + b sin(s): a circle when a and b are orthogonal and of equal
/// length.
std::unique_ptr<FourierCurve> ellipse(Vec centre, Vec a, Vec b);
/// An ellipse that rises by `rise` (m) per radian.
std::unique_ptr<FourierCurve> helix_curve(Vec centre, Vec a, Vec b, Vec rise);
/// size/3 (sin s + 2 sin 2s, cos s - 2 cos 2s, -sin 3s): the trefoil knot, about `size`
/// metres in radius.
std::unique_ptr<FourierCurve> trefoil(double size);
/// centre + amplitude cos(2 pi f t): shaking that starts at rest, fully displaced.
std::unique_ptr<FourierCurve> shake(Vec centre, Vec amplitude, double frequency_hz);
/// centre + a cos(2 pi f t) + b sin(2 pi f t).
std::unique_ptr<FourierCurve> orbit(Vec centre, Vec a, Vec b, double frequency_hz);

}  // namespace tress::models
