#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/layers.h"
#include "contract/parameters.h"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace tress::experiments {

enum class ProgressMode { automatic, none, json };

/// The user's options: the command line overrides the options file, which overrides these
/// defaults.
struct CommandLine {
  std::vector<std::string> models, integrators;  // empty: the experiment's choice
  std::vector<int> elements;                     // empty: the experiment's choice
  std::string options_file;
  std::vector<std::pair<std::string, std::string>> set;
  std::vector<std::string> plugins;  // shared libraries
  std::string out;                   // "-": standard output
  std::vector<std::string> merge;    // tables to join instead of running
  std::vector<std::string> run_ids;  // rows to run; empty: all that the options select
  bool quick = false, full = false, resume = false, retry_failed = false;
  bool list = false, dry_run = false, check = false;
  int jobs = 1, repeat = 3;
  int shard_index = 1, shard_count = 1;
  double timeout_s = 600;
  std::uint64_t seed = 1;
  ProgressMode progress = ProgressMode::automatic;

  std::vector<std::string> argv;
  /// Place where each option, or setting (as "set:key"), was given: "--models" or
  /// "options.toml:3:1". For messages.
  std::map<std::string, std::string, std::less<>> places;
  std::string place(std::string_view option) const;
  /// Whether the table lacks rows of its experiment: one shard, or rows by run_id.
  bool partial() const { return shard_count > 1 || !run_ids.empty(); }
};

/// An option of one experiment: --name VALUE is short for --set key=VALUE. It replaces a
/// shared option of the same name.
struct OwnOption {
  std::string_view name, key, help;
  /// VALUE is a file: the default table is results/<experiment>.<file>.csv.
  bool names_table = false;
};

/// A shared option without effect in this experiment: --help omits it, and using it is an
/// error with this reason.
struct Unused {
  std::string_view option, why;
};
inline constexpr Unused not_random{"seed", "nothing in it is random"};
inline constexpr Unused not_repeated{"repeat", "no row is timed more than once"};

/// Whether a choice such as --models includes `id`; an empty choice includes everything.
bool wanted(const std::vector<std::string>& chosen, std::string_view id);

/// Numbers of rows that --quick and --full run, with what differs otherwise. With --quick
/// also the wall time of ./tress run on two idle cores.
struct Sizes {
  std::string_view quick = "fewest rows", full = "most rows";
};

/// The user asked for help or the version: print `what()` and leave with 0.
class Answer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws InputError on anything unknown, malformed or given twice, Answer on --help and
/// --version. `example` completes "<name> ..." in the help text, which shows `keys`, the
/// experiment's own of --set.
CommandLine parse_command_line(std::string_view name, std::string_view question,
                               std::string_view example, int argc,
                               const char* const* argv,
                               std::span<const OwnOption> own = {},
                               std::span<const Unused> unused = {},
                               std::span<const Parameter> keys = {},
                               const Sizes& sizes = {});

/// Throws an InputError for a command line that `app` cannot parse. The message names the
/// offending argument; the remedy is its present name, the nearest option or --help.
[[noreturn]] void refuse_arguments(const CLI::App& app, std::string_view name, int argc,
                                   const char* const* argv, const CLI::ParseError& error);

/// "name   help [default]", a line for each.
std::string parameter_lines(std::span<const Parameter> parameters);

}  // namespace tress::experiments
