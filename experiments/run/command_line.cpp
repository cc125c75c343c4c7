#include "experiments/run/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "contract/renamed.h"
#include "experiments/run/options_file.h"
#include "experiments/run/rows.h"
#include "simulation/files/build_facts.h"
#include "simulation/files/parse.h"

namespace tress::experiments {
namespace {

constexpr int most_jobs = 1024;
constexpr int most_repeats = 1'000'000;

/// Options as CLI11 collects them: text, so that our own messages can name location and
/// remedy.
struct Raw {
  std::string models, integrators, elements, options, scene, out, shard, timeout,
      progress, run_ids;
  std::string jobs, repeat, seed;
  std::vector<std::string> set, plugins;
  std::vector<std::string> own;  // the experiment's own options
};

/// Whether an option of the experiment replaces the shared one.
bool takes_place(std::span<const OwnOption> own, std::string_view name) {
  return std::ranges::find(own, name, &OwnOption::name) != own.end();
}

void declare(CLI::App& app, CommandLine& line, Raw& raw, std::span<const OwnOption> own,
             const Sizes& sizes) {
  app.add_flag("--list", line.list,
               "print models, integrators and which integrator drives which model");
  app.add_option("--models", raw.models, "models to run, as in a,b");
  app.add_option("--integrators", raw.integrators, "integrators to run, as in a,b");
  app.add_option("--elements", raw.elements, "element counts, as in 1,2,5,10:40:10");
  raw.own.resize(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    app.add_option("--" + std::string(own[i].name), raw.own[i], std::string(own[i].help));
  }
  if (!takes_place(own, "scene")) app.add_option("--scene", raw.scene)->group("");
  app.add_option(
         "--plugin", raw.plugins,
         "shared library of further models, integrators, effects (docs/plugins.md); "
         "repeatable")
      ->allow_extra_args(false);
  app.add_option("--options", raw.options, "TOML file with any of these options");
  app.add_option("--set", raw.set,
                 "key=value for the experiment, integrators or models; repeatable")
      ->allow_extra_args(false);
  app.add_option("--out", raw.out,
                 "result table (default results/<experiment>.csv), or -");
  app.add_flag("--quick", line.quick, fmt::format("as ./tress run: {}", sizes.quick));
  app.add_flag("--full", line.full, std::string(sizes.full));
  app.add_option(
      "--jobs", raw.jobs,
      "rows run at the same time (default: the number of processors, or 1 where "
      "time is measured)");
  app.add_option("--shard", raw.shard,
                 "run part i of n, as in 1/4; its table is named so, as in x.1-of-4.csv");
  app.add_option("--run-id", raw.run_ids,
                 "rows with these run_ids, as in a,b; other options must select them");
  app.add_option("--merge", line.merge, "join tables of this experiment into --out")
      ->allow_extra_args(true);
  app.add_option("--timeout", raw.timeout,
                 "time limit per row, as in 30s, 10m, 2h (default 10m; with --quick 1m "
                 "or more). It ends rows that hang; max_work bounds their work");
  app.add_option("--repeat", raw.repeat, "repeats of every timing (default 3)");
  app.add_flag("--resume", line.resume, "keep the rows that an earlier run finished");
  app.add_flag("--retry-failed", line.retry_failed, "redo failed rows, with --resume");
  app.add_option("--seed", raw.seed, "seed of every random choice (default 1)");
  app.add_option("--progress", raw.progress, "auto, none or json (default auto)");
  app.add_flag("--dry-run", line.dry_run, "print the rows that would run");
  app.add_flag("--check", line.check,
               "check options, outputs and an unfinished run; run nothing");
}

std::string help_text(const CLI::App& app, std::string_view name,
                      std::string_view example, std::span<const Parameter> keys) {
  std::string options = app.help();
  options.erase(options.find_last_not_of('\n') + 1);
  const std::string own = keys.empty() ? std::string()
                                       : fmt::format(
                                             "\n\nKeys of --set (--list: those of models "
                                             "and integrators) [default]:\n{}",
                                             parameter_lines(keys));
  return fmt::format(
      "{}{}\n\nExample:\n  {} {}\n\nExit codes: 0 done, 1 internal error, "
      "2 usage or input error, 3 rows failed or a check did not hold, "
      "130 interrupted (--resume continues)\n",
      options, own.substr(0, own.find_last_not_of('\n') + 1), name, example);
}

std::string default_text(const Parameter& p) {
  if (!p.choices.empty()) return std::string(p.choices);
  const bool one_number = !p.text && !p.rows && p.components == 1;
  return one_number ? fmt::format("{}", p.number) : p.default_text();
}

ProgressMode parse_progress(std::string_view text) {
  if (text == "auto") return ProgressMode::automatic;
  if (text == "none") return ProgressMode::none;
  if (text == "json") return ProgressMode::json;
  throw InputError(fmt::format("'{}' is not a kind of progress", text), "--progress",
                   "use one of: auto, none, json");
}

void parse_settings(const std::vector<std::string>& given, CommandLine& line) {
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    const std::string where = "--set " + text;
    if (equals == std::string::npos || key.empty()) {
      throw InputError("not a setting", where, "give key=value");
    }
    if (!line.places.emplace("set:" + key, where).second) {
      throw InputError("'" + key + "' is set twice", where, "set it once");
    }
    line.set.emplace_back(key, text.substr(equals + 1));
  }
}

void interpret(const CLI::App& app, const Raw& raw, std::span<const OwnOption> own,
               CommandLine& line) {
  const auto given = [&app, &line](const std::string& text, const std::string& option) {
    if (app.count("--" + option) == 0) return false;
    if (text.empty()) {
      throw InputError("empty value", "--" + option,
                       "give a value or leave the option out");
    }
    line.places.emplace(option, "--" + option);
    return true;
  };
  if (!takes_place(own, "scene") && given(raw.scene, "scene")) {
    throw InputError(
        "this experiment has strands of its own and takes no scene", "--scene",
        "ask stability_limit, hard_cases, cost_of_accuracy or effect_audit about "
        "a scene; a file of options goes to --options");
  }
  if (given(raw.options, "options")) line.options_file = raw.options;
  if (!raw.plugins.empty()) line.places.emplace("plugin", "--plugin");
  line.plugins = raw.plugins;
  if (given(raw.out, "out")) line.out = raw.out;
  if (given(raw.models, "models")) line.models = split(raw.models, ',', "--models");
  if (given(raw.integrators, "integrators")) {
    line.integrators = split(raw.integrators, ',', "--integrators");
  }
  if (given(raw.elements, "elements")) {
    line.elements = parse_counts(raw.elements, "--elements");
  }
  if (given(raw.shard, "shard")) {
    std::tie(line.shard_index, line.shard_count) = parse_shard(raw.shard, "--shard");
  }
  if (given(raw.run_ids, "run-id")) line.run_ids = parse_run_ids(raw.run_ids);
  if (given(raw.timeout, "timeout")) {
    line.timeout_s = parse_duration(raw.timeout, "--timeout");
  }
  if (given(raw.jobs, "jobs")) {
    line.jobs = static_cast<int>(parse_whole(raw.jobs, "--jobs", 1, most_jobs));
  }
  if (given(raw.repeat, "repeat")) {
    line.repeat = static_cast<int>(parse_whole(raw.repeat, "--repeat", 1, most_repeats));
  }
  if (given(raw.seed, "seed")) line.seed = parse_whole(raw.seed, "--seed");
  if (given(raw.progress, "progress")) line.progress = parse_progress(raw.progress);
  parse_settings(raw.set, line);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::string name(own[i].name), key(own[i].key);
    if (!given(raw.own[i], name)) continue;
    if (!line.places.emplace("set:" + key, "--" + name).second) {
      throw InputError("'" + key + "' is set twice", "--" + name, "set it once");
    }
    line.set.emplace_back(key, raw.own[i]);
  }
}

void hide(CLI::App& app, std::span<const Unused> unused) {
  for (const Unused& option : unused) {
    app.get_option("--" + std::string(option.option))->group("");
  }
}

void refuse_unused(std::string_view name, const CommandLine& line,
                   std::span<const Unused> unused) {
  for (const auto& [option, why] : unused) {
    if (line.places.count(option) == 0) continue;
    throw InputError(fmt::format("{} has no use for --{}: {}", name, option, why),
                     line.place(option), "leave it out");
  }
}

/// Default location of the table.
std::string default_table(std::string_view name, const CommandLine& line,
                          std::span<const OwnOption> own) {
  std::string table = fmt::format("results/{}", name);
  for (const OwnOption& option : own) {
    if (!option.names_table || line.places.count(option.name) == 0) continue;
    const auto value = std::ranges::find(line.set, option.key,
                                         &std::pair<std::string, std::string>::first);
    table += '.' + std::filesystem::path(value->second).stem().string();
  }
  return table + ".csv";
}

/// The table of one part has a name of its own, so that parts may be given one --out.
std::string table_of_part(const CommandLine& line) {
  if (line.shard_count == 1 || line.out == "-") return line.out;
  std::filesystem::path table(line.out);
  const std::string ending = table.extension().string();
  table.replace_extension(
      fmt::format(".{}-of-{}{}", line.shard_index, line.shard_count, ending));
  return table.string();
}

void check_combinations(const CommandLine& line) {
  const auto refuse_if = [](bool bad, const char* problem, const char* where,
                            const char* remedy) {
    if (bad) throw InputError(problem, where, remedy);
  };
  refuse_if(line.quick && line.full, "--quick and --full exclude each other",
            "command line", "give one of them");
  refuse_if(line.resume && line.out == "-",
            "standard output keeps no rows to resume from", "--resume",
            "give --out file.csv");
  refuse_if(line.retry_failed && !line.resume, "--retry-failed requires --resume",
            "--retry-failed", "give --resume as well");
  refuse_if(!line.merge.empty() && line.places.count("out") == 0, "no output named",
            "--merge", "give --out file.csv");
}

}  // namespace

bool wanted(const std::vector<std::string>& chosen, std::string_view id) {
  return chosen.empty() || std::find(chosen.begin(), chosen.end(), id) != chosen.end();
}

std::string CommandLine::place(std::string_view option) const {
  const auto found = places.find(option);
  return found == places.end() ? "--" + std::string(option) : found->second;
}

std::string parameter_lines(std::span<const Parameter> parameters) {
  std::string text;
  for (const Parameter& p : parameters) {
    text += fmt::format("      {:<20} {} [{}]\n", p.name, p.help, default_text(p));
  }
  return text;
}

void refuse_arguments(const CLI::App& app, std::string_view name, int argc,
                      const char* const* argv, const CLI::ParseError& error) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) names.push_back(option->get_name());
  const std::vector<std::string_view> known(names.begin(), names.end());
  std::string help = fmt::format("{} --help shows the options", name);
  for (int i = 1; i < argc; ++i) {
    const std::string_view word =
        std::string_view(argv[i]).substr(0, std::string_view(argv[i]).find('='));
    const bool option = word.starts_with("--") && word.size() > 2;
    if (!option || std::ranges::count(known, word) > 0) continue;
    throw InputError(fmt::format("unknown option '{}'", word), "command line",
                     suggestion(word, known, help));
  }
  // A value that has been renamed is accepted by the option under its present name.
  const std::string message = error.what();
  for (int i = 1; i < argc; ++i) {
    for (const auto& [before, now] : renamed_names) {
      const bool offered = message.find(std::string(now)) != std::string::npos;
      if (before == argv[i] && offered) {
        help = fmt::format("'{}' is called '{}' now", before, now);
      }
    }
  }
  throw InputError(message, "command line", help);
}

CommandLine parse_command_line(std::string_view name, std::string_view question,
                               std::string_view example, int argc,
                               const char* const* argv, std::span<const OwnOption> own,
                               std::span<const Unused> unused,
                               std::span<const Parameter> keys, const Sizes& sizes) {
  CommandLine line;
  Raw raw;
  CLI::App app{fmt::format("{}: {}", name, question), std::string(name)};
  app.set_version_flag("--version", build_facts().described(name));
  declare(app, line, raw, own, sizes);
  hide(app, unused);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    throw Answer(help_text(app, name, example, keys));
  } catch (const CLI::CallForVersion& version) {
    throw Answer(version.what());
  } catch (const CLI::ParseError& error) {
    refuse_arguments(app, name, argc, argv, error);
  }
  line.argv.assign(argv, argv + argc);
  interpret(app, raw, own, line);
  if (!line.options_file.empty()) read_options_file(line.options_file, line);
  refuse_unused(name, line, unused);
  if (line.out.empty()) line.out = default_table(name, line, own);
  line.out = table_of_part(line);
  check_combinations(line);
  return line;
}

}  // namespace tress::experiments
