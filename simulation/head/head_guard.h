#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "models/head/head.h"
#include "simulation/passages/body_passages.h"
#include "simulation/run/energy_account.h"
#include "simulation/run/method_dissipation.h"

namespace tress::simulation {

/// Judges the strands of a head, and reads the potentials of effects on them. Strands are
/// known by their places in the head.
class HeadGuard {
 public:
  virtual ~HeadGuard() = default;

  /// Effects whose potentials (J) are not in HeadEnergy::gravity: those of the scene, in
  /// its order, without uniform accelerations.
  virtual std::size_t effects() const = 0;
  /// Writes effects() potentials (J) for each strand of a block, whose first place is
  /// `first`.
  virtual void potentials(const models::Head& head, std::size_t block, std::size_t first,
                          double t, std::span<double> each) const = 0;

  // Of the strands of a block; different blocks on different threads.
  /// The state with which later ones are compared.
  virtual void start(const models::Head& head, std::size_t block, std::size_t first,
                     double t) = 0;
  /// Whether a step of h that has come to t must be judged.
  virtual bool due(double t, double h) const = 0;
  /// Judges the strands of a block, whose first place is `first`, at t (s).
  virtual void judge(const models::Head& head, std::size_t block, std::size_t first,
                     double t) = 0;
  /// Returns the finding of the last judge(); empty: nothing.
  virtual std::string_view verdict(std::size_t place) const = 0;

  /// Returns the energy that no work explains, of the strand that uses most of its slack.
  virtual Excess excess() const = 0;
  /// Why there is no dissipation(); empty: there is one.
  virtual std::string no_dissipation() const = 0;
  /// Returns the sum over strands of what the method has dissipated.
  virtual MethodDissipation dissipation() const = 0;

  /// Returns the first passage of a strand through a body that steps of its own have
  /// seen; its number is its place. HeadPassages watches strands in lanes.
  virtual std::optional<StrandPassage> passed() const { return {}; }

  /// Returns how many numbers of a strand judge() changes, in addition to those of the
  /// batch.
  virtual std::size_t kept() const = 0;
  /// Writes what judge() changes for one strand.
  virtual void keep(std::size_t place, std::span<double> to) const = 0;
  /// Restores what keep() wrote.
  virtual void recall(std::size_t place, std::span<const double> from) = 0;
};

}  // namespace tress::simulation
