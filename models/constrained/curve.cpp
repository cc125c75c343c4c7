#include "models/constrained/curve.h"

#include <numbers>

namespace tress::models {

CurvePoint FourierCurve::at(double s) const noexcept {
  const double rate = shape_.rate;
  const double w = rate * s + shape_.phase;
  CurvePoint p{shape_.origin + w * shape_.drift, rate * shape_.drift, {}, {}};
  double k = 0;
  for (const Harmonic& h : shape_.harmonics) {
    k += 1;
    const double kr = k * rate;
    const double cosine = std::cos(k * w);
    const double sine = std::sin(k * w);
    const Vec even = cosine * h.cosine + sine * h.sine;
    const Vec odd = cosine * h.sine - sine * h.cosine;
    p.c = p.c + even;
    p.d1 = p.d1 + kr * odd;
    p.d2 = p.d2 - kr * kr * even;
    p.d3 = p.d3 - kr * kr * kr * odd;
  }
  return p;
}

std::unique_ptr<FourierCurve> ellipse(Vec centre, Vec a, Vec b) {
  return helix_curve(centre, a, b, {});
}

std::unique_ptr<FourierCurve> helix_curve(Vec centre, Vec a, Vec b, Vec rise) {
  FourierCurve::Shape shape;
  shape.origin = centre;
  shape.drift = rise;
  shape.harmonics = {{a, b}};
  return std::make_unique<FourierCurve>(std::move(shape));
}

std::unique_ptr<FourierCurve> trefoil(double size) {
  const double u = size / 3;
  FourierCurve::Shape shape;
  shape.harmonics = {
      {{0, u, 0}, {u, 0, 0}}, {{0, -2 * u, 0}, {2 * u, 0, 0}}, {{0, 0, 0}, {0, 0, -u}}};
  return std::make_unique<FourierCurve>(std::move(shape));
}

std::unique_ptr<FourierCurve> shake(Vec centre, Vec amplitude, double frequency_hz) {
  return orbit(centre, amplitude, {}, frequency_hz);
}

std::unique_ptr<FourierCurve> orbit(Vec centre, Vec a, Vec b, double frequency_hz) {
  FourierCurve::Shape shape;
  shape.origin = centre;
  shape.harmonics = {{a, b}};
  shape.rate = 2 * std::numbers::pi * frequency_hz;
  return std::make_unique<FourierCurve>(std::move(shape));
}

}  // namespace tress::models
