#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/head/helix_source.h"
#include "simulation/device/cuda_driver.h"

namespace tress::simulation {

using models::Head;

/// Takes the steps of a head on a device while the head keeps its strands for those who
/// read them:
///
///     state up once --> step, step, ... (collected) --> fetch(): one launch, state down
///
/// Strands are cut into slices that take turns on two streams: the state of one comes
/// down into pinned memory while the next one is computed. Memory on the device: 20 + 9
/// elements numbers and one flag a strand, and what its threads need.
class DeviceHead {
 public:
  virtual ~DeviceHead() = default;

  /// Calls work(i) for i < count, by several threads.
  using Share = std::function<void(std::size_t count,
                                   const std::function<void(std::size_t)>& work)>;

  /// Returns the name of the device.
  virtual const std::string& name() const = 0;
  /// Steps the strands from t to t + h (s), at some time before fetch() returns.
  virtual void step(double t, double h) = 0;
  /// Puts the strands where all steps so far have brought them; those that were lost.
  /// Throws DeviceFailure where the device fails; the head is then as it was before.
  virtual std::vector<models::HeadLoss> fetch(const Share& share) = 0;
  /// Somebody else has changed the head.
  virtual void renew() = 0;
};

/// Why no device can step a head, whatever the machine; nothing if one can.
std::optional<models::HeadRefusal> refused_by_device(const Head& head);
/// Makes a batch on the first device. `head` must outlive it and must not be refused.
/// Throws DeviceFailure if there is no device or it cannot hold the strands. Slices of
/// the given size keep a large device busy; with one slice nothing overlaps.
std::unique_ptr<DeviceHead> device_head(Head& head, std::size_t slice_strands = 32768);

}  // namespace tress::simulation
