#include "contract/decimal.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace tress {
namespace {

/// Whether a decimal number that is not 0 is below 1, by where its first digit is.
bool below_one(std::string_view text) {
  const std::size_t end = text.find_first_of("eE");
  const std::string_view digits = text.substr(0, end);
  const std::size_t first = digits.find_first_of("123456789");
  const std::size_t point = std::min(digits.find('.'), digits.size());
  // 10^order <= |x| < 10^(order + 1), but for the exponent.
  const auto order = static_cast<long long>(point) - static_cast<long long>(first) -
                     (first < point ? 1 : 0);
  if (end == std::string_view::npos) return order < 0;
  std::string_view exponent = text.substr(end + 1);
  const bool negative = exponent.starts_with('-');
  if (negative || exponent.starts_with('+')) exponent.remove_prefix(1);
  long long by = 0;
  const auto [stop, error] =
      std::from_chars(exponent.data(), exponent.data() + exponent.size(), by);
  if (error != std::errc{}) return negative;
  return negative ? order < by : order + by < 0;
}

}  // namespace

std::optional<double> decimal(std::string_view text) {
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) {
    return std::nullopt;
  }
  if (error == std::errc{}) return x;
  const double sign = text.starts_with('-') ? -1 : 1;
  return below_one(text) ? sign * 0.0 : sign * std::numeric_limits<double>::infinity();
}

}  // namespace tress
