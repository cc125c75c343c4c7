#pragma once

#include <string>

#include "experiments/run/command_line.h"

namespace tress::experiments {

/// Reads an options file into `line`; options already given on the command line are kept.
/// Top-level keys: title, models, integrators, elements, timeout, repeat, seed, quick,
/// full, and the table [settings] with what `--set` accepts. Throws InputError with
/// file:line:column on malformed TOML, NUL bytes, unknown keys and values of the wrong
/// type.
void read_options_file(const std::string& file, CommandLine& line);

}  // namespace tress::experiments
