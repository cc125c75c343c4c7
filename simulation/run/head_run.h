#pragma once

#include <memory>
#include <span>
#include <vector>

#include "models/effects/strand_interaction.h"
#include "models/head/head.h"
#include "simulation/device/device_head.h"
#include "simulation/run/ranks.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {

/// A head that is advanced and read by a crew, each worker with its share of the blocks,
/// or advanced by a device. Of several ranks each has the whole head and a range of its
/// blocks, in the order of the strands: it steps these alone, and what all ranks share is
/// the same bits on all, whatever their number. Ranges follow the time that steps took,
/// from gather() on.
class HeadRun {
 public:
  /// With the interaction whose effects the head's strands have, if there is one.
  HeadRun(std::unique_ptr<Head> head, int threads,
          std::unique_ptr<models::StrandInteraction> interaction = {});
  /// By ranks, which must outlive it.
  HeadRun(std::unique_ptr<Head> head, int threads,
          std::unique_ptr<models::StrandInteraction> interaction, Ranks& ranks);

  /// Steps are taken on the first device from now on; its name. Throws InputError if the
  /// head is refused, DeviceFailure if there is no device for it.
  const std::string& move_to_device();
  bool on_device() const { return device_ != nullptr; }

  /// From t to t + h (s). Methods that iterate get blocks by the dozen, so that their
  /// lanes find strands to go on with.
  void step(double t, double h);
  /// On a device steps may wait: strands are where all of them have brought them, and
  /// lost() tells of all since the last call. Throws DeviceFailure.
  void fetch();
  /// All ranks get the state of all strands, each from who steps it; it is what else
  /// reads or changes the head between steps.
  void gather();
  /// All ranks get the state of the first.
  void follow_first();
  /// Strands that the last step lost, in their order; of this rank's blocks.
  const std::vector<models::HeadLoss>& lost() const { return lost_; }
  /// Root and tips of elements (m) of every strand, strand after strand.
  void positions(double t, std::vector<double>& x);
  /// Of every strand, on all ranks.
  void energies(double t, std::vector<models::HeadEnergy>& each);
  const Head& head() const { return *head_; }
  /// For whoever changes its state.
  Head& change() {
    if (device_) device_->renew();
    return *head_;
  }
  /// Newton's iterations of all steps so far, of this rank.
  HeadWork work() const;
  Crew& crew() { return crew_; }

 private:
  void ready_scratch();
  /// use(first, last, scratch) for this rank's blocks of each part.
  template <class Use>
  void share(Use use);
  /// use(block, its first strand), of this rank's.
  template <class Use>
  void each_block(Use use);

  /// Strands see each other where they are at t.
  void exchange(double t);

  /// Ranges of equal cost by the time that the last steps took.
  void balance();
  std::size_t begin() const { return begins_[rank_]; }
  std::size_t end() const { return begins_[rank_ + 1]; }
  std::size_t strands_before(std::size_t block) const;
  /// All ranks get what each knows of its strands, `each` numbers of one.
  void share_numbers(std::span<double> x, std::size_t each);
  void recall(std::span<const double> kept);

  std::unique_ptr<models::StrandInteraction> interaction_;
  std::unique_ptr<Head> head_;
  std::unique_ptr<DeviceHead> device_;  // or null
  std::vector<double> x_, v_;           // of exchange()
  Ranks* ranks_;                        // null: this process alone
  std::size_t rank_ = 0;                // of this process
  std::vector<std::size_t> begins_;     // of the ranks' ranges of blocks, and the end
  double stepping_s_ = 0;               // since balance()
  Crew crew_;
  std::vector<std::unique_ptr<Head::Scratch>> scratch_;  // of parts of the head
  std::vector<models::HeadLoss> lost_;
  std::size_t losses_ = 0;  // of all steps
};

}  // namespace tress::simulation
