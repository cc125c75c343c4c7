#include "experiments/run/row_loads.h"

#include <algorithm>
#include <utility>

namespace tress::experiments {
namespace {

/// s: the system counts time in hundredths, which are a few percent of this.
constexpr double shortest_measurement = 0.5;

}  // namespace

double RowLoads::finished(std::string run_id) {
  pending_.push_back(std::move(run_id));
  if (others_.seconds() >= shortest_measurement) measure();
  return last_;
}

std::set<std::string> RowLoads::above() {
  if (!pending_.empty()) measure();
  return above_;
}

void RowLoads::measure() {
  const double load = last_ = others_.processors();
  largest_ = std::max(largest_, load);
  for (const std::string& row : std::exchange(pending_, {})) {
    if (load > most_load) {
      above_.insert(row);
    } else {
      above_.erase(row);
    }
  }
}

}  // namespace tress::experiments
