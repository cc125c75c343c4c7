#include "experiments/problems/pendulum_reference.h"

#include <gsl/gsl_sf_ellint.h>
#include <gsl/gsl_sf_elljac.h>

#include <algorithm>
#include <cmath>

namespace tress::experiments {
namespace {

double quarter_period(double m) {
  return gsl_sf_ellint_Kcomp(std::sqrt(m), GSL_PREC_DOUBLE);
}

/// Inverse of sn on [-K, K]: F(asin s | m).
double inverse_sn(double s, double m) {
  return gsl_sf_ellint_F(std::asin(std::clamp(s, -1.0, 1.0)), std::sqrt(m),
                         GSL_PREC_DOUBLE);
}

}  // namespace

PendulumReference::PendulumReference(double omega, State start)
    : omega_(omega), m_(0), phase_(0), sense_(start.rate < 0 ? -1 : 1) {
  const double s = std::sin(start.angle / 2);
  const double speed = start.rate / (2 * omega);
  m_ = s * s + speed * speed;
  if (m_ == 0) return;
  if (m_ < 1) {
    const double u = inverse_sn(s / std::sqrt(m_), m_);
    phase_ = start.rate < 0 ? 2 * quarter_period(m_) - u : u;
  } else {
    phase_ = sense_ * inverse_sn(s, 1 / m_);
  }
}

PendulumReference::State PendulumReference::at(double t) const {
  if (m_ == 0) return {0, 0};
  const double k = std::sqrt(m_);
  double sn = 0, cn = 0, dn = 0;
  if (m_ < 1) {
    // Reduced to one period, so that the argument keeps its digits over long times.
    const double u = std::remainder(omega_ * t + phase_, 4 * quarter_period(m_));
    gsl_sf_elljac_e(u, m_, &sn, &cn, &dn);
    return {2 * std::asin(k * sn), 2 * omega_ * k * cn};
  }
  const double u = std::remainder(k * omega_ * t + phase_, 4 * quarter_period(1 / m_));
  gsl_sf_elljac_e(u, 1 / m_, &sn, &cn, &dn);
  return {std::remainder(2 * std::atan2(sense_ * sn, cn), 2 * M_PI),
          sense_ * 2 * omega_ * k * dn};
}

double PendulumReference::period() const {
  if (m_ < 1) return 4 * quarter_period(m_) / omega_;
  return 2 * quarter_period(1 / m_) / (std::sqrt(m_) * omega_);
}

}  // namespace tress::experiments
