#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "contract/basics.h"
#include "models/contact/box_pairs.h"
#include "models/effects/strand_interaction.h"
#include "models/motion/root_motion.h"
#include "simulation/head/cell_set.h"
#include "simulation/head/chosen_effect.h"
#include "simulation/head/head_division.h"
#include "simulation/head/ranks.h"

namespace tress::simulation {

/// Strands of other ranks that may touch those of this one (its ghosts), and their
/// forces:
///
///     look() -> send() ... strands that no ghost can touch ... receive() -> the others
///
/// Every point of a strand claims a ball whose radius, its room, is the distance that the
/// point may move in a few steps, seen from the head. While no point has left its room,
/// two strands can touch in a step only if their claims come within reach of each other.
/// When a point leaves its room, all ranks rebuild their claims. The rank of each strand
/// determines the receivers from the cells in which other ranks' claims lie. Own strands
/// that are sent are those that may touch ghosts. In an interaction of their own they
/// meet the ghosts and the own strands near them. The order is that of the whole batch,
/// so that forces are bit-identical to those of one rank. Steps take O(strands sent),
/// claims O(points).
class Halo {
 public:
  /// `interaction` of own strands; `effects` by their places, which use it.
  Halo(Ranks& ranks, std::shared_ptr<const HeadDivision> division,
       models::RootMotion motion, const models::StrandInteraction& interaction,
       std::vector<std::shared_ptr<ChosenEffect>> effects, std::size_t points);

  /// Root and tips at t, and the results of Head::ahead(), by the numbers of own strands.
  struct Places {
    In x, ahead, bulge;  // positions (m), and the results of Head::ahead()
  };
  /// Prepares a step from t to t + h; returns whether claims were rebuilt.
  bool look(double t, double h, const Places& places, const models::Loop& loop);
  /// Own strands' root and tips and their velocities, by numbers, to who needs them.
  void send(In x, In v);
  /// Waits for ghosts; strands that may touch them see them.
  void receive(In x, In v, const models::Loop& loop);
  /// Own strands that may touch ghosts, by the order of their numbers.
  const std::vector<std::size_t>& touched() const { return touched_; }

  /// Since the run began, on this rank.
  struct Work {
    long steps = 0, claims = 0;          // claims: how often they were made
    double sent = 0, ghosts = 0;         // strands, all steps
    double claim_s = 0, exchange_s = 0;  // exchange_s: packing, waiting, unpacking
    double meet_s = 0;                   // to list what touches strands that are sent
  };
  /// Returns the work since the run began.
  const Work& work() const { return work_; }

 private:
  struct Neighbour {
    int rank;
    std::vector<std::size_t> sent;    // own strands, by the order of numbers
    std::vector<std::size_t> ghosts;  // their numbers
    std::vector<double> out, in;      // x and v of one strand after the other
  };
  /// A strand that others meet, ascending numbers.
  struct Met {
    std::size_t number;
    const Neighbour* from;  // null: an own one
    std::size_t index;      // among what comes from there, or own ones
  };

  std::size_t own() const { return division_->own().size(); }
  bool left_room(const Places& places, const models::RootPose& pose,
                 const models::Loop& loop) const;
  void claim(const Places& places, const models::RootPose& now,
             const models::RootPose& next, const models::Loop& loop);
  /// Calls use(box, room) for the pieces of a strand's polyline where claims were made.
  template <class Use>
  void each_piece(std::size_t strand, Use use) const;
  void find_neighbours(const models::Loop& loop);
  void find_met(const models::Loop& loop);
  std::vector<std::size_t> near(const CellSet& cells, const models::Loop& loop) const;

  Ranks& ranks_;
  std::shared_ptr<const HeadDivision> division_;
  models::RootMotion motion_;
  const models::StrandInteraction& interaction_;
  std::vector<std::shared_ptr<ChosenEffect>> effects_;
  std::size_t points_;  // of a strand
  bool claimed_ = false;
  // Of own points where claims were made, seen from the head, m.
  std::vector<Vec> at_;
  std::vector<double> room_;
  std::vector<models::Box> boxes_;  // of own strands' claims
  Vec corner_;                      // of cells
  double size_ = 1;                 // of a cell
  double rounding_ = 0;             // of places, m
  models::Box claims_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::size_t> touched_;
  std::vector<Met> met_;
  std::unique_ptr<models::StrandInteraction> between_;  // of met_
  std::vector<double> x_, v_;                           // of met_
  Work work_;
};

}  // namespace tress::simulation
