#include "experiments/simulate/failed_strands.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "simulation/files/csv.h"
#include "simulation/files/row.h"

namespace tress::experiments::scene_runs {

std::string failed_table(const std::vector<FailedStrand>& lost) {
  std::string table = "strand,t_s,reason\n";
  for (const FailedStrand& one : lost) {
    Row row;
    row.set("t_s", one.t);
    table += csv_line(std::vector<std::string>{std::to_string(one.strand),
                                               std::string(row.text("t_s")), one.reason});
  }
  return table;
}

std::vector<FailedStrand> FailuresOfRanks::gathered() {
  // Sent as bytes, without what lies between members.
  struct Entry {
    double strand, t;
    std::array<char, 400> reason;  // ended by a zero
  };
  const std::vector<std::size_t> counts = ranks_.of_each(own_.size());
  const auto rank = static_cast<std::ptrdiff_t>(ranks_.rank());
  const std::size_t all = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  if (all == 0) return {};
  std::vector<Entry> entries(all);
  std::size_t next =
      std::accumulate(counts.begin(), counts.begin() + rank, std::size_t{0});
  for (const FailedStrand& lost : own_) {
    Entry& entry = entries[next++];
    entry = {static_cast<double>(lost.strand), lost.t, {}};
    lost.reason.copy(entry.reason.data(), entry.reason.size() - 1);
  }
  own_.clear();
  ranks_.share(std::span(entries), counts);
  std::vector<FailedStrand> lost;
  for (const Entry& one : entries) {
    lost.push_back({static_cast<std::size_t>(one.strand), one.t, one.reason.data()});
  }
  std::ranges::sort(lost, {},
                    [](const FailedStrand& one) { return std::pair(one.t, one.strand); });
  return lost;
}

}  // namespace tress::experiments::scene_runs
