#pragma once

#include <string_view>

namespace tress::integrators {

/// Chooses the lengths of steps (or of other intervals of time) such that an estimated
/// error that falls as h^k stays below its threshold. The rule is PI control with gains
/// 0.7/k and 0.4/k [Gustafsson 1991, ACM TOMS 17, 533], a dead band that leaves the
/// length unchanged, and no growth after a rejection. A step without a solution also sets
/// a ceiling, which rises slowly. The estimate does not reveal the cause, and steps would
/// otherwise grow into the same failure again and again.
class StepControl {
 public:
  /// Controls an error that falls as h^k.
  explicit StepControl(int k) : k_(k) {}

  /// Begins with h (s); a step below `least` is too short.
  void start(double h, double least);
  /// Forgets the last estimate, for equations that have changed; the length remains.
  void forget() { before_ = 1; }

  /// Length of a step to be tried.
  struct Trial {
    double h;    // s
    bool cut;    // shorter than what the control asked for
    bool whole;  // all that is left
  };
  /// The next step with `left` s to go, at most `longest` s.
  Trial next(double left, double longest) const;

  /// The step was taken at t; `error`: its estimate over the threshold, at most 1.
  void accept(const Trial& taken, double error, double t);
  /// `error`: as above, more than 1 or not a number.
  void reject(const Trial& failed, double error);
  /// There was no solution; `cause`: a word for it.
  void unsolved(const Trial& failed, std::string_view cause);
  /// After a rejection: the next step is below `least`.
  bool too_short() const { return !(h_ >= least_); }
  /// Returns the shortest length that is allowed, s.
  double least() const { return least_; }

  /// The shortest step that was accepted and not cut; h = 0: none.
  struct Shortest {
    double h = 0, at = 0;         // s
    std::string_view cause = "";  // cause: "start", "error" or that of unsolved()
  };
  /// Returns the shortest step since start().
  const Shortest& shortest() const { return shortest_; }

 private:
  void shorten(double h, std::string_view cause);

  double k_;
  double h_ = 0;            // of the next step
  double least_ = 0;        // for it
  double ceiling_ = 0;      // for it
  double before_ = 1;       // estimate of the step before, over the threshold
  bool rejected_ = false;   // the last trial
  std::string_view cause_;  // of h_
  Shortest shortest_;
};

}  // namespace tress::integrators
