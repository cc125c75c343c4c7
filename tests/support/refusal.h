#pragma once

#include <functional>
#include <string>

#include "contract/input_error.h"

namespace tress::testing_support {

/// Why an act is refused as bad input; empty: it is not.
inline std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace tress::testing_support
