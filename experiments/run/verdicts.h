#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments {

/// A claim known not to hold, the reason, and bounds on its deciding number: within these
/// bounds it is a finding and no alarm.
struct KnownLimit {
  std::string_view claim;
  double least, most;
  std::string_view reason;
};

/// A claim, or the name of a figure. Pages find it in the manifest by its key, if it has
/// one; the words may change.
struct Claim {
  std::string words, key;

  Claim(std::string in_words, std::string its_key = {})
      : words(std::move(in_words)), key(std::move(its_key)) {}
  Claim(const char* in_words, std::string its_key = {})
      : Claim(std::string(in_words), std::move(its_key)) {}
};

/// Claims about a finished table: printed when it is written and stored in the manifest
/// for the report. A claim refers to certain rows and is judged where they were run. A
/// time, or a ratio of times, depends on the machine and is a figure, never a claim.
class Verdicts {
 public:
  enum class State {
    held,
    broken,       // alarm
    known_limit,  // known not to hold
    changed,      // alarm: a known limit that now holds or is out of its bounds
    not_judged,   // the rows it refers to were not run
    figure
  };

  struct Verdict {
    std::string claim;
    bool held;
    double value;  // the deciding number; NaN: none
    State state = held ? State::held : State::broken;
    std::string reason = {};  // why it neither held nor broke
    std::string key = {};     // of the claim

    bool alarm() const { return state == State::broken || state == State::changed; }
  };

  void check(Claim claim, bool held, double value) {
    const State state = held ? State::held : State::broken;
    add(std::move(claim), {{}, held, value, state});
  }

  /// A claim that one row can show but only all rows together refute: `complete`
  /// indicates whether all rows that could show it were run.
  void check_found(Claim claim, bool held, bool complete, double value);

  /// Checks a claim as `check` does, for a claim known to be false.
  void check_known(Claim claim, bool held, double value, const KnownLimit& limit);

  void not_judged(Claim claim);
  void figure(Claim what, double value);

  const std::vector<Verdict>& all() const { return all_; }

 private:
  void add(Claim claim, Verdict verdict);

  std::vector<Verdict> all_;
};

std::string_view name(Verdicts::State state);

}  // namespace tress::experiments
