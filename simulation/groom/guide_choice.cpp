#include "simulation/groom/guide_choice.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "models/strand/geometry.h"
#include "simulation/groom/random.h"

namespace tress::simulation {
namespace {

constexpr std::size_t places = 5;  // root, quarter points, tip
constexpr int passes = 6;          // over all clusters; later ones move few guides
constexpr std::uint64_t stream = 0x67756964;

using Features = std::array<Vec, places>;

std::vector<Features> features_of(std::span<const Strand> strands) {
  std::vector<Features> all;
  for (const Strand& strand : strands) {
    const std::vector<Vec> x = initial_points(strand);
    Features& one = all.emplace_back();
    for (std::size_t k = 0; k < places; ++k) {
      const double at =
          static_cast<double>(k * (x.size() - 1)) / static_cast<double>(places - 1);
      const auto i = std::min(static_cast<std::size_t>(at), x.size() - 2);
      const double s = at - static_cast<double>(i);
      one[k] = (1 - s) * x[i] + s * x[i + 1];
    }
  }
  return all;
}

double square(const Features& a, const Features& b) {
  double sum = 0;
  for (std::size_t k = 0; k < places; ++k) sum += dot(a[k] - b[k], a[k] - b[k]);
  return sum / places;
}

/// The nearest guide of every strand, the first of several, and the square of its
/// distance.
struct Clusters {
  std::vector<std::size_t> own;
  std::vector<double> least;

  explicit Clusters(std::size_t strands)
      : own(strands), least(strands, std::numeric_limits<double>::infinity()) {}
  void add(const std::vector<Features>& all, std::size_t guide, std::size_t number) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double apart = square(all[i], all[guide]);
      if (!(apart < least[i])) continue;
      least[i] = apart;
      own[i] = number;
    }
  }
};

Clusters clusters(const std::vector<Features>& all, std::span<const std::size_t> guides) {
  Clusters made(all.size());
  for (std::size_t g = 0; g < guides.size(); ++g) made.add(all, guides[g], g);
  return made;
}

/// The strand of each cluster that is nearest to the cluster's mean.
std::vector<std::size_t> middles(const std::vector<Features>& all,
                                 const std::vector<std::size_t>& guides) {
  const Clusters now = clusters(all, guides);
  std::vector<Features> mean(guides.size());
  std::vector<double> count(guides.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < places; ++k) {
      mean[now.own[i]][k] = mean[now.own[i]][k] + all[i][k];
    }
    ++count[now.own[i]];
  }
  for (std::size_t g = 0; g < guides.size(); ++g) {
    for (Vec& x : mean[g]) x = (1 / std::max(1.0, count[g])) * x;
  }
  std::vector<std::size_t> chosen = guides;
  std::vector<double> least(guides.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t g = now.own[i];
    const double apart = square(all[i], mean[g]);
    if (!(apart < least[g])) continue;
    least[g] = apart;
    chosen[g] = i;
  }
  return chosen;
}

}  // namespace

std::vector<Vec> initial_points(const Strand& strand) {
  std::vector<Vec> all;
  for (const StrandPlace& place : joints(strand, ShapeOf::initial, root_place(strand))) {
    all.push_back(place.x);
  }
  return all;
}

std::vector<std::size_t> choose_guides(std::span<const Strand> strands,
                                       std::size_t guides, std::uint64_t seed) {
  std::vector<std::size_t> chosen;
  if (guides >= strands.size()) {
    chosen.resize(strands.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    return chosen;
  }
  const std::vector<Features> all = features_of(strands);
  Random random(seed, stream);
  Clusters so_far(all.size());
  auto next =
      static_cast<std::size_t>(random.uniform() * static_cast<double>(all.size()));
  while (chosen.size() < guides) {
    so_far.add(all, next, chosen.size());
    chosen.push_back(next);
    next = static_cast<std::size_t>(std::ranges::max_element(so_far.least) -
                                    so_far.least.begin());
  }
  for (int pass = 0; pass < passes; ++pass) chosen = middles(all, chosen);
  std::ranges::sort(chosen);
  // Strands in one place may have been chosen twice.
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

double spread_about(std::span<const Strand> strands,
                    std::span<const std::size_t> guides) {
  const Clusters made = clusters(features_of(strands), guides);
  return std::accumulate(made.least.begin(), made.least.end(), 0.0) /
         static_cast<double>(strands.size());
}

}  // namespace tress::simulation
