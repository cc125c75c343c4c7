#include "experiments/run/experiment.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "contract/input_error.h"
#include "experiments/run/exit_code.h"
#include "experiments/run/journal.h"
#include "experiments/run/list.h"
#include "experiments/run/manifest.h"
#include "experiments/run/merge.h"
#include "experiments/run/message.h"
#include "experiments/run/progress.h"
#include "experiments/run/row_loads.h"
#include "experiments/run/rows.h"
#include "experiments/run/settings.h"
#include "experiments/run/sweep.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"
#include "simulation/files/parse.h"
#include "simulation/head/batch_matrix.h"
#include "simulation/plugin/load_plugin.h"

namespace tress::experiments {
namespace {

constexpr const char* standard_output = "-";

/// Throws InputError on a requested model, integrator or number of elements that no row
/// has, although some rows have one: it would be ignored silently.
void check_honoured(const CommandLine& line, const std::vector<Case>& cases) {
  std::vector<std::string> counts;
  for (const int count : line.elements) counts.push_back(std::to_string(count));
  const auto check = [&](std::string_view option, std::string_view column,
                         const std::vector<std::string>& chosen) {
    std::set<std::string_view> shown;
    for (const Case& work : cases) shown.insert(work.identity.text(column));
    shown.erase(std::string_view{});
    for (const std::string& value : chosen) {
      if (shown.empty() || shown.count(value) != 0) continue;
      throw InputError(
          fmt::format("no row of these options has the {} {}", column, value),
          line.place(option), fmt::format("the rows have: {}", fmt::join(shown, ", ")));
    }
  };
  check("models", "model", line.models);
  check("integrators", "integrator", line.integrators);
  check("elements", "elements", counts);
}

/// The cases of this shard, each with its run_id.
std::vector<Case> plan(const Experiment& experiment, const CommandLine& line) {
  std::vector<Case> cases = experiment.cases(line);
  check_honoured(line, cases);
  std::set<std::string> ids;
  std::vector<Case> mine;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::string id = run_id(experiment.name, cases[i].identity);
    if (!ids.insert(id).second) {
      throw std::logic_error("two rows have the same identity: " +
                             describe(cases[i].identity));
    }
    const auto shard = static_cast<std::size_t>(line.shard_count);
    if (i % shard != static_cast<std::size_t>(line.shard_index - 1)) continue;
    cases[i].identity.set("run_id", id);
    mine.push_back(std::move(cases[i]));
  }
  return chosen_rows(std::move(mine), line);
}

/// As `plan`, which may compute references first.
std::vector<Case> planned_aloud(const Experiment& experiment, const CommandLine& line) {
  Heartbeat heartbeat(line.progress, experiment.name);
  heartbeat.doing("planning its rows");
  return plan(experiment, line);
}

std::string journal_file(const CommandLine& line) { return line.out + ".journal"; }

/// Includes the contents of the files that the settings name, by default or as chosen.
RunKey run_key(const Experiment& experiment, const CommandLine& line) {
  const Settings settings(line, experiment.settings);
  std::vector<std::string> files{line.options_file};
  for (const Parameter& p : experiment.settings) {
    if (!p.text || settings.experiment().word(p.name).empty()) continue;
    for (std::string& file :
         split(settings.experiment().word(p.name), ',', std::string(p.name))) {
      files.push_back(std::move(file));
    }
  }
  RunKey key;
  key.add("experiment", std::string(experiment.name))
      .add("schema", std::to_string(schema_version))
      .add("settings", settings_text(line))
      .add("columns", csv_line(header(experiment.columns)))
      .add("files", contents_checksum(files));
  return key;
}

/// Rows of a complete table from an earlier run with the same settings. False: another
/// build made it, and its rows are not kept.
bool keep_table(const Experiment& experiment, const CommandLine& line, Rows& rows) {
  std::error_code ignored;  // check_output has reported the problem
  if (!std::filesystem::exists(line.out, ignored)) return true;
  const CsvTable table = read_csv(line.out);
  check_header(table, experiment.columns, line.out);
  const auto manifest = manifest_of(line.out);
  const auto same = [&] {
    return manifest->is_object() && manifest->contains("settings") &&
           manifest->at("settings") == settings_text(line);
  };
  if (manifest && !same()) {
    throw InputError("the table to resume was made with other settings",
                     beside(line.out, ".meta.json"),
                     "repeat them, choose another --out, or leave out --resume");
  }
  if (manifest && !made_by_this_program(*manifest)) return false;
  for (const Row& row : table.rows) rows.keep(row);
  return true;
}

/// Completes, judges and writes the table; returns the exit code.
int finish(const Experiment& experiment, const CommandLine& line, std::vector<Row> rows,
           const Manifest& manifest, std::size_t kept_from_before) {
  Verdicts verdicts;
  if (!line.partial()) {
    if (experiment.derive) experiment.derive(rows);
    if (experiment.checks) experiment.checks(rows, verdicts);
  }
  const std::string csv = to_csv(header(experiment.columns), rows);
  if (line.out == standard_output) {
    write_all(STDOUT_FILENO, csv.substr(csv.find('\n') + 1), "standard output");
  } else {
    replace_file(beside(line.out, ".meta.json"),
                 manifest.finished(rows, verdicts, kept_from_before));
    replace_file(line.out, csv);
  }
  if (experiment.conclude && !line.partial()) experiment.conclude(line, rows);
  return report_table(experiment, line, rows, verdicts);
}

int merge_tables(const Experiment& experiment, const CommandLine& line) {
  const Merged merged = merge(line.merge, experiment.columns, settings_text(line));
  const Manifest manifest(experiment, line);
  const int code = finish(experiment, line, merged.rows, manifest, merged.rows.size());
  for (const std::string& conflict : merged.conflicts) {
    tell("{}: conflict: {}\n", experiment.name, conflict);
  }
  return merged.conflicts.empty() ? code : rows_failed;
}

bool named_output(const CommandLine& line) {
  return line.out != standard_output && line.places.count("out") > 0;
}

/// Checks that the table and the files next to the table can be written.
void check_outputs(const CommandLine& line) {
  std::error_code ignored;  // check_output reports problems with the directory
  if (!named_output(line)) std::filesystem::create_directory("results", ignored);
  check_output(line.out);
  check_output(beside(line.out, ".meta.json"));
}

/// Standard output can only be checked by writing to it, so it gets the header now.
void check_place(const Experiment& experiment, const CommandLine& line) {
  if (line.out == standard_output) {
    write_all(STDOUT_FILENO, csv_line(header(experiment.columns)), "standard output");
  } else {
    check_outputs(line);
  }
}

std::unique_ptr<Journal> open_journal(const Experiment& experiment,
                                      const CommandLine& line) {
  auto journal = std::make_unique<Journal>(
      journal_file(line), run_key(experiment, line),
      line.resume ? Journal::Mode::resume : Journal::Mode::fresh);
  remove_leftovers(beside(line.out, ""));
  return journal;
}

/// Refuses what a run would refuse before it plans its rows; the journal of an unfinished
/// run, if there is one. `own`: as keep_table().
std::unique_ptr<Journal> begin(const Experiment& experiment, const CommandLine& line,
                               Rows& rows, bool& own) {
  check_outputs(line);
  if (line.resume) own = keep_table(experiment, line, rows);
  auto journal = open_journal(experiment, line);
  if (!journal->rows().empty()) return journal;
  journal->remove();
  return nullptr;
}

/// The cases that other programs disturbed, to be timed again; none where most were, for
/// such a machine is as busy later.
std::vector<Case> again_without_load(const Experiment& experiment,
                                     const std::vector<Case>& cases, RowLoads& loads) {
  const std::set<std::string> above = loads.above();
  std::vector<Case> again;
  if (2 * above.size() < cases.size()) {
    for (const Case& work : cases) {
      if (above.count(std::string(work.identity.text("run_id"))) > 0)
        again.push_back(work);
    }
  }
  if (!above.empty()) {
    tell(
        "{}: {} of {} rows were timed while other programs used more than {} of a "
        "processor: they are {}\n",
        experiment.name, above.size(), cases.size(), most_load,
        again.empty() ? "marked in the manifest" : "timed again");
  }
  return again;
}

int run_rows(const Experiment& experiment, const CommandLine& line) {
  Rows rows;
  std::unique_ptr<Journal> journal;
  // Problems with a named output are reported before planning, which may take seconds for
  // its references; a plan that fails leaves nothing behind.
  const bool named = named_output(line);
  bool own = true;
  if (named) journal = begin(experiment, line, rows, own);
  const std::vector<Case> planned = planned_aloud(experiment, line);
  if (planned.empty() && line.shard_count == 1) {
    throw InputError("these options leave no row to run", "command line",
                     "--list shows what there is");
  }
  check_place(experiment, line);
  if (line.resume && !named) own = keep_table(experiment, line, rows);
  if (!journal && line.out != standard_output) journal = open_journal(experiment, line);
  if (journal) {
    for (const Row& row : journal->rows()) rows.keep(row);
  }
  if (!own) {
    tell("{}: {} was made by another build: it is made again from its first row\n",
         experiment.name, line.out);
  }
  std::vector<Case> todo;
  for (const Case& work : planned) {
    const Row* row = rows.find(std::string(work.identity.text("run_id")));
    if (row == nullptr || (line.retry_failed && !row->ok())) todo.push_back(work);
  }
  const std::size_t kept = planned.size() - todo.size();
  Manifest manifest(experiment, line);
  const std::vector<std::string> columns = header(experiment.columns);
  // Of rows that run at the same time, each would be the others' load.
  std::optional<RowLoads> loads;
  if (experiment.timed && line.jobs == 1) loads.emplace();
  const auto run = [&](const std::vector<Case>& cases) {
    Progress progress(line.progress, experiment.name, cases.size());
    const auto keep = [&](std::vector<Row> of, double seconds) {
      progress.finished(of.front(), seconds);
      if (loads) {
        const double load = loads->finished(std::string(of.front().text("run_id")));
        for (Row& row : of) row.set(others_load.name, load);
      }
      // A case's first row is stored last: if it is present, all of them are.
      for (std::size_t i = of.size(); i-- > 0;) {
        static_cast<void>(in_order(of[i], columns));  // an undeclared column: a
                                                      // programming error
        if (journal) journal->append(of[i]);
        rows.keep(std::move(of[i]));
      }
    };
    return sweep(cases, line.jobs, line.timeout_s, keep,
                 [&](const Case& work, double seconds) {
                   progress.running(work.identity, seconds);
                 });
  };
  SweepEnd end = run(todo);
  if (loads && end == SweepEnd::complete) {
    const std::vector<Case> again = again_without_load(experiment, todo, *loads);
    if (!again.empty()) end = run(again);
    manifest.set_load(*loads);
  }
  if (end == SweepEnd::interrupted) {
    const std::string remedy =
        journal ? fmt::format(
                      "finished rows are in {}; the same command with --resume "
                      "continues",
                      journal_file(line))
                : "nothing was written";
    tell("{}: interrupted: {}\n", experiment.name, remedy);
    return interrupted;
  }
  const int code = finish(experiment, line, rows.ordered(planned), manifest, kept);
  if (journal) journal->remove();
  return code;
}

int check(const Experiment& experiment, const CommandLine& line) {
  Rows rows;
  bool own = true;
  if (line.out != standard_output) begin(experiment, line, rows, own);
  return done;
}

int dry_run(const Experiment& experiment, const CommandLine& line) {
  if (named_output(line)) check_outputs(line);
  std::string text;
  for (const Case& work : plan(experiment, line)) text += describe(work.identity) + '\n';
  write_all(STDOUT_FILENO, text, "standard output");
  return done;
}

int answer(const Experiment& experiment, int argc, char** argv) {
  CommandLine line = parse_command_line(
      experiment.name, experiment.question, experiment.example, argc, argv,
      experiment.options, experiment.unused, experiment.settings, experiment.sizes);
  for (const std::string& plugin : line.plugins) load_plugin(plugin);
  if (!experiment.timed && line.places.count("jobs") == 0) {
    line.jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }
  if (line.quick && line.places.count("timeout") == 0) {
    line.timeout_s = experiment.quick_timeout_s;
  }
  const Settings checked(line, experiment.settings);
  if (line.list) {
    write_all(
        STDOUT_FILENO,
        catalogue_text(model_catalogue(), integrator_catalogue(), experiment.settings) +
            batch_matrix(),
        "standard output");
    return done;
  }
  if (!line.merge.empty()) {
    check_place(experiment, line);
    return merge_tables(experiment, line);
  }
  if (line.check) return check(experiment, line);
  return line.dry_run ? dry_run(experiment, line) : run_rows(experiment, line);
}

}  // namespace

int run_experiment(const Experiment& experiment, int argc, char** argv) {
  Experiment own = experiment;
  std::vector<Column> columns(own.columns.begin(), own.columns.end());
  if (own.timed) columns.push_back(others_load);
  own.columns = columns;
  return exit_code(own.name, [&] { return answer(own, argc, argv); });
}

}  // namespace tress::experiments
