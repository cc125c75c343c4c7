#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments {

/// A claim that is known not to hold, why, and the number that decides it: as long as
/// that stays within these bounds it is a finding and no alarm.
struct KnownLimit {
  std::string_view claim;
  double least, most;
  std::string_view reason;
};

/// What a finished table must show, claim by claim: told when it is written and kept in
/// the manifest, so that the report can show it. A claim speaks of certain rows, and it
/// is judged where they were run; a time, or a ratio of times, depends on the machine and
/// is a figure, never a claim.
class Verdicts {
 public:
  enum class State {
    held,
    broken,       // alarm
    known_limit,  // does not hold, as is known
    changed,      // alarm: a known limit that is none any more, or another one
    not_judged,   // the rows it speaks of were not run
    figure
  };

  struct Verdict {
    std::string claim;
    bool held;
    double value;  // the number that decided; NaN: there is none
    State state = held ? State::held : State::broken;
    std::string reason = {};  // of what neither held nor broke

    bool alarm() const { return state == State::broken || state == State::changed; }
  };

  void check(std::string claim, bool held, double value) {
    all_.push_back({std::move(claim), held, value});
  }

  /// A claim that one row can show and all of them together refute: `complete` tells
  /// whether those that could show it were run.
  void check_found(std::string claim, bool held, bool complete, double value);

  /// As `check`, of what does not hold and is known not to.
  void check_known(std::string claim, bool held, double value, const KnownLimit& limit);

  void not_judged(std::string claim);
  void figure(std::string what, double value);

  const std::vector<Verdict>& all() const { return all_; }

 private:
  std::vector<Verdict> all_;
};

std::string_view name(Verdicts::State state);

}  // namespace tress::experiments
