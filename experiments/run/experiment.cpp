#include "experiments/run/experiment.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
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
#include "experiments/run/settings.h"
#include "experiments/run/sweep.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"
#include "simulation/files/parse.h"
#include "simulation/plugin/load_plugin.h"

namespace tress::experiments {
namespace {

constexpr const char* standard_output = "-";

/// Rows by run_id, in output order.
class Rows {
 public:
  void keep(Row row) {
    const std::string id(row.text("run_id"));
    const auto [place, fresh] = place_.emplace(id, rows_.size());
    if (fresh) {
      rows_.push_back(std::move(row));
    } else {
      rows_[place->second] = std::move(row);
    }
  }
  const Row* find(const std::string& id) const {
    const auto place = place_.find(id);
    return place == place_.end() ? nullptr : &rows_[place->second];
  }
  const std::vector<Row>& all() const { return rows_; }

  /// The planned rows first, in their order, then those of earlier plans.
  std::vector<Row> ordered(const std::vector<Case>& plan) const {
    std::vector<Row> result;
    std::set<std::string_view> taken;
    for (const Case& work : plan) {
      const std::string id(work.identity.text("run_id"));
      // The run_ids of a case's further rows append a point to its own.
      for (auto at = place_.lower_bound(id);
           at != place_.end() && (at->first == id || at->first.starts_with(id + '.'));
           ++at) {
        const Row& row = rows_[at->second];
        result.push_back(row);
        taken.insert(row.text("run_id"));
      }
    }
    for (const Row& row : rows_) {
      if (taken.count(row.text("run_id")) == 0) result.push_back(row);
    }
    return result;
  }

 private:
  std::vector<Row> rows_;
  std::map<std::string, std::size_t> place_;
};

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
  return mine;
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

/// Rows of a complete table from an earlier run with the same settings.
void keep_table(const Experiment& experiment, const CommandLine& line, Rows& rows) {
  std::error_code ignored;  // check_output has reported the problem
  if (!std::filesystem::exists(line.out, ignored)) return;
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
  for (const Row& row : table.rows) rows.keep(row);
}

std::string_view heading(Verdicts::State state) {
  switch (state) {
    case Verdicts::State::held:
      return "PASS";
    case Verdicts::State::broken:
      return "FAIL";
    case Verdicts::State::known_limit:
      return "KNOWN LIMIT";
    case Verdicts::State::changed:
      return "CHANGED";
    case Verdicts::State::not_judged:
    case Verdicts::State::figure:
      break;
  }
  return "FIGURE";
}

void tell_verdicts(std::string_view experiment, const Verdicts& verdicts) {
  int not_judged = 0;
  for (const Verdicts::Verdict& verdict : verdicts.all()) {
    if (verdict.state == Verdicts::State::not_judged) {
      ++not_judged;
      continue;
    }
    const bool limit = verdict.state == Verdicts::State::known_limit ||
                       verdict.state == Verdicts::State::changed;
    tell("{}: {} {} ({:.3g}){}{}\n", experiment, heading(verdict.state), verdict.claim,
         verdict.value, limit ? "; " : "", limit ? verdict.reason : "");
  }
  if (not_judged > 0) {
    tell("{}: not judged: {} claims of rows that were not run\n", experiment, not_judged);
  }
}

int report(const Experiment& experiment, const CommandLine& line,
           const std::vector<Row>& rows, const Verdicts& verdicts) {
  std::map<std::string, int> counts;
  const Row* failed = nullptr;
  for (const Row& row : rows) {
    ++counts[std::string(row.status())];
    const bool finding = experiment.finding && experiment.finding(row);
    if (failed == nullptr && !row.ok() && !finding) failed = &row;
  }
  // With JSON progress they are in the manifest.
  if (line.progress != ProgressMode::json) tell_verdicts(experiment.name, verdicts);
  if (line.progress != ProgressMode::none || failed != nullptr) {
    std::string text;
    for (const auto& [status, count] : counts)
      text += fmt::format(", {} {}", count, status);
    if (failed != nullptr) {
      text += fmt::format("; first: {}", printable(failed->text("reason")));
    }
    tell("{}: {} rows{} -> {}\n", experiment.name, rows.size(), text, line.out);
  }
  const bool alarm = std::ranges::any_of(verdicts.all(), &Verdicts::Verdict::alarm);
  return alarm || failed != nullptr ? rows_failed : done;
}

/// Completes, judges and writes the table; returns the exit code.
int finish(const Experiment& experiment, const CommandLine& line, std::vector<Row> rows,
           const Manifest& manifest, std::size_t kept_from_before) {
  Verdicts verdicts;
  if (line.shard_count == 1) {
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
  if (experiment.conclude && line.shard_count == 1) experiment.conclude(line, rows);
  return report(experiment, line, rows, verdicts);
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

/// Standard output can only be checked by writing to it, so it gets the header now.
void check_place(const Experiment& experiment, const CommandLine& line) {
  if (line.out == standard_output) {
    write_all(STDOUT_FILENO, csv_line(header(experiment.columns)), "standard output");
    return;
  }
  std::error_code ignored;  // check_output reports problems with the directory
  const bool ours = line.places.count("out") == 0;
  if (ours) std::filesystem::create_directory("results", ignored);
  check_output(line.out);
}

std::unique_ptr<Journal> open_journal(const Experiment& experiment,
                                      const CommandLine& line) {
  return std::make_unique<Journal>(
      journal_file(line), run_key(experiment, line),
      line.resume ? Journal::Mode::resume : Journal::Mode::fresh);
}

int run_rows(const Experiment& experiment, const CommandLine& line) {
  Rows rows;
  std::unique_ptr<Journal> journal;
  // Problems with a named output are reported before planning, which may take seconds for
  // its references; a plan that fails leaves nothing behind.
  const bool named = line.out != standard_output && line.places.count("out") > 0;
  if (named) {
    check_output(line.out);
    if (line.resume) keep_table(experiment, line, rows);
    journal = open_journal(experiment, line);
    if (journal->rows().empty()) {
      journal->remove();
      journal.reset();
    }
  }
  const std::vector<Case> planned = plan(experiment, line);
  if (planned.empty() && line.shard_count == 1) {
    throw InputError("these options leave no row to run", "command line",
                     "--list shows what there is");
  }
  check_place(experiment, line);
  if (line.resume && !named) keep_table(experiment, line, rows);
  if (!journal && line.out != standard_output) journal = open_journal(experiment, line);
  if (journal) {
    for (const Row& row : journal->rows()) rows.keep(row);
  }
  std::vector<Case> todo;
  for (const Case& work : planned) {
    const Row* row = rows.find(std::string(work.identity.text("run_id")));
    if (row == nullptr || (line.retry_failed && !row->ok())) todo.push_back(work);
  }
  const std::size_t kept = planned.size() - todo.size();
  const Manifest manifest(experiment, line);
  const std::vector<std::string> columns = header(experiment.columns);
  SweepEnd end = SweepEnd::complete;
  {
    Progress progress(line.progress, experiment.name, todo.size());
    const auto keep = [&](std::vector<Row> of, double seconds) {
      progress.finished(of.front(), seconds);
      // A case's first row is stored last: if it is present, all of them are.
      for (std::size_t i = of.size(); i-- > 0;) {
        static_cast<void>(in_order(of[i], columns));  // an undeclared column: a
                                                      // programming error
        if (journal) journal->append(of[i]);
        rows.keep(std::move(of[i]));
      }
    };
    end = sweep(todo, line.jobs, line.timeout_s, keep);
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

int dry_run(const Experiment& experiment, const CommandLine& line) {
  std::string text;
  for (const Case& work : plan(experiment, line)) text += describe(work.identity) + '\n';
  write_all(STDOUT_FILENO, text, "standard output");
  return done;
}

int answer(const Experiment& experiment, int argc, char** argv) {
  CommandLine line =
      parse_command_line(experiment.name, experiment.question, experiment.example, argc,
                         argv, experiment.options, experiment.unused);
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
        catalogue_text(model_catalogue(), integrator_catalogue(), experiment.settings),
        "standard output");
    return done;
  }
  if (!line.merge.empty()) {
    check_place(experiment, line);
    return merge_tables(experiment, line);
  }
  return line.dry_run ? dry_run(experiment, line) : run_rows(experiment, line);
}

}  // namespace

int run_experiment(const Experiment& experiment, int argc, char** argv) {
  return exit_code(experiment.name, [&] { return answer(experiment, argc, argv); });
}

}  // namespace tress::experiments
