#include "simulation/table/rows_file.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "contract/input_error.h"
#include "contract/read_file.h"

namespace tress::simulation {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;
constexpr std::string_view between = " \t\r,;";

std::vector<std::string_view> words_of_line(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t from = line.find_first_not_of(between); from < line.size();) {
    const std::size_t to = std::min(line.find_first_of(between, from), line.size());
    std::string_view word = line.substr(from, to - from);
    if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
    words.push_back(word);
    from = line.find_first_not_of(between, to);
  }
  return words;
}

bool is_number(std::string_view word) {
  double x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  return error == std::errc() && end == word.data() + word.size();
}

/// The first word of a line that is not a number.
std::optional<std::string_view> stranger(const std::vector<std::string_view>& words) {
  for (const std::string_view word : words) {
    if (!is_number(word)) return word;
  }
  return {};
}

}  // namespace

std::string rows_of_file(const Parameter& p, const std::string& file) {
  const std::string all = read_file(file, most_bytes);
  const auto count = static_cast<std::size_t>(p.components);
  std::string text;
  bool header = false;
  std::size_t number = 0;
  for (std::size_t from = 0; from < all.size();) {
    const std::size_t to = std::min(all.find('\n', from), all.size());
    const std::vector<std::string_view> words =
        words_of_line(std::string_view(all).substr(from, to - from));
    from = to + 1;
    ++number;
    if (words.empty() || words.front().starts_with('#')) continue;
    const std::string where = fmt::format("{}:{}", file, number);
    if (const auto bad = stranger(words)) {
      if (text.empty() && !header) {
        header = true;
        continue;
      }
      throw InputError(fmt::format("'{}' is not a number", printable(std::string(*bad))),
                       where, "give rows of numbers");
    }
    refuse_if(
        words.size() != count,
        fmt::format("a row of {} numbers where {} has {}", words.size(), p.name, count),
        where, fmt::format("give rows of {}: {}", count, p.help));
    if (!text.empty()) text += ';';
    text += fmt::format("{}", fmt::join(words, ","));
  }
  refuse_if(text.empty(), fmt::format("no row of {}", p.name), file,
            fmt::format("give a row of {} numbers in each line", count));
  return text;
}

}  // namespace tress::simulation
