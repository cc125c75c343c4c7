#include "simulation/fit/fit_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tress::simulation {
namespace {

constexpr double same = 0.05;  // parts of one size

/// "a, b and c"
std::string list(const std::vector<std::string>& all) {
  if (all.size() == 1) return all.front();
  std::string text;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) text += (i > 0 ? ", " : "") + all[i];
  return text + " and " + all.back();
}

std::string in_words(Combination all, double least) {
  std::erase_if(all, [&](const auto& one) { return std::abs(one.part) < least; });
  std::vector<std::string> names;
  for (const auto& [parameter, part] : all) names.push_back(parameter->name);
  const std::string what = "the records do not determine " + list(names);
  const std::string remedy = "; leave out one of them, or give it a prior";
  if (all.size() == 1) {
    return what + ", which hardly moves these points; leave it out, or give it a prior";
  }
  const double size = std::abs(
      std::ranges::max(all, {}, [](const auto& one) { return std::abs(one.part); }).part);
  const double sign = std::copysign(1.0, all.front().part);
  const bool proportional = std::ranges::all_of(all, [&](const auto& one) {
    return one.parameter->positive && std::abs(sign * one.part / size - 1) < same;
  });
  if (proportional) {
    return what +
           " together: points stay where they are if these change in the same "
           "proportion (motion depends on their ratios alone)" +
           remedy;
  }
  std::vector<std::string> changes;
  for (const auto& [parameter, part] : all) {
    const double change = sign * part / size;
    changes.push_back(parameter->positive
                          ? fmt::format("{:+.2g} % of {}", change, parameter->name)
                          : fmt::format("{:+.2g} {} of {}",
                                        0.01 * change * parameter->measure,
                                        parameter->unit, parameter->name));
  }
  return what + " together: " + list(changes) + " hardly move these points" + remedy;
}

}  // namespace

std::string in_words(const std::vector<Combination>& combinations, double least) {
  std::string all;
  for (const Combination& one : combinations) {
    all += (all.empty() ? "" : ". ") + in_words(one, least);
  }
  return all;
}

}  // namespace tress::simulation
