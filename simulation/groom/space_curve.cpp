#include "simulation/groom/space_curve.h"

#include <gsl/gsl_spline.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contract/input_error.h"

namespace tress::simulation {

struct SpaceCurve::Splines {
  struct Free {
    void operator()(gsl_spline* s) const { gsl_spline_free(s); }
    void operator()(gsl_interp_accel* a) const { gsl_interp_accel_free(a); }
  };
  std::array<std::unique_ptr<gsl_spline, Free>, 3> of;
  std::unique_ptr<gsl_interp_accel, Free> near{gsl_interp_accel_alloc()};

  Vec by(double (*evaluate)(const gsl_spline*, double, gsl_interp_accel*),
         double u) const {
    return {evaluate(of[0].get(), u, near.get()), evaluate(of[1].get(), u, near.get()),
            evaluate(of[2].get(), u, near.get())};
  }
};

SpaceCurve::SpaceCurve(SpaceCurve&&) noexcept = default;
SpaceCurve::~SpaceCurve() = default;

SpaceCurve::SpaceCurve(std::span<const Vec> points, int fine, const std::string& where)
    : fine_(fine), splines_(std::make_unique<Splines>()) {
  const std::size_t n = points.size();
  std::array<std::vector<double>, 3> x;
  for (std::size_t i = 0; i < n; ++i) {
    knots_.push_back(i == 0 ? 0 : knots_.back() + norm(points[i] - points[i - 1]));
    if (i > 0 && !(knots_[i] - knots_[i - 1] >= least_step)) {
      throw InputError("points " + std::to_string(i) + " and " + std::to_string(i + 1) +
                           " are less than 1 nm apart",
                       where, "leave one of them out");
    }
    x[0].push_back(points[i].x);
    x[1].push_back(points[i].y);
    x[2].push_back(points[i].z);
  }
  const gsl_interp_type* kind = n < 3 ? gsl_interp_linear : gsl_interp_cspline;
  for (std::size_t k = 0; k < 3; ++k) {
    splines_->of[k].reset(gsl_spline_alloc(kind, n));
    gsl_spline_init(splines_->of[k].get(), knots_.data(), x[k].data(), n);
  }
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (int j = 0; j < fine; ++j) {
      u_.push_back(std::lerp(knots_[i], knots_[i + 1], static_cast<double>(j) / fine));
    }
  }
  u_.push_back(knots_.back());
  arc_.push_back(0);
  double before = norm(rate(u_[0]));
  for (std::size_t i = 1; i < u_.size(); ++i) {
    const double middle = norm(rate((u_[i - 1] + u_[i]) / 2)), after = norm(rate(u_[i]));
    arc_.push_back(arc_.back() + (u_[i] - u_[i - 1]) * (before + after + 4 * middle) / 6);
    before = after;
  }
}

double SpaceCurve::parameter(double s) const {
  const auto after =
      std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(arc_, s) - arc_.begin(), 1,
                                 static_cast<std::ptrdiff_t>(arc_.size()) - 1);
  const auto j = static_cast<std::size_t>(after), i = j - 1;
  return std::lerp(u_[i], u_[j], (s - arc_[i]) / (arc_[j] - arc_[i]));
}

Vec SpaceCurve::position(double u) const {
  return splines_->by(gsl_spline_eval, std::clamp(u, 0.0, knots_.back()));
}
Vec SpaceCurve::rate(double u) const {
  return splines_->by(gsl_spline_eval_deriv, std::clamp(u, 0.0, knots_.back()));
}
Vec SpaceCurve::tangent(double u) const {
  const Vec r = rate(u);
  const double size = norm(r);
  if (size > 0) return 1 / size * r;
  // A fold: any direction of the points nearby.
  const double near = 1e-3 * knots_.back();
  const Vec chord = position(u + near) - position(u - near);
  return norm(chord) > 0 ? 1 / norm(chord) * chord : Vec{1, 0, 0};
}

}  // namespace tress::simulation
