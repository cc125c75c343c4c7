#include "simulation/table/rows_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "contract/input_error.h"
#include "contract/read_file.h"

namespace tress::simulation {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;
constexpr std::string_view blanks = " \t\r", separators = ",;";
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// The cells of a line: between commas or semicolons, and between blanks.
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  bool empty = false;  // whether a separator came last, after which a cell is due
  for (std::size_t from = 0; from < line.size();) {
    const char c = line[from];
    if (blanks.find(c) != blanks.npos) {
      ++from;
    } else if (separators.find(c) != separators.npos) {
      if (empty || cells.empty()) cells.emplace_back();
      empty = true;
      ++from;
    } else {
      const std::size_t to = std::min(line.find_first_of(" \t\r,;", from), line.size());
      std::string_view cell = line.substr(from, to - from);
      if (cell.size() > 1 && cell.front() == '+') cell.remove_prefix(1);
      cells.push_back(cell);
      empty = false;
      from = to;
    }
  }
  if (empty) cells.emplace_back();
  return cells;
}

bool is_number(std::string_view word) {
  double x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(x);
}

}  // namespace

std::string rows_of_file(const Parameter& p, const std::string& file) {
  const std::string all = read_file(file, most_bytes);
  const auto count = static_cast<std::size_t>(p.components);
  std::string text;
  bool header = false;
  std::size_t number = 0;
  for (std::size_t from = all.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
       from < all.size();) {
    const std::size_t to = std::min(all.find('\n', from), all.size());
    const auto cells = cells_of(std::string_view(all).substr(from, to - from));
    from = to + 1;
    ++number;
    if (cells.empty() || cells.front().starts_with('#')) continue;
    const std::string where = fmt::format("{}:{}", file, number);
    const auto numbers = std::ranges::count_if(cells, is_number);
    if (numbers == 0 && text.empty() && !header) {
      header = true;
      continue;
    }
    for (const std::string_view cell : cells) {
      if (is_number(cell)) continue;
      throw InputError(cell.empty()
                           ? std::string("a cell is empty")
                           : fmt::format("'{}' is not a number", printable(cell)),
                       where, "give rows of finite numbers");
    }
    refuse_if(
        cells.size() != count,
        fmt::format("a row of {} numbers where {} has {}", cells.size(), p.name, count),
        where, fmt::format("give rows of {}: {}", count, p.help));
    if (!text.empty()) text += ';';
    text += fmt::format("{}", fmt::join(cells, ","));
  }
  refuse_if(text.empty(), fmt::format("no row of {}", p.name), file,
            fmt::format("give a row of {} numbers in each line", count));
  return text;
}

}  // namespace tress::simulation
