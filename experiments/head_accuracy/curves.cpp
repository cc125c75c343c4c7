#include "experiments/head_accuracy/curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tress::experiments::head_accuracy {
namespace {

/// Lagrange's weights of the points 0, 1, 2, 3 at u.
std::array<double, 4> cubic(double u) {
  const double a = u, b = u - 1, c = u - 2, d = u - 3;
  return {-b * c * d / 6, a * c * d / 2, -a * b * d / 2, a * b * c / 6};
}

}  // namespace

Vec HairCurves::at(std::size_t instant, std::size_t hair, double share) const {
  const double u = share * elements;
  const int first = std::clamp(static_cast<int>(u) - 1, 0, elements - 3);
  const std::array<double, 4> weight = cubic(u - first);
  const std::size_t points = static_cast<std::size_t>(elements) + 1;
  const double* p = &x[instant][3 * (hair * points + static_cast<std::size_t>(first))];
  Vec sum;
  for (std::size_t i = 0; i < 4; ++i) sum = sum + weight[i] * load3(p + 3 * i);
  return sum;
}

HairCurves extrapolated_in_step(HairCurves fine, const HairCurves& coarse) {
  for (std::size_t k = 0; k < fine.x.size(); ++k) {
    for (std::size_t i = 0; i < fine.x[k].size(); ++i) {
      fine.x[k][i] += fine.x[k][i] - coarse.x[k][i];
    }
  }
  return fine;
}

HairCurves extrapolated_in_elements(HairCurves fine, const HairCurves& coarse) {
  const auto points = static_cast<std::size_t>(fine.elements) + 1;
  for (std::size_t at = 0; at < fine.x.size(); ++at) {
    for (std::size_t i = 0; i < fine.hairs * points; ++i) {
      double* const p = &fine.x[at][3 * i];
      const double share =
          static_cast<double>(i % points) / static_cast<double>(points - 1);
      const Vec x = load3(p);
      store3(x + (1.0 / 3) * (x - coarse.at(at, i / points, share)), p);
    }
  }
  return fine;
}

void HairErrors::add(std::size_t instant, std::size_t hair, std::span<const Vec> points) {
  const auto elements = static_cast<double>(points.size() - 1);
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double share = static_cast<double>(i) / elements;
    const Vec away = points[i] - reference_.at(instant, hair, share);
    sum += (i + 1 < points.size() ? 1 : 0.5) * dot(away, away);
  }
  sums_[hair].squares += sum / elements;
  ++sums_[hair].instants;
}

void HairErrors::add(std::size_t instant, std::span<const std::size_t> hairs,
                     std::span<const Vec> points) {
  const std::size_t each = hairs.empty() ? 0 : points.size() / hairs.size();
  for (std::size_t i = 0; i < hairs.size(); ++i) {
    add(instant, hairs[i], points.subspan(i * each, each));
  }
}

double HairErrors::of(std::size_t hair) const {
  const Sum& sum = sums_[hair];
  return std::sqrt(sum.squares / sum.instants) / lengths_[hair];
}

Spread spread(std::span<const double> errors) {
  return spread(errors, std::vector<double>(errors.size(), 1));
}

Spread spread(std::span<const double> errors, std::span<const double> weights) {
  constexpr double most_hairs = 0.95;
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return errors[i]; });
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  Spread made;
  double so_far = 0;
  bool most = false;
  for (const std::size_t i : order) {
    so_far += weights[i];
    made.mean += weights[i] / all * errors[i];
    made.largest = errors[i];
    if (most || so_far < most_hairs * all * (1 - 1e-12)) continue;
    made.p95 = errors[i];
    most = true;
  }
  return made;
}

}  // namespace tress::experiments::head_accuracy
