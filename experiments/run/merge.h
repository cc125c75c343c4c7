#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/files/csv.h"

namespace tress::experiments {

struct Merged {
  std::vector<Row> rows;               // one per run_id, in the order said below
  std::vector<std::string> conflicts;  // one line per pair of contradictory rows
};

/// Joins tables of one experiment. Among rows with the same run_id an ok row wins over a
/// failed one, otherwise the first wins; two ok rows that differ outside the timing
/// columns are a conflict. Rows come in order of first appearance; those of parts
/// (--shard) as one process would have written them. Throws InputError in these cases:
///
/// - A table's header is not the experiment's.
/// - A part is missing or given twice.
/// - A part was made by other code or, by its manifest, with other options than
///   `settings`.
/// - Some tables are parts and others are not.
Merged merge(std::span<const std::string> files, std::span<const Column> columns,
             std::string_view settings);

/// Throws InputError unless `table` has the experiment's current columns.
void check_header(const CsvTable& table, std::span<const Column> columns,
                  const std::string& file);

}  // namespace tress::experiments
