#include "simulation/scene_changes/typical_strands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "linear/vector_ops.h"

namespace tress::simulation {
namespace {

constexpr std::size_t features = 4;
using Features = std::array<double, features>;

Features features_of(const Strand& strand) {
  double turning = 0;
  for (const Segment& segment : strand.segments) {
    turning += segment.length * std::hypot(segment.natural.y, segment.natural.z);
  }
  const Segment& first = strand.segments.front();
  const Frame root = strand.free_root ? strand.free_root->frame : strand.root.frame;
  return {std::log(strand.length()),
          std::log(stiffness(strand.material, first.section).y), turning,
          (root * first.mount).e0.z};
}

Features mean(const std::vector<Features>& all, const std::vector<std::size_t>& of) {
  Features sum{};
  for (const std::size_t i : of) {
    for (std::size_t k = 0; k < features; ++k) sum[k] += all[i][k];
  }
  for (double& entry : sum) entry /= static_cast<double>(of.size());
  return sum;
}

Features less(Features a, const Features& b) {
  for (std::size_t k = 0; k < features; ++k) a[k] -= b[k];
  return a;
}

/// Mean 0 and deviation 1; a feature that is equal for all up to rounding is 0.
void standardize(std::vector<Features>& all, const std::vector<std::size_t>& every) {
  constexpr double rounding = 1e-9;
  const Features centre = mean(all, every);
  Features squares{};
  for (Features& one : all) {
    one = less(one, centre);
    for (std::size_t k = 0; k < features; ++k) squares[k] += one[k] * one[k];
  }
  for (std::size_t k = 0; k < features; ++k) {
    const double deviation = std::sqrt(squares[k] / static_cast<double>(all.size()));
    const bool same = deviation <= rounding * (1 + std::abs(centre[k]));
    for (Features& one : all) one[k] = same ? 0 : one[k] / deviation;
  }
}

/// The eigenvector of the largest eigenvalue of the covariance, by power iteration; for
/// identical strands it is arbitrary.
Features principal_axis(const std::vector<Features>& all) {
  constexpr int iterations = 100;
  Features axis{1, 0.9, 0.8, 0.7};  // not orthogonal to any axis of symmetry
  for (int i = 0; i < iterations; ++i) {
    Features next{};
    for (const Features& one : all) {
      const double along = scalar_product(one, axis);
      for (std::size_t k = 0; k < features; ++k) next[k] += along * one[k];
    }
    const double size = std::sqrt(scalar_product(next, next));
    if (!(size > 0)) break;
    for (std::size_t k = 0; k < features; ++k) axis[k] = next[k] / size;
  }
  return axis;
}

}  // namespace

std::vector<std::size_t> typical_strands(const std::vector<Strand>& strands,
                                         std::size_t most) {
  std::vector<std::size_t> order(strands.size());
  std::iota(order.begin(), order.end(), 0u);
  if (strands.size() <= most) return order;
  std::vector<Features> all;
  all.reserve(strands.size());
  for (const Strand& strand : strands) all.push_back(features_of(strand));
  standardize(all, order);
  const Features axis = principal_axis(all);
  std::ranges::stable_sort(order, {},
                           [&](std::size_t i) { return scalar_product(all[i], axis); });
  std::vector<std::size_t> chosen;
  for (std::size_t g = 0; g < most; ++g) {
    const auto at = [&](std::size_t group) {
      return order.begin() + static_cast<std::ptrdiff_t>(group * order.size() / most);
    };
    const std::vector<std::size_t> group(at(g), at(g + 1));
    const Features centre = mean(all, group);
    chosen.push_back(*std::ranges::min_element(group, {}, [&](std::size_t i) {
      const Features away = less(all[i], centre);
      return scalar_product(away, away);
    }));
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace tress::simulation
