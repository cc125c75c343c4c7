#include "experiments/validation/rods/loads.h"

#include "math/gauss_legendre.h"
#include "math/lagrange.h"

namespace tress::experiments::validation {
namespace {

/// Weights of the polynomial through the Gauss points, at the end of its interval.
std::vector<double> at_end(int points) {
  const std::vector<QuadraturePoint> rule = gauss_legendre(points, 1);
  std::vector<double> weights;
  for (std::size_t k = 0; k < rule.size(); ++k) {
    weights.push_back(
        lagrange(k, rule.size(), 1, [&](std::size_t j) { return rule[j].at; }));
  }
  return weights;
}

}  // namespace

void Weight::add_load(double t, const Points& p, InOut f) const noexcept {
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    store3(load3(&f[3 * i]) + (t * p.mass[i]) * g_, &f[3 * i]);
  }
}

double Weight::potential(double t, const Points& p) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < p.mass.size(); ++i) {
    sum -= t * p.mass[i] * dot(g_, load3(&p.x[3 * i]));
  }
  return sum;
}

const std::vector<double>& TipPoints::weights(const Points& p) const {
  // Models lump a segment's mass at one node, n + 1 in all, or at several points.
  const int points = p.count > elements_ + 1 ? p.count / elements_ : 1;
  if (weights_.size() != static_cast<std::size_t>(points)) weights_ = at_end(points);
  return weights_;
}

void TipForce::add_load(double, const Points& p, InOut f) const noexcept {
  const std::vector<double>& w = tip_.weights(p);
  const std::size_t first = p.mass.size() - w.size();
  for (std::size_t k = 0; k < w.size(); ++k) {
    double* load = &f[3 * (first + k)];
    store3(load3(load) + w[k] * force, load);
  }
}

double TipForce::potential(double, const Points& p) const noexcept {
  const std::vector<double>& w = tip_.weights(p);
  const std::size_t first = p.mass.size() - w.size();
  double sum = 0;
  for (std::size_t k = 0; k < w.size(); ++k) {
    sum -= w[k] * dot(force, load3(&p.x[3 * (first + k)]));
  }
  return sum;
}

}  // namespace tress::experiments::validation
