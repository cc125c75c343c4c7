#include "experiments/family/sampling.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <utility>

#include "simulation/groom/random.h"

namespace tress::experiments::family {

double normal_quantile(double u) {
  constexpr double least = 1e-12;  // 7 sigma
  return gsl_cdf_ugaussian_Pinv(std::clamp(u, least, 1 - least));
}

double CutNormal::at(double u) const {
  const Range within{gsl_cdf_ugaussian_P((low - mean) / sigma),
                     gsl_cdf_ugaussian_P((high - mean) / sigma)};
  return std::clamp(mean + sigma * normal_quantile(within.at(u)), low, high);
}

Hypercube::Hypercube(int count, std::uint64_t seed, std::uint64_t first)
    : count_(count), seed_(seed), dimension_(first) {}

std::vector<double> Hypercube::next() {
  simulation::Random random(seed_, dimension_++);
  std::vector<double> places(static_cast<std::size_t>(count_));
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = (static_cast<double>(i) + random.uniform()) / count_;
  }
  for (std::size_t i = places.size(); i > 1; --i) {  // Fisher & Yates 1938
    const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
    std::swap(places[i - 1], places[j]);
  }
  return places;
}

}  // namespace tress::experiments::family
