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

/// Time limit of a case. A case that polls `passed()` can stop early and keep its
/// measurements; one that does not is killed shortly after the limit.
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

/// One row to be measured, in its own process: if that crashes, hangs or throws, the
/// table still gets its row.
struct Case {
  Row identity;  // columns that identify the row; hashed into run_id
  std::function<void(Row&, const Deadline&)> run;  // gets the row with its identity set
  /// Replaces `run` where one computation yields several rows: returns all of them, given
  /// the identity. The first has the run_id of the case; the others append ".001" and so
  /// on.
  std::function<std::vector<Row>(const Row&, const Deadline&)> run_rows = {};
};

/// Glossary entry for the rows that have `value` in `column`: {"what", "..."}.
struct Gloss {
  std::string_view column, value;
  std::vector<std::pair<std::string_view, std::string_view>> texts;
};

/// One executable, one question.
struct Experiment {
  std::string_view name, question;
  std::string_view example;  // arguments only: "--models bead_on_wire --quick"
  Sizes sizes = {};          // for the help text
  /// False: no time in the table is a primary result, and one row per processor runs at
  /// once unless --jobs sets another number. True: one row at a time, and the table gets
  /// the column others_load.
  bool timed = true;
  /// s, per row with --quick unless --timeout overrides it. Only against hangs: no result
  /// may depend on the machine's load. Options::max_work bounds the work of a row.
  double quick_timeout_s = 60;
  std::span<const Column> columns;           // status, reason and run_id are appended
  std::span<const Parameter> settings = {};  // the experiment's own --set keys
  std::span<const OwnOption> options = {};   // short forms of --set
  std::span<const Unused> unused = {};       // shared options that are refused
  std::function<std::vector<Case>(const CommandLine&)> cases;
  /// Optional: fills columns that only the whole table knows (fitted orders, fronts).
  std::function<void(std::vector<Row>&)> derive = {};
  /// Optional: the claims that the table must show; a broken claim makes the exit code 3.
  /// Neither `checks` nor `derive` is called on a single shard or with --run-id.
  std::function<void(const std::vector<Row>&, Verdicts&)> checks = {};
  /// Optional: stored in the manifest for the report page.
  std::function<std::vector<Gloss>()> glossary = {};
  /// Optional: a row that is not ok but is an expected result of the experiment (a
  /// divergence beyond a limit, say) does not make the exit code 3.
  std::function<bool(const Row&)> finding = {};
  /// Optional: reports on the complete table, or writes files next to the table.
  std::function<void(const CommandLine&, const std::vector<Row>&)> conclude = {};
};

/// Runs the whole main(): options, --list, sweep, table, manifest. Returns the exit code:
/// - 0: all rows ok, no claim broken.
/// - 1: internal error.
/// - 2: usage or input error.
/// - 3: some rows failed, or a judged claim is broken or changed (the table is complete).
/// - 130: interrupted (resumable).
int run_experiment(const Experiment& experiment, int argc, char** argv);

}  // namespace tress::experiments
