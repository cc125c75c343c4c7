#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulation/files/csv.h"

namespace tress::experiments {

struct Merged {
  std::vector<Row> rows;               // one per run_id, in order of first appearance
  std::vector<std::string> conflicts;  // one line each: which rows contradict each other
};

/// Joins tables of one experiment. Of rows with the same run_id an ok one wins over a
/// failed one, else the first; two ok rows that differ outside the timing columns are a
/// conflict. Throws InputError when a table's header is not the experiment's.
Merged merge(std::span<const std::string> files, std::span<const Column> columns);

/// Throws InputError unless `table` has the columns that the experiment writes today.
void check_header(const CsvTable& table, std::span<const Column> columns,
                  const std::string& file);

}  // namespace tress::experiments
