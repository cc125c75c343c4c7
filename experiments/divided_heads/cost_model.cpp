#include "experiments/divided_heads/cost_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

namespace tress::experiments::divided_heads {

double border(double ranks) {
  double along[] = {1, 1};  // regions along either side
  for (double count = 1; count < ranks; count *= 2) {
    (along[0] <= along[1] ? along[0] : along[1]) *= 2;
  }
  double sum = 0;
  for (const int side : {0, 1}) {
    sum += std::min(along[side] - 1, 2.0) / along[1 - side];
  }
  return sum;
}

double CostModel::kernel_cost(double strands) const {
  const auto above = std::ranges::upper_bound(kernel, strands, {}, &Kernel::strands);
  if (above == kernel.begin()) return kernel.front().cost;
  const Kernel& from = *(above - 1);
  if (above == kernel.end()) return from.cost;
  const double part =
      std::log(strands / from.strands) / std::log(above->strands / from.strands);
  return from.cost + part * (above->cost - from.cost);
}

double CostModel::own_cost(double strands, double ranks, double beside) const {
  const double own = strands / ranks, near = own * std::min(ranks, cores) * beside;
  return own * elements *
         (kernel_cost(near) + contacts * (1 - edge / std::sqrt(strands)));
}

double CostModel::ghosts(double strands, double ranks) const {
  return std::min(border(ranks) * depth * std::sqrt(strands), strands * (1 - 1 / ranks));
}

double CostModel::cost(double strands, double ranks, double beside) const {
  return own_cost(strands, ranks, beside) + ghosts(strands, ranks) * elements * ghost +
         latency * std::log2(ranks);
}

namespace {

/// The mean of what `value` says of the measurements that `wanted` selects.
template <class Wanted, class Value>
std::optional<double> mean(std::span<const Measurement> all, Wanted wanted, Value value) {
  double sum = 0;
  int count = 0;
  for (const Measurement& one : all) {
    if (!wanted(one)) continue;
    sum += value(one);
    ++count;
  }
  if (count == 0) return {};
  return sum / count;
}

/// The line of least squares; level through points of one place.
struct Line {
  double offset, slope;
};
Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto count = static_cast<double>(x.size());
  const double mx = std::accumulate(x.begin(), x.end(), 0.0) / count,
               my = std::accumulate(y.begin(), y.end(), 0.0) / count;
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    xy += (x[i] - mx) * (y[i] - my);
  }
  const double slope = xx > 0 ? xy / xx : 0;
  return {my - slope * mx, slope};
}

}  // namespace

std::optional<CostModels> fit_cost(std::span<const Measurement> all) {
  CostModels models;
  for (const bool touch : {false, true}) {
    CostModel& model = touch ? models.touching : models.apart;
    const auto of = [&](double ranks, double beside) {
      return [=](const Measurement& m) {
        return m.touch == touch && m.ranks == ranks && m.beside == beside;
      };
    };
    std::vector<Measurement> alone;
    std::ranges::copy_if(all, std::back_inserter(alone), of(1, 1));
    if (alone.empty()) return {};
    model.cores = alone.front().cores;
    const auto of_element = [](const Measurement& m) {
      return m.cost / (m.strands * elements);
    };
    if (!touch) {
      std::ranges::sort(alone, {}, &Measurement::strands);
      for (const Measurement& m : alone) {
        model.kernel.push_back({m.strands, of_element(m)});
      }
    } else {
      model.kernel = models.apart.kernel;
      std::vector<double> x, y;
      for (const Measurement& m : alone) {
        x.push_back(1 / std::sqrt(m.strands));
        y.push_back(of_element(m) - model.kernel_cost(m.strands));
      }
      const auto [offset, slope] = line_through(x, y);
      model.contacts = offset;
      if (offset > 0) model.edge = -slope / offset;
    }
    const auto left = [&](const Measurement& m) {
      return m.cost - model.own_cost(m.strands, m.ranks);
    };
    if (!touch) {
      const auto latency = mean(all, of(2, 1), left);
      if (!latency) return {};
      model.latency = std::max(*latency, 0.0);
      continue;
    }
    model.latency = models.apart.latency;
    const auto depth = mean(all, of(2, 1), [](const Measurement& m) {
      return m.ghosts / (border(2) * std::sqrt(m.strands));
    });
    const auto ghost = mean(all, of(2, 1), [&](const Measurement& m) {
      return (left(m) - model.latency) / (m.ghosts * elements);
    });
    if (!depth || !(*depth > 0)) return {};
    model.depth = *depth;
    model.ghost = std::max(*ghost, 0.0);
  }
  return models;
}

double predicted(const CostModels& models, const Measurement& of) {
  const CostModel& model = of.touch ? models.touching : models.apart;
  return model.cost(of.strands, of.ranks, of.beside) * std::max(1.0, of.ranks / of.cores);
}

}  // namespace tress::experiments::divided_heads
