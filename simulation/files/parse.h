#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/layers.h"

namespace tress::simulation {

/// "1,2,5,10:40:10" -> 1 2 5 10 20 30 40: counts and first:last:step ranges (step 1 when
/// left out), in the order given, repeats dropped. `where` is quoted in the InputError.
std::vector<int> parse_counts(std::string_view text, const std::string& where);

/// "10m", "30s", "1.5h", "200ms"; a bare number is in seconds. Result in s, from a
/// millisecond to 30 years, the range of the timeout clocks.
double parse_duration(std::string_view text, const std::string& where);

/// "2/5" -> {2, 5}, 1 <= first <= second.
std::pair<int, int> parse_shard(std::string_view text, const std::string& where);

/// A whole number in [min, max].
std::uint64_t parse_whole(std::string_view text, const std::string& where,
                          std::uint64_t min = 0,
                          std::uint64_t max = std::numeric_limits<std::uint64_t>::max());

/// Splits at `separator`, trims spaces, rejects empty parts.
std::vector<std::string> split(std::string_view text, char separator,
                               const std::string& where);

/// Returns the files that a list such as "a,b" names. A text that is the name of a file
/// is that file, with its commas. Throws InputError for an empty entry.
std::vector<std::string> listed_files(std::string_view text, const std::string& where);

}  // namespace tress::simulation
