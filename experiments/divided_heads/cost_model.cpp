#include "experiments/divided_heads/cost_model.h"

#include <algorithm>
#include <cmath>
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

double CostModel::own_cost(double strands, double ranks) const {
  return (ranks > 1 ? busy : 1) * strands / ranks * elements *
         (kernel + contacts * (1 - edge / std::sqrt(strands)));
}

double CostModel::ghosts(double strands, double ranks) const {
  return std::min(border(ranks) * depth * std::sqrt(strands), strands * (1 - 1 / ranks));
}

double CostModel::cost(double strands, double ranks) const {
  return own_cost(strands, ranks) + ghosts(strands, ranks) * elements * ghost +
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
    const auto alone = mean(all, of(1, 1), [](const Measurement& m) {
      return m.cost / (m.strands * elements);
    });
    if (!alone) return {};
    model.kernel = touch ? models.apart.kernel : *alone;
    if (touch) {
      std::vector<double> x, y;
      for (const Measurement& m : all) {
        if (!of(1, 1)(m)) continue;
        x.push_back(1 / std::sqrt(m.strands));
        y.push_back(m.cost / (m.strands * elements) - model.kernel);
      }
      const auto [offset, slope] = line_through(x, y);
      model.contacts = offset;
      if (offset > 0) model.edge = -slope / offset;
    }
    const auto busy = mean(all, of(1, 2), [&](const Measurement& m) {
      return m.cost / model.own_cost(m.strands, 1);
    });
    if (!busy) return {};
    model.busy = std::max(*busy, 1.0);
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

}  // namespace tress::experiments::divided_heads
