#include "experiments/run/verdicts.h"

#include <fmt/format.h>

#include <limits>

namespace tress::experiments {

void Verdicts::add(Claim claim, Verdict verdict) {
  verdict.claim = std::move(claim.words);
  verdict.key = std::move(claim.key);
  all_.push_back(std::move(verdict));
}

void Verdicts::check_found(Claim claim, bool held, bool complete, double value) {
  if (held || complete) {
    check(std::move(claim), held, value);
  } else {
    not_judged(std::move(claim));
  }
}

void Verdicts::check_known(Claim claim, bool held, double value,
                           const KnownLimit& limit) {
  const bool as_known = limit.least <= value && value <= limit.most;
  std::string reason(limit.reason);
  if (held) {
    reason = "was a known limit and holds now: take it off the list; it said: " + reason;
  } else if (!as_known) {
    reason = fmt::format("known to fail with {:.3g} to {:.3g}, not so; it said: {}",
                         limit.least, limit.most, reason);
  }
  const State state = !held && as_known ? State::known_limit : State::changed;
  add(std::move(claim), {{}, held, value, state, std::move(reason)});
}

void Verdicts::not_judged(Claim claim) {
  add(std::move(claim), {{},
                         false,
                         std::numeric_limits<double>::quiet_NaN(),
                         State::not_judged,
                         "the rows that it is about were not run"});
}

void Verdicts::figure(Claim what, double value) {
  add(std::move(what), {{}, false, value, State::figure, "depends on the machine"});
}

std::string_view name(Verdicts::State state) {
  switch (state) {
    case Verdicts::State::held:
      return "passed";
    case Verdicts::State::broken:
      return "failed";
    case Verdicts::State::known_limit:
      return "finding";
    case Verdicts::State::changed:
      return "changed";
    case Verdicts::State::not_judged:
      return "not_judged";
    case Verdicts::State::figure:
      break;
  }
  return "figure";
}

}  // namespace tress::experiments
