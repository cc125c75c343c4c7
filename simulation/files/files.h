#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"
#include "contract/read_file.h"

namespace tress::simulation {

/// An open file; closed on every path.
class File {
 public:
  /// Opens a file as open(2) with mode 0644; throws InputError naming `file` on failure.
  File(const std::string& file, int flags);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  /// Returns the descriptor of the operating system.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Writes all bytes to the descriptor; throws InputError naming `file` when it cannot
/// (disk full, file too large, device gone).
void write_all(int descriptor, std::string_view text, const std::string& file);

/// The new content of a file, written in pieces to a temporary neighbour.
class Replacement {
 public:
  /// Opens the neighbour of `file`. Throws InputError if that fails.
  explicit Replacement(std::string file);
  ~Replacement();  // without keep(): the file stays as it was
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  /// Appends bytes to the new content.
  void write(std::string_view bytes);
  /// Writes over the first bytes.
  void write_over(std::string_view bytes);
  /// Syncs the neighbour, then renames it over the file.
  void keep();

 private:
  std::string file_, temporary_;
  std::optional<File> output_;
};

/// Writes to a temporary neighbour, syncs it, then renames it over `file`: readers see
/// the old content or the new, never a partial one.
void replace_file(const std::string& file, std::string_view text);

/// Refuses, before any work, an output that could not be written at the end: a directory,
/// a link, a device, a missing or unwritable parent.
void check_output(const std::string& file);

/// Refuses an output that is a symbolic link: what it leads to may be anybody's file.
void refuse_link(const std::string& file);

/// Removes what Replacements of killed processes have left of files <stem>.* and of those
/// in folders <stem>_*. To be called by the only process that writes them.
void remove_leftovers(const std::string& stem);

/// A folder for results: made, with those above it, if it is not there. What was made and
/// is empty in the end is removed again.
class ReadyFolder {
 public:
  /// Throws InputError naming `place`, where it was asked for, when it cannot be made.
  ReadyFolder(const std::string& folder, const std::string& place);
  ~ReadyFolder();
  ReadyFolder(const ReadyFolder&) = delete;
  ReadyFolder& operator=(const ReadyFolder&) = delete;

 private:
  void remove_empty() const;

  std::vector<std::string> made_;  // innermost first
};

/// `file` without a final ".csv", followed by `ending`.
std::string beside(const std::string& file, std::string_view ending);

}  // namespace tress::simulation
