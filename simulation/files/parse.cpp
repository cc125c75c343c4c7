#include "simulation/files/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

constexpr int most_elements = 10'000'000;
constexpr std::size_t most_counts = 10'000;
constexpr double shortest_duration = 1e-3, longest_duration = 9e8;  // s

std::string_view trim(std::string_view text) {
  const std::string_view blank = " \t";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

int parse_count(std::string_view text, const std::string& where) {
  return static_cast<int>(parse_whole(text, where, 1, most_elements));
}

}  // namespace

std::uint64_t parse_whole(std::string_view text, const std::string& where,
                          std::uint64_t min, std::uint64_t max) {
  std::uint64_t x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc{} || end != text.data() + text.size() || x < min || x > max) {
    throw InputError(fmt::format("'{}' is not a whole number in range", text), where,
                     fmt::format("give a whole number from {} to {}", min, max));
  }
  return x;
}

std::vector<std::string> split(std::string_view text, char separator,
                               const std::string& where) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    const std::string_view part = trim(text.substr(at, end - at));
    if (part.empty()) {
      throw InputError(fmt::format("empty entry in '{}'", text), where,
                       fmt::format("separate entries by one '{}'", separator));
    }
    parts.emplace_back(part);
    at = end + 1;
  }
  return parts;
}

std::vector<std::string> listed_files(std::string_view text, const std::string& where) {
  std::error_code error;
  if (std::filesystem::is_regular_file(text, error)) return {std::string(text)};
  return split(text, ',', where);
}

std::vector<int> parse_counts(std::string_view text, const std::string& where) {
  std::vector<int> counts;
  const auto add = [&counts, &where](int count) {
    if (counts.size() >= most_counts) {
      throw InputError(fmt::format("more than {} counts", most_counts), where,
                       "use a larger step: first:last:step");
    }
    if (std::find(counts.begin(), counts.end(), count) == counts.end()) {
      counts.push_back(count);
    }
  };
  for (const std::string& part : split(text, ',', where)) {
    const std::vector<std::string> ends = split(part, ':', where);
    const int first = parse_count(ends[0], where);
    const int last = ends.size() > 1 ? parse_count(ends[1], where) : first;
    const int step = ends.size() > 2 ? parse_count(ends[2], where) : 1;
    if (ends.size() > 3 || last < first) {
      throw InputError(fmt::format("'{}' is not a range", part), where,
                       "give first:last or first:last:step, ascending");
    }
    for (int count = first; count <= last; count += step) add(count);
  }
  return counts;
}

double parse_duration(std::string_view text, const std::string& where) {
  constexpr std::pair<std::string_view, double> units[] = {
      {"", 1.0}, {"ms", 1e-3}, {"s", 1.0}, {"m", 60.0}, {"h", 3600.0}};
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  const std::string_view unit(end,
                              static_cast<std::size_t>(text.data() + text.size() - end));
  for (const auto& [name, seconds] : units) {
    if (error != std::errc{} || !std::isfinite(x) || unit != name) continue;
    const double duration = x * seconds;
    if (duration >= shortest_duration && duration <= longest_duration) return duration;
    throw InputError(fmt::format("'{}' is out of range", text), where,
                     "give 1ms to 250000h");
  }
  throw InputError(fmt::format("'{}' is not a duration", text), where,
                   "give a positive number with ms, s, m or h, as in 10m");
}

std::pair<int, int> parse_shard(std::string_view text, const std::string& where) {
  const std::vector<std::string> parts = split(text, '/', where);
  if (parts.size() == 2) {
    const int count = parse_count(parts[1], where);
    const int index = parse_count(parts[0], where);
    if (index <= count) return {index, count};
  }
  throw InputError(fmt::format("'{}' is not a shard", text), where,
                   "give i/n with 1 <= i <= n, as in 2/5");
}

}  // namespace tress::simulation
