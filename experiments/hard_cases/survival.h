#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "experiments/hard_cases/references.h"
#include "simulation/files/row.h"

namespace tress::experiments::hard_cases {

/// How a run of a case ended. `unstable`: a bound of the case did not hold, its measure
/// among them. `not_finished`: its work was done before a bound was broken.
enum class Outcome { refused, not_finished, unstable, stable, accurate };
std::string_view name(Outcome outcome);
/// Throws InputError naming `where` on any other text.
Outcome outcome_of(std::string_view name, const std::string& where);
inline bool passed(Outcome outcome) { return outcome >= Outcome::stable; }

struct Survival {
  Outcome outcome = Outcome::refused;
  std::string why;  // it is no better
  double t = 0;     // s, where it ended
  std::optional<double> measure, error, gap;
  std::string_view formulation;  // how constraints entered
  Stats stats;
  double wall_s = 0;  // of the run
};

/// The columns about how a run ended.
void set_survival(const Survival& survival, Row& row);

/// What is tried.
struct Attempt {
  const HardCase* hard;
  Subject subject;
  Parameters defaults;  // of the model
  std::string_view integrator;
  double dt;           // s
  Options options;     // but for step and formulation
  double shorter = 1;  // the part of HardCase::count that is run
};

/// Work that a run may do, in unknowns of a residual or of a solve (0.15 us on a
/// processor of 2023), and n^3/1500 of them for the factors of a dense matrix. Not a
/// time: what a row gets done depends neither on the machine nor on who else is at work.
struct WorkLimit {
  double most = std::numeric_limits<double>::infinity();
};
/// Of --quick: half a second a row, and a second for the reference that it makes for all
/// rows of its case and model.
inline constexpr WorkLimit quick_row{3e6}, quick_reference{6e6};

/// "its work was done at t = 0.1 s".
std::string cut_at(double t);

/// The reference of a case on one model; `coarser` times as long steps as the case asks
/// for.
Reference reference(const HardCase& hard, const Subject& subject,
                    const Parameters& defaults, const Options& options, double coarser,
                    const WorkLimit& limit);

/// Runs it and judges. `find` gives the reference; asked for where a stable run has one
/// to be compared with.
Survival survive(const Attempt& attempt, const WorkLimit& limit,
                 const std::function<Reference()>& find);

}  // namespace tress::experiments::hard_cases
