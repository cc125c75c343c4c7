#pragma once

#include <ctime>
#include <functional>
#include <optional>
#include <string>

#include "experiments/hard_cases/references.h"

namespace tress {

/// How a run of a case ended. `unstable`: a bound of the case did not hold, its measure
/// among them. `not_finished`: its time was over before a bound was broken.
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

/// True after so much time of this process's own: what a row gets done does not depend on
/// who else is at work.
class CpuLimit {
 public:
  explicit CpuLimit(double seconds) : end_(now() + seconds) {}
  bool operator()() const { return now() > end_; }

 private:
  static double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
  double end_;
};

/// The reference of a case on one model; `coarser` times as long steps as the case asks
/// for.
Reference reference(const HardCase& hard, const Subject& subject,
                    const Parameters& defaults, const Options& options, double coarser,
                    const GiveUp& give_up);

/// Runs it and judges. `find` gives the reference; asked for where a stable run has one
/// to be compared with.
Survival survive(const Attempt& attempt, const GiveUp& give_up,
                 const std::function<Reference()>& find);

}  // namespace tress
