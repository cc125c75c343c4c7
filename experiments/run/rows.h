#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/run/experiment.h"

namespace tress::experiments {

/// Rows by run_id, in output order.
class Rows {
 public:
  void keep(Row row) {
    const std::string id(row.text("run_id"));
    const auto [place, fresh] = place_.emplace(id, rows_.size());
    if (fresh) {
      rows_.push_back(std::move(row));
    } else {
      rows_[place->second] = std::move(row);
    }
  }
  const Row* find(const std::string& id) const {
    const auto place = place_.find(id);
    return place == place_.end() ? nullptr : &rows_[place->second];
  }
  const std::vector<Row>& all() const { return rows_; }

  /// The planned rows first, in their order, then those of earlier plans.
  std::vector<Row> ordered(const std::vector<Case>& plan) const {
    std::vector<Row> result;
    std::set<std::string_view> taken;
    for (const Case& work : plan) {
      const std::string id(work.identity.text("run_id"));
      // The run_ids of a case's further rows append a point to its own.
      for (auto at = place_.lower_bound(id);
           at != place_.end() && (at->first == id || at->first.starts_with(id + '.'));
           ++at) {
        const Row& row = rows_[at->second];
        result.push_back(row);
        taken.insert(row.text("run_id"));
      }
    }
    for (const Row& row : rows_) {
      if (taken.count(row.text("run_id")) == 0) result.push_back(row);
    }
    return result;
  }

 private:
  std::vector<Row> rows_;
  std::map<std::string, std::size_t> place_;
};

/// Returns the run_ids of a list such as a,b. Throws InputError on a text that no row
/// has, before the rows are planned, which may take minutes.
std::vector<std::string> parse_run_ids(const std::string& list);

/// Returns the cases with the rows that --run-id names, all without that option. Throws
/// InputError on a run_id that no case has.
std::vector<Case> chosen_rows(std::vector<Case> cases, const CommandLine& line);

/// Tells verdicts and the number of rows by status on standard error; returns the exit
/// code.
int report_table(const Experiment& experiment, const CommandLine& line,
                 const std::vector<Row>& rows, const Verdicts& verdicts);

}  // namespace tress::experiments
