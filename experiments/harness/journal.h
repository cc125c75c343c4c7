#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/harness/row.h"

namespace tress {

/// What must agree between the run that wrote a journal and the one that resumes it.
struct JournalKey {
  std::string experiment;
  std::string settings;  // --set, seed and the like, in canonical order
  std::vector<std::string> header;
  bool operator==(const JournalKey&) const = default;
};

/// Rows as they finish, one JSON line each, so that nothing finished is ever lost. One
/// process at a time holds a journal; a last line torn by a kill is dropped on opening.
class Journal {
 public:
  enum class Mode { fresh, resume };

  /// Throws InputError when the file cannot be written, another process holds it, an
  /// unfinished journal exists and the mode is `fresh`, or its key differs.
  Journal(std::string file, const JournalKey& key, Mode mode);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::vector<Row>& rows() const { return rows_; }  // found on opening
  void append(const Row& row);                            // written at once
  void remove();

 private:
  void lock();
  void load(const JournalKey& key, Mode mode);

  std::string file_;
  int descriptor_;
  std::vector<Row> rows_;
  std::chrono::steady_clock::time_point synced_;
};

/// A row as one line of JSON without its end of line, and back; parse throws
/// std::runtime_error on text that is not such a line.
std::string to_json_line(const Row& row);
Row from_json_line(std::string_view line);

}  // namespace tress
