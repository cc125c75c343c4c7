#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/files/row.h"

namespace tress::simulation {

/// Position of a cell's start in a file, counted from 1.
struct CellPlace {
  int line = 1, column = 1;  // line and column
};

/// A table as read: every line has the number of cells of the header.
struct CsvTable {
  std::vector<std::string> header;  // names of the columns
  std::vector<Row> rows;            // lines below the header
  /// Positions of all cells, header first: those of rows[i] are places[i + 1].
  std::vector<std::vector<CellPlace>> places;
};

/// RFC 4180: comma, quotes around cells that hold comma, quote or line break, quotes
/// doubled. Lines end with '\n' alone, which every reader accepts and which diffs well.
std::string csv_line(std::span<const std::string> cells);

/// Header and rows; status "ok" is written where a row has no other status.
std::string to_csv(std::span<const std::string> header, std::span<const Row> rows);

/// Limit of a table that is read; in memory it is a hundred times as large.
constexpr std::size_t most_table_bytes = 16 << 20;
/// Limit of the columns of a table that is read.
constexpr std::size_t most_columns = 128;

/// Accepts "\n" and "\r\n". A blank text is an empty table. Throws InputError with
/// `file`:line:column on a stray or unclosed quote and on a line of the wrong length.
/// Also throws on other separators than commas, on a repeated column name and on more
/// than most_columns columns.
CsvTable parse_csv(std::string_view text, const std::string& file);

/// Reads and parses a file. Throws InputError as parse_csv().
CsvTable read_csv(const std::string& file);

}  // namespace tress::simulation
