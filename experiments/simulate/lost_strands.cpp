#include "experiments/simulate/lost_strands.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tress::experiments::scene_runs {

std::vector<LostStrand> LostStrands::gathered() {
  // Sent as bytes, without what lies between members.
  struct Entry {
    double strand, t, fast;
  };
  const std::vector<std::size_t> counts = ranks_.of_each(own_.size());
  const auto rank = static_cast<std::ptrdiff_t>(ranks_.rank());
  const std::size_t all = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  if (all == 0) return {};
  std::vector<Entry> entries(all);
  std::size_t next =
      std::accumulate(counts.begin(), counts.begin() + rank, std::size_t{0});
  for (const LostStrand& lost : own_) {
    entries[next++] = {static_cast<double>(lost.strand), lost.t, lost.fast ? 1.0 : 0.0};
  }
  own_.clear();
  ranks_.share(std::span(entries), counts);
  std::vector<LostStrand> lost;
  for (const Entry& one : entries) {
    lost.push_back({static_cast<std::size_t>(one.strand), one.t, one.fast != 0});
  }
  std::ranges::sort(lost, {},
                    [](const LostStrand& one) { return std::pair(one.t, one.strand); });
  return lost;
}

}  // namespace tress::experiments::scene_runs
