#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// One column of a result table; the unit is part of the name ("dt_s", "error_rel").
struct Column {
  std::string_view name;  // name in the header
  std::string_view help;  // meaning, with values and conditions
  bool timing = false;    // differs from run to run: ignored when two rows are compared
};

/// One row of a result table: text by column name. Unset columns and numbers that are not
/// finite are empty cells. Numbers are written by std::to_chars, the shortest text that
/// reads back to the same bits (at most 17 significant digits).
class Row {
 public:
  /// Name of a column and the cell's text.
  using Cell = std::pair<std::string, std::string>;

  /// Sets a cell to a text.
  Row& set(std::string_view column, std::string_view text);
  /// Sets a cell to a text.
  Row& set(std::string_view column, const char* text) {
    return set(column, std::string_view(text));
  }
  /// Sets a cell to a text.
  Row& set(std::string_view column, const std::string& text) {
    return set(column, std::string_view(text));
  }
  /// Sets a cell to a number; empty if it is not finite.
  Row& set(std::string_view column, double x);
  /// Sets a cell to "true" or "false".
  Row& set(std::string_view column, bool yes) {
    return set(column, yes ? "true" : "false");
  }
  /// Sets a cell to a whole number.
  template <std::integral T>
  Row& set(std::string_view column, T x) {
    return set(column, std::string_view(std::to_string(x)));
  }

  /// Records a failure: unstable, diverged, timeout, solver_error, refused,
  /// below_reference ... and the time or location.
  Row& failed(std::string_view status, std::string_view reason);

  /// Returns true if the column is set.
  bool has(std::string_view column) const;
  /// Returns the text of a column; empty when unset.
  std::string_view text(std::string_view column) const;
  double number(std::string_view column) const;  // NaN when empty or not a number
  std::string_view status() const;               // "ok" unless failed
  /// Returns true unless failed() was called.
  bool ok() const { return status() == "ok"; }
  /// Returns all cells that are set, in the order of the calls.
  std::span<const Cell> cells() const { return cells_; }

 private:
  std::vector<Cell> cells_;
};

/// Layout of the rows that one experiment writes; increased when the meaning changes, so
/// that older tables are not resumed.
constexpr int schema_version = 1;

/// Identifies a row across runs: 16 hexadecimal digits hashed from the experiment's name,
/// the identity cells sorted by column, and the schema version.
std::string run_id(std::string_view experiment, const Row& identity);

/// The texts of some columns, "a/b/", to group rows by.
std::string joined(const Row& row, std::initializer_list<std::string_view> columns);

/// "a=1 b=2" for messages.
std::string describe(const Row& identity);

/// The experiment's columns followed by status, reason and run_id.
std::vector<std::string> header(std::span<const Column> columns);

/// The row's cells in the order of `header`; throws std::logic_error when the row holds a
/// column that the header lacks.
std::vector<std::string> in_order(const Row& row, std::span<const std::string> header);

}  // namespace tress::simulation
