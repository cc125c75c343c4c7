#pragma once

#include <span>
#include <string>
#include <string_view>

#include "contract/integrator.h"
#include "contract/parameters.h"

namespace tress {

/// The fields of Options that `--set` reaches, with units, ranges and choices.
std::span<const Parameter> integrator_options();

/// Sets one field from text; throws InputError naming `where` on an unknown key, a
/// malformed or non-finite number, or a value out of range.
void apply(Options& options, std::string_view key, std::string_view value,
           const std::string& where);

/// The field as text that apply() reads as the same.
std::string text_of(const Options& options, std::string_view key);

}  // namespace tress
