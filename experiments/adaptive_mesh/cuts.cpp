#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "experiments/adaptive_mesh/adaptive_mesh.h"
#include "simulation/groom/helix_fit.h"

namespace tress::experiments::adaptive_mesh {
namespace {

constexpr double least_share = 0.15;  // of the mean density
// Next to nothing, so that chains are as near as they can be.
constexpr simulation::FitWeights weights{1e-9, 1e-9};

double misfit_of(const SpaceCurve& curve, std::vector<double> ends) {
  for (double& end : ends) end *= curve.length();
  ends.back() = curve.length();
  const auto chain = simulation::fit_helices(curve, ends, weights);
  return simulation::distance(curve, chain, simulation::Between::helices).rms /
         curve.length();
}

/// Where errors that fall with n become the target: `errors` of ascending `elements`.
double crossing(const std::vector<int>& elements, const std::vector<double>& errors,
                double target) {
  if (!(errors.back() <= target)) return std::numeric_limits<double>::quiet_NaN();
  std::size_t k = errors.size() - 1;
  while (k > 0 && errors[k - 1] <= target) --k;
  if (k == 0) return elements.front();
  const double e0 = std::log(errors[k - 1]), e1 = std::log(errors[k]),
               n0 = std::log(elements[k - 1]), n1 = std::log(elements[k]);
  return std::exp(n0 + (n1 - n0) * (e0 - std::log(target)) / (e0 - e1));
}

}  // namespace

Limit limit_of(const Shapes& shapes) {
  Density cubes(cells);
  double squares = 0, numbers = 0;
  const double part = 1.0 / static_cast<double>(shapes.density.size());
  for (const Density& density : shapes.density) {
    double sum = 0;
    for (std::size_t c = 0; c < cells; ++c) {
      cubes[c] += part * std::pow(density[c], 3);
      sum += density[c];
    }
    squares += part * std::pow(sum, 3);
    numbers += part * std::pow(sum, 1.5);
  }
  double sum = 0;
  for (const double cube : cubes) sum += std::cbrt(cube);
  const double fixed = std::pow(sum, 1.5);
  return {fixed / std::sqrt(squares), fixed / numbers};
}

std::vector<double> cut_by(const Density& density, int n) {
  const double mean = std::accumulate(density.begin(), density.end(), 0.0) / cells;
  std::vector<double> sum{0};
  for (const double d : density) {
    sum.push_back(sum.back() + (mean > 0 ? std::max(d, least_share * mean) : 1));
  }
  std::vector<double> ends{0};
  std::size_t c = 0;
  for (int k = 1; k < n; ++k) {
    const double wanted = sum.back() * k / n;
    while (sum[c + 1] < wanted) ++c;
    ends.push_back((static_cast<double>(c) + (wanted - sum[c]) / (sum[c + 1] - sum[c])) /
                   cells);
  }
  ends.push_back(1);
  return ends;
}

std::string_view name(Cuts cuts) {
  switch (cuts) {
    case Cuts::equal:
      return "equal";
    case Cuts::start:
      return "start";
    case Cuts::mean:
      return "mean";
    case Cuts::largest:
      return "largest";
    case Cuts::anew:
      break;
  }
  return "anew";
}

std::vector<Misfit> misfits(const Shapes& shapes, const Density& rest,
                            const std::vector<int>& elements) {
  Density mean(cells), most(cells);
  for (const Density& density : shapes.density) {
    for (std::size_t c = 0; c < cells; ++c) {
      mean[c] += density[c];
      most[c] = std::max(most[c], density[c]);
    }
  }
  std::vector<Misfit> all;
  for (const int n : elements) {
    std::vector<double> best(shapes.at.size(), std::numeric_limits<double>::infinity());
    for (const Cuts cuts : all_cuts) {
      Misfit one{cuts, n, {}};
      for (std::size_t i = 0; i < shapes.at.size(); ++i) {
        const Density& density = cuts == Cuts::start     ? rest
                                 : cuts == Cuts::mean    ? mean
                                 : cuts == Cuts::largest ? most
                                                         : shapes.density[i];
        const double error = misfit_of(
            shapes.at[i], cut_by(cuts == Cuts::equal ? Density(cells, 1) : density, n));
        best[i] = std::min(best[i], error);
        one.at.push_back(cuts == Cuts::anew ? best[i] : error);
      }
      all.push_back(one);
    }
  }
  return all;
}

double root_mean_square(const std::vector<double>& all) {
  double sum = 0;
  for (const double x : all) sum += x * x;
  return std::sqrt(sum / static_cast<double>(all.size()));
}

double largest(const std::vector<double>& all) { return *std::ranges::max_element(all); }

Needed needed(const std::vector<Misfit>& all, double target, OverInstants over) {
  Needed found{std::numeric_limits<double>::quiet_NaN(), 0, 0, Cuts::equal};
  for (const Cuts cuts : all_cuts) {
    std::vector<int> elements;
    std::vector<double> errors;
    std::vector<const Misfit*> own;
    for (const Misfit& one : all) {
      if (one.cuts != cuts) continue;
      own.push_back(&one);
      elements.push_back(one.elements);
      errors.push_back(over(one.at));
    }
    const double n = crossing(elements, errors, target);
    if (cuts != Cuts::anew) {
      if (n < found.fixed || std::isnan(found.fixed)) {
        found.fixed = n;
        found.best = cuts;
      }
      continue;
    }
    found.remeshed = n;
    const std::size_t instants = own.front()->at.size();
    for (std::size_t i = 0; i < instants; ++i) {
      std::vector<double> here;
      for (const Misfit* one : own) here.push_back(one->at[i]);
      found.following += crossing(elements, here, target) / static_cast<double>(instants);
    }
  }
  return found;
}

}  // namespace tress::experiments::adaptive_mesh
