#pragma once

#include <string>

#include "contract/parameters.h"

namespace tress::simulation {

/// Reads the rows of a parameter from a text file and returns them as text for
/// Parameters::set(). A line is a row of numbers, with commas, semicolons or blanks
/// between them. Empty lines, lines that begin with #, and a first line without any
/// number are skipped. Throws InputError naming file and line if a row has another number
/// of numbers than the parameter, or a cell is empty or no finite number. Also throws if
/// there is no row, or no such file. O(bytes).
std::string rows_of_file(const Parameter& p, const std::string& file);

}  // namespace tress::simulation
