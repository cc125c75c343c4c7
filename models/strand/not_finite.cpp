#include "models/strand/not_finite.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tress::models {

std::string not_finite_place(In values, std::size_t each, std::string_view words,
                             std::size_t first) {
  const auto found =
      std::ranges::find_if(values, [](double x) { return !std::isfinite(x); });
  if (found == values.end()) return {};
  const auto place = static_cast<std::size_t>(found - values.begin()) / each;
  return std::string(words) + " " + std::to_string(first + place);
}

std::string not_finite_load(const Effects& effects, double t, const Points& p) {
  std::vector<double> load(3 * static_cast<std::size_t>(p.count));
  for (const auto& effect : effects) {
    std::ranges::fill(load, 0.0);
    effect->add_load(t, p, load);
    std::string words =
        not_finite_place(load, 3, std::string(effect->name()) + " at point");
    if (!words.empty()) return words;
  }
  return {};
}

std::string not_finite_clamp(const Vec& x, const Vec& v, const Vec& a) {
  const bool finite = is_finite(x) && is_finite(v) && is_finite(a);
  return finite ? "" : "motion of the clamp";
}

}  // namespace tress::models
