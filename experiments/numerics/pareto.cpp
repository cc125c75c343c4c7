#include "experiments/numerics/pareto.h"

#include <algorithm>
#include <map>

namespace tress::experiments {

void add_pareto(std::vector<Row>& rows, std::string_view error,
                const std::function<std::string(const Row&)>& group) {
  struct Run {
    Row* row;
    double wall, error;
  };
  std::map<std::string, std::vector<Run>> groups;
  for (Row& row : rows) {
    if (!row.ok()) continue;
    groups[group(row)].push_back({&row, row.number("wall_s"), row.number(error)});
  }
  for (const auto& [key, runs] : groups) {
    for (const Run& run : runs) {
      const bool dominated = std::ranges::any_of(runs, [&run](const Run& other) {
        return other.wall < run.wall && other.error < run.error;
      });
      run.row->set("pareto", !dominated);
    }
  }
}

}  // namespace tress::experiments
