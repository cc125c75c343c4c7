#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/parameters.h"
#include "integrators/catalogue.h"

namespace tress::integrators {

/// The fields of Options that `--set` reaches, with units, ranges and choices.
std::span<const Parameter> common_options();

/// common_options(), followed by the method-specific options.
std::span<const Parameter> integrator_options();

/// The methods that read this option of their own; none for those of common_options().
std::vector<const IntegratorEntry*> readers_of_option(std::string_view key);

/// Sets one option from text; throws InputError naming `where` on an unknown key, a
/// malformed or non-finite number, or a value out of range.
void apply(Options& options, std::string_view key, std::string_view value,
           const std::string& where);

/// The field as text that apply() reads back exactly.
std::string text_of(const Options& options, std::string_view key);

}  // namespace tress::integrators
