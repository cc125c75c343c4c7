#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/hard_cases/hard_case.h"
#include "simulation/files/row.h"

namespace tress::experiments::hard_cases {

/// The tip's trajectory by the same equations at a much finer step, and its distance over
/// the length from that at twice the finer step; `why` if there is none.
struct Reference {
  std::vector<double> tip;  // (3 samples)
  double gap = 0;
  std::string why;  // empty: the reference exists

  static constexpr int samples = 8;
};

/// References shared by the processes of the rows: the first to ask computes, the others
/// wait. Created before the processes fork, in shared memory.
class References {
 public:
  explicit References(std::size_t count);
  ~References();
  References(const References&) = delete;
  References& operator=(const References&) = delete;

  /// Reference `index`, by `compute` unless it is known. A caller that waits longer than
  /// `patience_s` returns without one: the computing process has been killed.
  Reference get(std::size_t index, double patience_s,
                const std::function<Reference()>& compute);

 private:
  struct Slot;
  std::size_t count_;
  Slot* slots_;
};

/// Outcome of a run of a case. `unstable`: a bound of the case, or its measure, was
/// violated. `not_finished`: the work ran out before a bound was violated.
enum class Outcome { refused, not_finished, unstable, stable, accurate };
std::string_view name(Outcome outcome);
/// Throws InputError naming `where` on any other text.
Outcome outcome_of(std::string_view name, const std::string& where);
inline bool passed(Outcome outcome) { return outcome >= Outcome::stable; }

struct Survival {
  Outcome outcome = Outcome::refused;
  std::string why;  // why the outcome is no better
  double t = 0;     // s, where it ended
  std::optional<double> measure, error, gap;
  std::string_view formulation;  // how constraints entered
  Stats stats;
  double wall_s = 0;  // of the run
};

/// Sets the columns about how a run ended.
void set_survival(const Survival& survival, Row& row);

/// The steps of a run.
struct Pace {
  double step;           // s; with a tolerance the longest
  double tolerance = 0;  // Options::tolerance; 0: all steps have this length

  Options applied(Options options) const;
  /// Sets the columns that say so.
  void identify(Row& row) const;
  auto operator<=>(const Pace&) const = default;
};

/// One run to try.
struct Attempt {
  const HardCase* hard;
  Subject subject;
  Parameters defaults;  // of the model
  std::string_view integrator;
  Pace pace;
  Options options;     // except those of the pace, and the formulation
  double shorter = 1;  // fraction of HardCase::count that is run
};

/// Work limit of a run, in unknowns of a residual or of a solve (0.15 us on a processor
/// of 2023), plus n^3/1500 for a dense factorisation. Not a time: the result of a row
/// must depend neither on the machine nor on its load.
struct WorkLimit {
  double most = std::numeric_limits<double>::infinity();
};
/// Work limits with --quick: half a second per row, and a second for the reference,
/// computed once for all rows of its case and model.
inline constexpr WorkLimit quick_row{3e6}, quick_reference{6e6};

/// Returns a reason, as "its work was done at t = 0.1 s".
std::string cut_at(double t);

/// The reference of a case on one model, at `coarser` times the case's reference step.
Reference reference(const HardCase& hard, const Subject& subject,
                    const Parameters& defaults, const Options& options, double coarser,
                    const WorkLimit& limit);

/// Runs it and judges. `find` supplies the reference; called only for a stable run that
/// needs one.
Survival survive(const Attempt& attempt, const WorkLimit& limit,
                 const std::function<Reference()>& find);

}  // namespace tress::experiments::hard_cases
