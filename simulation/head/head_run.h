#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/effects/strand_interaction.h"
#include "models/head/head.h"
#include "simulation/device/device_head.h"
#include "simulation/head/halo.h"
#include "simulation/head/head_division.h"
#include "simulation/head/ranks.h"
#include "simulation/head/scene_head.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {

/// Batch that a crew advances and reads, each worker with its share of the blocks, or
/// that a device advances. Of several ranks each holds its own strands (HeadDivision),
/// and no others but those that may touch them (Halo). Numbers of all strands reach the
/// first rank in chunks of the requested size. Results are bit-identical for any number
/// of ranks, threads and lanes.
class HeadRun {
 public:
  /// Constructs a run by this process alone. `interaction`: the one whose effects the
  /// batch's strands have, if any.
  HeadRun(std::unique_ptr<Head> head, int threads,
          std::unique_ptr<models::StrandInteraction> interaction = {});
  /// Constructs a run by the ranks for which the batch was made; they must outlive it.
  HeadRun(SceneHead made, int threads, Ranks& ranks);
  /// Constructs a run on this process alone.
  HeadRun(SceneHead made, int threads) : HeadRun(std::move(made), threads, alone_) {}

  /// Steps are taken on the first device from now on; its name. Throws InputError if the
  /// head is refused, DeviceFailure if there is no device for it.
  const std::string& move_to_device();
  /// Returns true after move_to_device().
  bool on_device() const { return device_ != nullptr; }
  /// Whether strands are stepped in SIMD lanes, else each as a system of its own.
  bool lanes() const { return lanes_; }

  /// Steps from t to t + h (s). Methods that iterate get blocks by the dozen, so that
  /// their lanes can be refilled with other strands.
  void step(double t, double h);
  /// Waits for all steps of the device and copies the strands. lost() then lists all
  /// failures since the last call. Throws DeviceFailure.
  void fetch();
  /// Judges all strands where they are at t, by HeadGuard if there is one: those that
  /// fail are lost, and lost() tells of them. Steps do so as often as HeadGuard asks for,
  /// but not at frames.
  void judge(double t);
  /// Own strands that the last step lost, by their numbers in the whole head.
  const std::vector<models::HeadLoss>& lost() const { return lost_; }

  /// Returns the first own strand that passed through a body within a step, by its number
  /// in the whole head. Strands in lanes with a tolerance are not watched.
  std::optional<StrandPassage> passed() const;

  // Of this rank's own strands, by their places: see HeadDivision.
  /// Returns the division of strands among ranks.
  const HeadDivision& division() const { return *division_; }
  /// Returns the batch of own strands.
  const Head& head() const { return *head_; }
  /// Returns the batch for changes of its state.
  Head& change() {
    if (device_) device_->renew();
    return *head_;
  }
  /// Root and tips of elements (m), strand after strand.
  void positions(double t, std::vector<double>& x);
  /// Computes the energies of own strands, J.
  void energies(double t, std::vector<models::HeadEnergy>& each);
  /// Returns the energy that no work explains, of the strand of any rank that uses most
  /// of its slack. All ranks call it.
  Excess excess();
  /// Why dissipation() is empty; empty: it is not.
  std::string no_dissipation() const;
  /// Returns what the method has dissipated on all strands of all ranks, which all call
  /// it. Empty without an account: see no_dissipation().
  std::optional<MethodDissipation> dissipation();
  /// Returns the number of HeadGuard::potentials() of each strand; none without a scene.
  std::size_t effects() const { return guard_ ? guard_->effects() : 0; }
  /// Computes the potentials of effects on own strands, strand after strand, J.
  void potentials(double t, std::vector<double>& each);

  // Of strands of all ranks; all call these with the same strands, ascending numbers.
  /// Numbers of strands in the whole batch, ascending.
  using Numbers = std::span<const std::size_t>;
  /// Returns the number of strands of all ranks.
  std::size_t strands() const { return division_->strands(); }
  /// Reads `each` numbers of every strand of an own block.
  using Read = std::function<void(std::size_t block, std::span<double> to)>;
  /// Collects the numbers read from these strands, one after the other, on the first
  /// rank; other ranks get nothing.
  void collect(Numbers strands, std::size_t each, const Read& read,
               std::vector<double>& all);
  /// Collects root and tips (m) of these strands on the first rank.
  void positions(double t, Numbers strands, std::vector<double>& x);
  /// Returns how many numbers keep() and recall() transfer per strand: those of the batch
  /// and of the guard. The first rank's numbers are recalled.
  std::size_t kept() const { return head_->kept() + (guarded_ ? guard_->kept() : 0); }
  /// Collects what these strands keep on the first rank.
  void keep(Numbers strands, std::vector<double>& kept);
  /// Restores what keep() collected, from the first rank.
  void recall(Numbers strands, std::vector<double>& kept);
  /// Calls use(strands) for all strands, `chunk` at a time.
  void by_chunks(std::size_t chunk, const std::function<void(Numbers)>& use) const;
  /// Returns Head::hash() of all strands, on the first rank.
  std::size_t hash();

  /// Newton's iterations of all steps so far, of this rank.
  HeadWork work() const;
  /// Wall time of this rank's steps since the last call, without waiting for others.
  double stepping_s();
  /// Returns the halo, with the cost of other ranks' strands; null: none touch its own.
  const Halo* halo() const { return halo_.get(); }
  /// Returns the threads.
  Crew& crew() { return crew_; }
  /// Returns the processes.
  Ranks& ranks() { return *ranks_; }

 private:
  struct Blocks {
    std::size_t begin, end;
  };

  /// Pieces of consecutive blocks for which `wanted` holds, for the crew.
  std::vector<Blocks> pieces(const std::function<bool(std::size_t)>& wanted) const;
  /// use(blocks, scratch) for each piece.
  template <class Use>
  void share(const std::vector<Blocks>& among, Use use);
  /// use(block, its first place), of all own blocks.
  template <class Use>
  void each_block(Use use);
  std::size_t first_of(std::size_t block) const;
  void take_steps(const std::vector<Blocks>& of, double t, double h);
  /// Searches the step of h that has come to t for strands that pass through bodies.
  void find_passages(double t, double h);
  /// A step has been taken; `ready` brings the strands here if they must be judged.
  template <class Ready>
  void taken(double t, double h, Ready ready);
  /// `start`: of the step that has come to t.
  void find_failed(double t, double start);
  /// Writes the numbers of a block for keep() and recall().
  void keep(std::size_t block, std::span<double> to) const;
  void recall(std::size_t block, std::span<const double> from);

  /// Strands see each other where they are at t, for a step of h.
  void look(double t, double h);
  /// x_ and v_ of own strands become those of all.
  void share_motion();
  models::Loop loop();
  /// Calls use(block, listed strands) for the own strands of a list, by blocks.
  void own_blocks_of(
      Numbers strands,
      const std::function<void(std::size_t, std::span<const HeadDivision::Listed>)>& use);

  OneRank alone_;
  Ranks* ranks_;
  std::shared_ptr<const HeadDivision> division_;
  // Of own strands, by numbers; not in lanes: of all.
  std::unique_ptr<models::StrandInteraction> interaction_;
  std::unique_ptr<Halo> halo_;  // or null
  std::unique_ptr<Head> head_;
  std::unique_ptr<HeadGuard> guard_;        // or null
  bool guarded_;                            // whether it judges
  std::unique_ptr<HeadPassages> passages_;  // or null
  bool lanes_;
  long steps_ = 0;
  std::unique_ptr<DeviceHead> device_;  // or null
  // By numbers, of look(): positions, velocities, and what Head::ahead() says.
  std::vector<double> x_, v_, ahead_, bulge_;
  Crew crew_;
  std::vector<Blocks> all_;            // pieces for the crew
  std::vector<Blocks> inner_, outer_;  // of strands that other ranks' cannot, may touch
  std::vector<std::unique_ptr<Head::Scratch>> scratch_;  // of workers
  std::vector<models::HeadLoss> lost_;
  std::size_t losses_ = 0;  // of all steps
  double stepping_s_ = 0;
};

}  // namespace tress::simulation
