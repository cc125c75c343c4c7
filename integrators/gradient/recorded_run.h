#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrators/gradient/gradient_run.h"
#include "integrators/gradient/step_probe.h"

namespace tress::integrators {

/// The record of a part of a run: what is needed to differentiate its steps backward. A
/// stage takes 3 n + m + 1 numbers. Steps of equal length share their table.
class Tape {
 public:
  /// State of a stage: time, q, v, a and multipliers.
  using Motion = WatchedSystem::Motion;

  /// A step, or the start of a method.
  struct Step {
    std::shared_ptr<const StepTable> table;  // program of the step
    std::size_t at;                          // of its operations' motions
    std::size_t common;  // entries of the system's memory that it left as they were
  };

  /// Removes all steps.
  void clear();
  /// Adds a step: the motions of its operations in order, and the memory before it.
  void add(std::shared_ptr<const StepTable> table, std::span<const Motion* const> motions,
           In memory_before, In memory_after);
  /// Returns the steps in the order in which they were taken.
  const std::vector<Step>& steps() const { return steps_; }
  /// Reads the motion of an operation.
  void read(const Step& step, std::size_t operation, Motion& motion) const;
  /// Turns the memory after a step into that before it.
  void step_back(const Step& step, std::vector<double>& memory) const;
  /// Returns the number of doubles in the record.
  std::size_t doubles() const { return numbers_.size(); }

 private:
  std::vector<Step> steps_;
  std::vector<double> numbers_;
};

/// A run, or a part of one, that writes a Tape. Its methods one after the other: the
/// damped start, if there is one, then the method.
class RecordedRun {
 public:
  /// A place at which a run can be continued.
  struct Place {
    std::size_t method = 0;      // 0: damped start, 1: method of the run
    double t = 0;                // time, s
    std::vector<double> state;   // FixedStep::state(), one vector behind the other
    std::vector<double> memory;  // System::memory()
  };

  /// `system` must outlive it.
  RecordedRun(System& system, const GradientRun::Method& method);

  /// Starts method 0 (the damped start) or 1 at a state.
  Status begin(std::size_t method, double t, In q, In v, Tape& tape);
  /// Takes steps no longer than those of the method. `each_step` after every one.
  Status advance(double t_end, Tape& tape,
                 const std::function<void(double t)>& each_step);
  /// Returns the place that the run has reached.
  Place place() const;
  /// Moves the run and the memory of its system to a place.
  Status go_to(const Place& place);

  /// Returns the time of the state, s.
  double time() const { return now().time(); }
  /// Returns the coordinates (n).
  In q() const { return now().q(); }
  /// Returns the rates (n).
  In v() const { return now().v(); }
  /// Returns the counters of the method in progress.
  Stats stats() const { return now().stats(); }
  /// Returns what ended the last advance() of the method in progress.
  std::string failure() const { return now().failure(); }

 private:
  struct Part {
    std::unique_ptr<Integrator> run;
    std::unique_ptr<StepProbe> probe;
  };

  const Integrator& now() const { return *parts_[method_].run; }
  FixedStep& fixed() const { return dynamic_cast<FixedStep&>(*parts_[method_].run); }
  std::vector<double> numbers() const;
  void write_step(double from, double to, Tape& tape);
  void write(Tape& tape);

  System& system_;
  WatchedSystem watched_;
  std::array<Part, 2> parts_;
  std::size_t method_ = 1;
  std::shared_ptr<const StepTable> table_;
  std::vector<double> key_;               // of table_: step and numbers() before it
  std::vector<double> numbers_, memory_;  // before the next step
};

}  // namespace tress::integrators
