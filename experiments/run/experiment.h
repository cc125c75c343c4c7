#pragma once

#include <chrono>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/parameters.h"
#include "experiments/run/command_line.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments {

/// When a case has to end. One that looks at `passed()` can stop by itself with what it
/// measured; one that does not is killed shortly after.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Deadline(double seconds)
      : end_(Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                std::chrono::duration<double>(seconds))) {}
  bool passed() const { return Clock::now() >= end_; }
  double remaining_s() const {
    return std::chrono::duration<double>(end_ - Clock::now()).count();
  }

 private:
  Clock::time_point end_;
};

/// One row to be measured, in a process of its own: it may crash, hang or throw, and the
/// table still gets its row.
struct Case {
  Row identity;  // the columns that tell this row from all others; hashed into run_id
  std::function<void(Row&, const Deadline&)> run;  // the row comes with the identity set
  /// Instead of `run`, where one piece of work answers several rows: all of them, from
  /// the identity. The first has the run_id of the case, the others ".001" and so on
  /// behind it.
  std::function<std::vector<Row>(const Row&, const Deadline&)> run_rows = {};
};

/// What the rows that have `value` in `column` are about, in words: {"what", "..."}.
struct Gloss {
  std::string_view column, value;
  std::vector<std::pair<std::string_view, std::string_view>> texts;
};

/// One executable, one question.
struct Experiment {
  std::string_view name, question;
  std::string_view example;  // arguments only: "--models bead_on_wire --quick"
  /// False: no time in the table is what is asked for first, and as many rows run at once
  /// as the machine has processors unless --jobs says otherwise. True: one at a time.
  bool timed = true;
  /// s, of a row with --quick, unless --timeout says otherwise: for hangs only, since no
  /// result may depend on what else the machine does. Work bounds a row
  /// (Options::max_work).
  double quick_timeout_s = 60;
  std::span<const Column> columns;  // status, reason and run_id are added to them
  std::span<const Parameter> settings =
      {};                                   // keys of --set that are the experiment's own
  std::span<const OwnOption> options = {};  // short for --set of some of them
  std::span<const Unused> unused = {};      // of the shared options: refused
  std::function<std::vector<Case>(const CommandLine&)> cases;
  /// Optional: fills columns that only the whole table knows (fitted orders, fronts).
  std::function<void(std::vector<Row>&)> derive = {};
  /// Optional: states what the table must show; a claim that is broken makes the exit
  /// code 3. Neither is called on a single shard.
  std::function<void(const std::vector<Row>&, Verdicts&)> checks = {};
  /// Optional: kept in the manifest, where the report page reads it.
  std::function<std::vector<Gloss>()> glossary = {};
  /// Optional: a row that is not ok but is what the experiment set out to find (a
  /// divergence beyond a limit, say) does not make the exit code 3.
  std::function<bool(const Row&)> finding = {};
  /// Optional: what to say of the complete table, or to write beside it.
  std::function<void(const CommandLine&, const std::vector<Row>&)> conclude = {};
};

/// The whole main(): options, --list, sweep, table, manifest; returns the exit code.
/// 0 all rows ok, no claim broken; 1 internal error; 2 usage or input error; 3 some rows
/// failed or a claim that was judged is broken or changed (the table is complete); 130
/// interrupted (resumable).
int run_experiment(const Experiment& experiment, int argc, char** argv);

}  // namespace tress::experiments
