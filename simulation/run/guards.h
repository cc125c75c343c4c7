#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "models/groom/strand_block.h"
#include "simulation/run/guard.h"

namespace tress::simulation {

/// Guards a system of one strand or more. Strands whose energies are separate have a
/// guard each: none may have the energy that only the others could gain.
class Guards {
 public:
  /// Numbers of all guards, one after the other.
  using Memory = std::vector<double>;

  /// One guard for the whole: a strand, a mechanism, or strands whose contacts have
  /// energy too.
  explicit Guards(Guard whole) { parts_.push_back({std::move(whole)}); }
  /// A guard for each strand.
  Guards(StrandBlock& block, const std::vector<GuardedStrand>& strands,
         std::size_t first) {
    std::size_t begin = 0;
    for (std::size_t k = 0; k < strands.size(); ++k) {
      System& strand = block.strand(k);
      const auto n = static_cast<std::size_t>(strand.layout().coordinates);
      parts_.push_back({Guard(strand, {strands[k]}, first + k), begin, n});
      begin += n;
    }
  }

  // As those of Guard.
  /// Starts all guards from a state.
  void start(double t, In q, In v) {
    for (Part& part : parts_) part.guard.start(t, part.of(q), part.of(v));
  }
  /// Checks a state as Guard does, for every guard.
  bool operator()(double t, In q, In v) {
    return all([&](Part& part) { return part.guard(t, part.of(q), part.of(v)); });
  }
  /// Checks a state for every guard unconditionally.
  bool judge(double t, In q, In v) {
    return all([&](Part& part) { return part.guard.judge(t, part.of(q), part.of(v)); });
  }
  /// Tells every guard that its strand was carried at a teleport.
  void teleported(double t, In q, In v) {
    for (Part& part : parts_) part.guard.teleported(t, part.of(q), part.of(v));
  }
  /// The first one, of the first strand.
  const std::optional<Breach>& breach() const {
    const auto broken = std::ranges::find_if(
        parts_, [](const Part& part) { return part.guard.breach().has_value(); });
    return (broken == parts_.end() ? parts_.front() : *broken).guard.breach();
  }
  /// Returns the sum of the dissipation of all guards.
  MethodDissipation dissipation() const {
    MethodDissipation sum;
    for (const Part& part : parts_) sum += part.guard.dissipation();
    return sum;
  }

  /// Returns the excess of the part that uses most of its slack.
  Excess excess() const {
    Excess most;
    for (const Part& part : parts_) most.take(part.guard.excess());
    return most;
  }

  /// Returns the number of entries of memory().
  std::size_t remembered() const { return Guard::remembered * parts_.size(); }
  /// Returns all data gathered since start().
  Memory memory() const {
    Memory all;
    for (const Part& part : parts_) {
      const Guard::Memory one = part.guard.memory();
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  }
  /// Restores what memory() returned at time t and these places.
  void recall(In memory, double t, In q) {
    for (Part& part : parts_) {
      part.guard.recall(memory.first(Guard::remembered), t, part.of(q));
      memory = memory.subspan(Guard::remembered);
    }
  }

 private:
  struct Part {
    Guard guard;
    std::size_t first = 0, coordinates = std::dynamic_extent;
    In of(In x) const { return x.subspan(first, coordinates); }
  };
  /// All parts are asked, as each counts its steps.
  template <class Ask>
  bool all(const Ask& ask) {
    bool sound = true;
    for (Part& part : parts_) sound = ask(part) && sound;
    return sound;
  }

  std::vector<Part> parts_;
};

}  // namespace tress::simulation
