#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "simulation/passages/body_passages.h"

namespace tress::simulation {

/// Decides which steps of a batch in lanes are searched for strands that pass through
/// bodies, and keeps what was found. A search reads all positions. Every fourth step is
/// searched, and every step while points move by more than an eighth of half of a body's
/// thickness in a step.
class HeadPassages {
 public:
  /// Takes the search that it decides about.
  explicit HeadPassages(BodyPassages passages) : passages_(std::move(passages)) {}

  /// Returns whether the step of h from t (s) must be searched.
  bool due(double t, double h) {
    if (++steps_ >= every || fast(longest_)) return true;
    // Bodies that move although strands are known to be slow.
    const std::span<const double> some(
        x.data(), std::min(x.size(), 3 * passages_.places().points()));
    return some.empty() || fast(passages_.find({t, t + h, some, some}).longest);
  }
  /// Returns whether `x` are the positions at t.
  bool knows(double t) const { return t == known_; }
  /// The strands have been given other positions.
  void forget() { known_ = std::numeric_limits<double>::quiet_NaN(); }
  /// Searches the paths of one strand.
  BodyPassages::Found find(const models::Paths& paths) const {
    return passages_.find(paths);
  }
  /// Takes the findings of a step that has come to t, and the positions there.
  void take(double t, std::vector<double> now, double longest,
            const std::optional<StrandPassage>& found) {
    x = std::move(now);
    known_ = t;
    longest_ = longest;
    steps_ = 0;
    if (!first) first = found;
  }

  std::vector<double> x;               // own strands, at the last known time, m
  std::optional<StrandPassage> first;  // of all steps

 private:
  static constexpr int every = 4;
  static bool fast(double longest) { return longest > 0.125; }

  BodyPassages passages_;
  int steps_ = every;  // since the last search
  double longest_ = 0, known_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace tress::simulation
