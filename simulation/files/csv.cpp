#include "simulation/files/csv.h"

#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "contract/read_file.h"

namespace tress::simulation {
namespace {

constexpr const char* repair = "repair or delete the file; it must be RFC 4180 CSV";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::string_view other_separators = ";\t |";

[[noreturn]] void refuse_separator(char found, const std::string& file,
                                   const CellPlace& at) {
  throw InputError(fmt::format("columns are separated by {}",
                               found == ' '    ? "spaces"
                               : found == '\t' ? "tabs"
                                               : fmt::format("'{}'", found)),
                   fmt::format("{}:{}:{}", file, at.line, at.column),
                   "separate columns by ',' and write decimals with '.'");
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  bool done() const { return at_ >= text_.size(); }

  /// The cells of the next line; `places` receives where each of them begins.
  std::vector<std::string> line(std::vector<CellPlace>& places) {
    places = {{line_, column_}};
    std::vector<std::string> cells{cell()};
    while (!done() && peek() == ',') {
      step();
      places.push_back({line_, column_});
      cells.push_back(cell());
    }
    if (!done() && peek() == '\r') step();
    if (!done()) {
      if (other_separators.find(peek()) != other_separators.npos) {
        refuse_separator(peek(), file_, {line_, column_});
      }
      if (peek() != '\n') fail("unexpected character after a cell");
      step();
    }
    return cells;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(problem, fmt::format("{}:{}:{}", file_, line_, column_), repair);
  }

 private:
  char peek() const { return text_[at_]; }

  void step() {
    if (text_[at_] == '\0') fail("a NUL byte");  // it would end every message
    column_ = text_[at_] == '\n' ? 1 : column_ + 1;
    line_ += text_[at_] == '\n' ? 1 : 0;
    ++at_;
  }

  std::string cell() { return !done() && peek() == '"' ? quoted() : plain(); }

  std::string plain() {
    std::string cell;
    while (!done() && peek() != ',' && peek() != '\n' && peek() != '\r') {
      if (peek() == '"') fail("quote inside an unquoted cell");
      cell += peek();
      step();
    }
    return cell;
  }

  std::string quoted() {
    std::string cell;
    step();
    while (true) {
      if (done()) fail("quote never closed");
      if (peek() == '"') {
        step();
        if (done() || peek() != '"') return cell;
      }
      cell += peek();
      step();
    }
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
};

}  // namespace

std::string csv_line(std::span<const std::string> cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += ',';
    if (cells[i].find_first_of(",\"\r\n") == std::string::npos) {
      line += cells[i];
      continue;
    }
    line += '"';
    for (const char c : cells[i]) {
      if (c == '"') line += '"';
      line += c;
    }
    line += '"';
  }
  return line + '\n';
}

std::string to_csv(std::span<const std::string> header, std::span<const Row> rows) {
  std::string text = csv_line(header);
  for (Row row : rows) {
    row.set("status", std::string(row.status()));
    text += csv_line(in_order(row, header));
  }
  return text;
}

namespace {

/// Refuses a line of one cell that has parts: names of columns and numbers have none.
void check_separator(const std::vector<std::string>& cells, const std::string& file,
                     CellPlace begin) {
  const std::string_view text = cells.front();
  const std::size_t first = text.find_first_not_of(other_separators),
                    at = text.find_first_of(other_separators, first),
                    next = text.find_first_not_of(other_separators, at);
  if (cells.size() > 1 || std::max({first, at, next}) == text.npos) return;
  begin.column += static_cast<int>(at);
  refuse_separator(text[at], file, begin);
}

}  // namespace

CsvTable parse_csv(std::string_view text, const std::string& file) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  if (text.find_first_not_of(" \t\r\n") == text.npos) return {};
  Reader reader(text, file);
  CsvTable table;
  if (!reader.done()) {
    table.header = reader.line(table.places.emplace_back());
    check_separator(table.header, file, table.places.front().front());
  }
  if (table.header.size() > most_columns) {
    throw InputError(fmt::format("{} columns", table.header.size()), file + ":1",
                     fmt::format("give at most {}", most_columns));
  }
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    const auto rest = table.header.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    if (std::find(rest, table.header.end(), table.header[i]) != table.header.end()) {
      throw InputError("column '" + table.header[i] + "' appears twice", file + ":1",
                       repair);
    }
  }
  while (!reader.done()) {
    const std::vector<std::string> cells = reader.line(table.places.emplace_back());
    if (cells.size() != table.header.size()) {
      check_separator(cells, file, table.places.back().front());
      throw InputError(fmt::format("a line of {} cells, where the header has {}",
                                   cells.size(), table.header.size()),
                       fmt::format("{}:{}:1", file, table.places.back().front().line),
                       "give one cell for each column; a cell may be empty");
    }
    Row& row = table.rows.emplace_back();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!cells[i].empty()) row.set(table.header[i], cells[i]);
    }
  }
  return table;
}

CsvTable read_csv(const std::string& file) {
  return parse_csv(read_file(file, most_table_bytes), file);
}

}  // namespace tress::simulation
