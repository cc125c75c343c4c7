#pragma once

#include <memory>
#include <vector>

#include "models/effects/strand_interaction.h"
#include "models/head/head.h"
#include "simulation/device/device_head.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {

/// A head that is advanced and read by a crew, each worker with its share of the blocks,
/// or advanced by a device.
class HeadRun {
 public:
  /// With the interaction whose effects the head's strands have, if there is one.
  HeadRun(std::unique_ptr<Head> head, int threads,
          std::unique_ptr<models::StrandInteraction> interaction = {});

  /// Steps are taken on the first device from now on; its name. Throws InputError if the
  /// head is refused, DeviceFailure if there is no device for it.
  const std::string& move_to_device();

  /// From t to t + h (s). Methods that iterate get blocks by the dozen, so that their
  /// lanes find strands to go on with.
  void step(double t, double h);
  /// On a device steps may wait: strands are where all of them have brought them, and
  /// lost() tells of all since the last call. Throws DeviceFailure.
  void fetch();
  /// Strands that the last step lost, in their order.
  const std::vector<models::HeadLoss>& lost() const { return lost_; }
  /// Root and tips of elements (m) of every strand, strand after strand.
  void positions(double t, std::vector<double>& x);
  /// Of every strand.
  void energies(double t, std::vector<models::HeadEnergy>& each);
  const Head& head() const { return *head_; }
  /// For whoever changes its state.
  Head& change() {
    if (device_) device_->renew();
    return *head_;
  }
  /// Newton's iterations of all steps so far.
  HeadWork work() const;
  Crew& crew() { return crew_; }

 private:
  /// use(first, last, scratch) for the blocks of each part.
  template <class Use>
  void share(Use use);
  /// use(block, its first strand).
  template <class Use>
  void each_block(Use use);

  /// Strands see each other where they are at t.
  void exchange(double t);

  std::unique_ptr<models::StrandInteraction> interaction_;
  std::unique_ptr<Head> head_;
  std::unique_ptr<DeviceHead> device_;  // or null
  std::vector<double> x_, v_;           // of exchange()
  Crew crew_;
  std::vector<std::unique_ptr<Head::Scratch>> scratch_;  // of parts of the head
  std::vector<models::HeadLoss> lost_;
  std::size_t losses_ = 0;  // of all steps
};

}  // namespace tress::simulation
