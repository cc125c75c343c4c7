#pragma once

#include <string>

#include "contract/parameters.h"

namespace tress::simulation {

/// Reads the rows of a parameter from a text file and returns them as text for
/// Parameters::set(). A line is a row of numbers, with commas, semicolons or blanks
/// between them. Empty lines, lines that begin with #, and one header line before the
/// first row are skipped. Throws InputError naming file and line if a row has another
/// number of numbers than the parameter, or one is not a number. Also throws if there is
/// no row, or no such file. O(bytes).
std::string rows_of_file(const Parameter& p, const std::string& file);

}  // namespace tress::simulation
