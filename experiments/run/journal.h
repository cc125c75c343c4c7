#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/files/locked_file.h"
#include "simulation/files/row.h"
#include "simulation/files/run_key.h"

namespace tress::experiments {

/// Finished rows, one checksummed line of JSON each, so that no finished row is lost. One
/// process at a time holds a journal; opening drops a last line torn by a kill.
class Journal {
 public:
  enum class Mode { fresh, resume };

  /// Throws InputError when the file cannot be written, another process holds it, an
  /// unfinished journal exists and the mode is `fresh`, its key differs, or a line is
  /// corrupt.
  Journal(std::string file, const RunKey& key, Mode mode);

  const std::vector<Row>& rows() const { return rows_; }  // found on opening
  /// Appends a row and writes it at once.
  void append(const Row& row);
  void remove();

 private:
  void load(const RunKey& key, Mode mode);

  std::string name_;
  LockedFile file_;
  std::vector<Row> rows_;
  std::chrono::steady_clock::time_point synced_;
};

/// A row as one line of JSON without the newline, and back; from_json_line throws
/// std::runtime_error on malformed text.
std::string to_json_line(const Row& row);
Row from_json_line(std::string_view line);

}  // namespace tress::experiments
