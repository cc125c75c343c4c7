#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "models/strand/strand_parameters.h"

namespace tress::testing_support {

using namespace models;

using Settings = std::vector<std::pair<std::string_view, std::string_view>>;

inline Parameters strand_parameters(const Settings& settings) {
  Parameters parameters(models::strand_parameters(), "model test");
  for (const auto& [key, value] : settings) parameters.set(key, value);
  return parameters;
}

inline constexpr std::string_view root_choices[] = {
    "fixed", "shake", "rotate", "shake_rotate", "swing", "stop", "drop_pull", "free"};
inline constexpr std::string_view tangent_choices[] = {"x", "down", "up"};

}  // namespace tress::testing_support
