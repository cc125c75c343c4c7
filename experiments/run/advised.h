#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/run/command_line.h"

namespace tress::experiments {

/// Prints the advice to standard output, one sentence a line.
void print_advice(const std::vector<std::string>& lines);

/// The answer of a study about the user's own scene (--scene), a line each, and where the
/// table is, on standard output. Nothing where the study chose its scenes, or where the
/// table itself goes there.
void print_answer(const CommandLine& line, std::vector<std::string> lines);

/// Writes the advised scene as <scene>.advised.toml next to the table, and prints the
/// name of the file.
void write_advised(std::string_view experiment, const CommandLine& line,
                   const std::string& scene, const std::string& text);

}  // namespace tress::experiments
