#include "experiments/run/merge.h"

#include <fmt/format.h>

#include <map>

#include "contract/input_error.h"

namespace tress::experiments {
namespace {

/// Name of the first column, except timings, in which the rows differ; empty if none.
std::string_view difference(const Row& a, const Row& b, std::span<const Column> columns) {
  for (const Column& column : columns) {
    if (!column.timing && a.text(column.name) != b.text(column.name)) return column.name;
  }
  return a.status() == b.status() ? std::string_view{} : "status";
}

}  // namespace

void check_header(const CsvTable& table, std::span<const Column> columns,
                  const std::string& file) {
  const std::vector<std::string> expected = header(columns);
  if (table.header == expected) return;
  std::string first = "fewer columns";
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    if (i >= expected.size() || table.header[i] != expected[i]) {
      first = fmt::format("column {} is '{}'", i + 1, table.header[i]);
      break;
    }
  }
  throw InputError("the table has other columns than this experiment writes: " + first,
                   file + ":1", "give a table of this experiment and version");
}

Merged merge(std::span<const std::string> files, std::span<const Column> columns) {
  Merged merged;
  std::map<std::string, std::size_t, std::less<>> place;
  for (const std::string& file : files) {
    const CsvTable table = read_csv(file);
    check_header(table, columns, file);
    for (const Row& row : table.rows) {
      const std::string id(row.text("run_id"));
      const auto [found, fresh] = place.emplace(id, merged.rows.size());
      if (fresh) {
        merged.rows.push_back(row);
        continue;
      }
      Row& kept = merged.rows[found->second];
      if (!kept.ok() && row.ok()) {
        kept = row;
      } else if (kept.ok() && row.ok()) {
        const std::string_view column = difference(kept, row, columns);
        if (column.empty()) continue;
        merged.conflicts.push_back(
            fmt::format("run_id {}: {} is '{}' and in {} '{}'; the first is kept", id,
                        column, kept.text(column), file, row.text(column)));
      }
    }
  }
  return merged;
}

}  // namespace tress::experiments
