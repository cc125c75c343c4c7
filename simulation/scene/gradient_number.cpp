#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "contract/input_error.h"
#include "simulation/scene/gradient_table.h"

namespace tress::simulation {
namespace {

constexpr double reach = 0.25;  // |s| of a stencil (integrators/gradient)

double or_one(double value) { return value != 0 ? std::abs(value) : 1; }

/// The unit at the end of a help text: "air drag per length (kg/(m s))"; 1 if there is
/// none.
std::string unit_of(const Parameter& p) {
  const std::size_t end = p.help.rfind(')');
  if (end == p.help.npos) return "1";
  int depth = 0;
  for (std::size_t i = end + 1; i-- > 0;) {
    depth += p.help[i] == ')' ? 1 : p.help[i] == '(' ? -1 : 0;
    if (depth == 0) return std::string(p.help.substr(i + 1, end - i - 1));
  }
  return "1";
}

}  // namespace

Vec axis_of(std::size_t k) {
  return {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
}

std::optional<std::size_t> take_component(std::string_view& name) {
  constexpr std::string_view axes = "xyz";
  if (name.size() < 3 || name[name.size() - 2] != '.') return {};
  const std::size_t k = axes.find(name.back());
  if (k == axes.npos) return {};
  name.remove_suffix(2);
  return k;
}

void refuse_gradient(std::string_view name, std::string_view reason,
                     const std::string& place, std::string_view remedy) {
  throw InputError(fmt::format("no gradient by {}: {}", name, reason), place,
                   std::string(remedy));
}

std::string GradientNumber::text(const Parameters& values, double s) const {
  if (!component) return number_text(value + s * measure);
  const Vec v = values.vec(key) + (s * measure) * axis_of(*component);
  return number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z);
}

GradientNumber gradient_number(std::string_view name, std::string_view key,
                               std::span<const Parameter> declared,
                               const Parameters& values, const std::string& place) {
  GradientNumber all;
  all.component = take_component(key);
  all.key = key;
  const auto p = std::ranges::find(declared, key, &Parameter::name);
  if (p == declared.end()) {
    std::vector<std::string_view> known;
    for (const Parameter& one : declared) known.push_back(one.name);
    throw InputError(
        fmt::format("unknown parameter '{}'", name), place,
        suggestion(key, known, fmt::format("use one of: {}", fmt::join(known, ", "))));
  }
  if (p->text || p->rows || p->whole || !p->choices.empty()) {
    refuse_gradient(name, "it is not a number that can change a little", place,
                    "leave it out");
  }
  if (all.component.has_value() != (p->components == 3)) {
    const bool three = p->components == 3;
    refuse_gradient(name, three ? "it has three components" : "it is one number", place,
                    three ? fmt::format("give {}.x, .y or .z", name)
                          : "leave out what follows the last dot");
  }
  all.value =
      all.component ? dot(axis_of(*all.component), values.vec(key)) : values.number(key);
  all.unit = unit_of(*p);
  all.measure = or_one(all.value);
  all.positive = all.value > 0 && p->min >= 0;
  all.min = p->min;
  all.max = p->max;
  if (all.value <= p->min || all.value + reach * all.measure > p->max) {
    refuse_gradient(
        name,
        fmt::format("{:g} is at the end of its range, where a change has no two sides",
                    all.value),
        place, "give it a value inside");
  }
  return all;
}

}  // namespace tress::simulation
