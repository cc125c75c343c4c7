#include "simulation/head/head_balance.h"

#include <algorithm>
#include <numeric>

namespace tress::simulation {

std::vector<double> cost_of_strands(const HeadDivision& division,
                                    std::span<const double> seconds) {
  std::vector<double> counts(seconds.size()), cost(division.strands());
  const auto owner = [&](std::size_t k) {
    return static_cast<std::size_t>(division.owner(k));
  };
  for (std::size_t k = 0; k < cost.size(); ++k) counts[owner(k)] += 1;
  for (std::size_t k = 0; k < cost.size(); ++k) {
    cost[k] = seconds[owner(k)] / counts[owner(k)];
  }
  return cost;
}

std::unique_ptr<HeadRun> balanced(HeadRun& run, const SceneOutline& outline,
                                  const HeadPack& pack, int threads, double anew_s,
                                  std::size_t at_once) {
  Ranks& ranks = run.ranks();
  if (ranks.size() == 1) return nullptr;
  const std::vector<double> seconds = ranks.of_each(run.stepping_s());
  const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0),
               mean = all / static_cast<double>(seconds.size());
  if (!(std::ranges::max(seconds) - mean > anew_s)) return nullptr;
  auto next = std::make_unique<HeadRun>(
      make_head(outline, pack, threads, ranks, cost_of_strands(run.division(), seconds)),
      threads, ranks);
  std::vector<double> kept;
  run.by_chunks(at_once, [&](HeadRun::Numbers strands) {
    run.keep(strands, kept);
    next->recall(strands, kept);
  });
  return next;
}

}  // namespace tress::simulation
