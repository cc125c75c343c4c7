#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "simulation/head/head_guard.h"
#include "simulation/head/make_head.h"
#include "simulation/run/energy_account.h"
#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Guard of every strand of a batch in SIMD lanes. It has Guard's account of energy,
/// bound of speed and, for springs, bound of stretch, with the work of all effects.
/// Strands are known by their places in the batch.
///
/// Energies are those of the batch. Potentials, loads and powers of effects are those on
/// the points where its model has them act: the nodes of springs, otherwise the
/// Gauss-Legendre points of the elements. Nodes also serve where nothing but gravity and
/// linear drag acts.
///
/// A state is judged with every frame. Where nothing can do work on a strand in the frame
/// of the head, that is enough, as the bound does not change. Under gravity and linear
/// drag alone a head that moves does smooth work. States are then also judged every ten
/// steps or 20 ms, otherwise as often as by Guard. Cost: of the energies and positions of
/// a block, about a third of a step, and of its effects' loads.
class LaneGuard final : public HeadGuard {
 public:
  /// Constructs the guard of a batch with these options. `at_rest`: whether all effects
  /// other than gravity and drag do no work in the frame of the head.
  LaneGuard(const Scene& scene, const HeadOptions& options, bool at_rest);

  /// Allocates memory for a number of strands.
  void reserve(std::size_t strands) { strands_.reserve(strands); }
  /// The strand at the next place, with the effects on it alone.
  void add(const Strand& strand, models::Effects own);

  std::size_t effects() const override { return placed_.size(); }
  void potentials(const models::Head& head, std::size_t block, std::size_t first,
                  double t, std::span<double> each) const override;
  void start(const models::Head& head, std::size_t block, std::size_t first,
             double t) override;
  bool due(double t, double h) const override;
  /// Judges the strands of a block at t (s).
  void judge(const models::Head& head, std::size_t block, std::size_t first,
             double t) override;
  std::string_view verdict(std::size_t place) const override {
    return strands_[place].verdict;
  }
  /// Returns that of the strand that uses most of its slack.
  Excess excess() const override {
    Excess most;
    for (const OfStrand& one : strands_) most.take(one.account.excess());
    return most;
  }
  /// Lanes compute no power of internal friction and of the clamp.
  std::string no_dissipation() const override {
    return "SIMD lanes compute no power of internal friction and of the clamp: give "
           "--as strands";
  }
  MethodDissipation dissipation() const override { return {}; }
  std::size_t kept() const override { return EnergyAccount::remembered; }
  /// Writes the account of a strand.
  void keep(std::size_t place, std::span<double> to) const override;
  /// Restores what keep() wrote.
  void recall(std::size_t place, std::span<const double> from) override;

  /// Verdict of the bound of energy.
  static constexpr std::string_view too_much_energy =
      "it had more energy than it can have";
  /// Verdict of the bound of speed.
  static constexpr std::string_view too_fast = "it was faster than its energy allows";
  /// Verdict of the bound of stretch.
  static constexpr std::string_view off_length =
      "a segment was off its length by more than half of it";

 private:
  struct OfStrand {
    double length = 0, slack = 0;  // m, of an element; J
    EnergyAccount account;
    std::string_view verdict;
  };
  class Reader;

  /// Whether effects act on points of curved elements.
  bool curved() const { return (helices_ || clothoids_) && !at_.empty(); }

  RootMotion motion_;
  models::Effects effects_;
  std::vector<const models::Effect*> placed_;  // of these, those with potentials here
  bool moves_, works_;  // the head; whether anything can do work in its frame
  bool at_rest_;        // as LaneGuard()
  bool stretches_;      // springs
  bool
      acts_somewhere_;  // whether the load of some effect depends on the place of a point
  std::vector<double> at_, weight_;  // of points, of an element's length; none: nodes
  bool helices_, clothoids_;         // elements of constant, of linear curvature
  std::size_t elements_;
  std::vector<OfStrand> strands_;
  std::vector<Frame> frames_;         // of the roots at rest, if curved()
  std::vector<models::Effects> own_;  // of each strand, or empty
};

}  // namespace tress::simulation
