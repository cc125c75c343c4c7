#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/machine.h"
#include "experiments/run/row_loads.h"

namespace tress::experiments {

/// Provenance of a table, written next to it as <table>.meta.json.
class Manifest {
 public:
  /// Records machine and SUNDIALS before the work starts. Warns on standard error when
  /// SUNDIALS is a slow build or the machine is busy. Also warns when the source tree has
  /// another commit checked out than that of the program's build.
  Manifest(const Experiment& experiment, const CommandLine& line);

  /// A file that the work depends on, stored with its text and checksum.
  void add_input(std::string file, std::string text);

  /// Sets the outcome of a program without a table: the cells of its one row, by
  /// column.
  void set_outcome(Row row) { outcome_ = std::move(row); }

  /// Sets the load of other programs during the timings.
  void set_load(RowLoads& loads);

  /// The JSON text, with end time, load and the counts of `rows`.
  std::string finished(const std::vector<Row>& rows, const Verdicts& verdicts,
                       std::size_t kept_from_before) const;

 private:
  const Experiment& experiment_;
  const CommandLine& line_;
  std::array<double, 3> load_;
  double sundials_ratio_;
  std::string start_;
  std::vector<std::pair<std::string, std::string>> inputs_;  // names and texts
  std::optional<Row> outcome_;
  nlohmann::ordered_json load_during_;  // null: not measured
};

/// Returns the manifest next to a table, if it exists; `discarded` if it is no JSON.
std::optional<nlohmann::json> manifest_of(const std::string& table);

/// Whether the executable that runs now made that table.
bool made_by_this_program(const nlohmann::json& manifest);

/// Names and checksums of the plug-ins that are loaded, a blank before each; empty
/// without.
std::string plugins_text();

/// "--set", plug-ins, seed, quick and the like in canonical order: a resumed run must
/// repeat them.
std::string settings_text(const CommandLine& line);

}  // namespace tress::experiments
