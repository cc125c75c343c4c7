#pragma once

#include <span>
#include <utility>

#include "simulation/device/cuda_driver.h"

/// Resources of a device that their owners release. All calls throw DeviceFailure.
namespace tress::simulation {

/// Compiled kernels on a device.
class CudaModule {
 public:
  /// The driver compiles the image, PTX, for the device.
  CudaModule(const CudaDevice& device, const char* image) : device_(device) {
    device.check(device.driver().cuModuleLoadData(&module_, image), "cuModuleLoadData");
  }
  ~CudaModule() { device_.driver().cuModuleUnload(module_); }
  CudaModule(const CudaModule&) = delete;
  CudaModule& operator=(const CudaModule&) = delete;

  /// Returns the kernel of this name.
  CudaDriver::Handle function(const char* name) const {
    CudaDriver::Handle found = nullptr;
    device_.check(device_.driver().cuModuleGetFunction(&found, module_, name),
                  "cuModuleGetFunction");
    return found;
  }

 private:
  const CudaDevice& device_;
  CudaDriver::Handle module_ = nullptr;
};

class CudaEvent;

/// Calls that are done one after the other, while those of other streams go on.
class CudaStream {
 public:
  /// Creates a stream that does not wait for the default stream.
  explicit CudaStream(const CudaDevice& device) : device_(device) {
    constexpr unsigned non_blocking = 1;
    device.check(device.driver().cuStreamCreate(&stream_, non_blocking),
                 "cuStreamCreate");
  }
  /// Waits for what it still has to do.
  ~CudaStream() {
    device_.driver().cuStreamSynchronize(stream_);
    device_.driver().cuStreamDestroy_v2(stream_);
  }
  CudaStream(const CudaStream&) = delete;
  CudaStream& operator=(const CudaStream&) = delete;

  /// Returns the driver's handle.
  CudaDriver::Handle handle() const { return stream_; }
  /// Waits until all work of the stream is done.
  void synchronize() const {
    device_.check(device_.driver().cuStreamSynchronize(stream_), "cuStreamSynchronize");
  }
  /// Makes the following work wait for the work that the event has recorded.
  void wait(const CudaEvent& event) const;

 private:
  const CudaDevice& device_;
  CudaDriver::Handle stream_ = nullptr;
};

/// All that a stream was given up to record().
class CudaEvent {
 public:
  /// Creates an event without times.
  explicit CudaEvent(const CudaDevice& device) : device_(device) {
    constexpr unsigned without_times = 2;
    device.check(device.driver().cuEventCreate(&event_, without_times), "cuEventCreate");
  }
  ~CudaEvent() { device_.driver().cuEventDestroy_v2(event_); }
  CudaEvent(const CudaEvent&) = delete;
  CudaEvent& operator=(const CudaEvent&) = delete;

  /// Returns the driver's handle.
  CudaDriver::Handle handle() const { return event_; }
  /// Records the work that the stream was given so far.
  void record(const CudaStream& stream) const {
    device_.check(device_.driver().cuEventRecord(event_, stream.handle()),
                  "cuEventRecord");
  }

 private:
  const CudaDevice& device_;
  CudaDriver::Handle event_ = nullptr;
};

inline void CudaStream::wait(const CudaEvent& event) const {
  device_.check(device_.driver().cuStreamWaitEvent(stream_, event.handle(), 0),
                "cuStreamWaitEvent");
}

/// Numbers on the device and, in memory that it can copy by itself, on the host.
template <class T>
class CudaArray {
 public:
  /// Allocates `size` numbers in both memories.
  CudaArray(const CudaDevice& device, std::size_t size) : device_(device), size_(size) {
    const CudaDriver& driver = device.driver();
    device.check(driver.cuMemAlloc_v2(&there_, size * sizeof(T)), "cuMemAlloc");
    void* here = nullptr;
    const auto result = driver.cuMemHostAlloc(&here, size * sizeof(T), 0);
    if (result != 0) driver.cuMemFree_v2(there_);
    device.check(result, "cuMemHostAlloc");
    here_ = static_cast<T*>(here);
  }
  ~CudaArray() {
    free_host();
    device_.driver().cuMemFree_v2(there_);
  }
  CudaArray(const CudaArray&) = delete;
  CudaArray& operator=(const CudaArray&) = delete;

  /// Returns the numbers on the host.
  std::span<T> host() const { return {here_, size_}; }
  /// Frees the memory on the host.
  void free_host() {
    if (here_ != nullptr) device_.driver().cuMemFreeHost(std::exchange(here_, nullptr));
  }
  /// Returns the address of the numbers on the device.
  T* device() const { return reinterpret_cast<T*>(there_); }

  /// The first `count` of them.
  void up(const CudaStream& stream, std::size_t count) const {
    device_.check(device_.driver().cuMemcpyHtoDAsync_v2(there_, here_, count * sizeof(T),
                                                        stream.handle()),
                  "cuMemcpyHtoDAsync");
  }
  /// Copies all numbers to the device, as the next work of the stream.
  void up(const CudaStream& stream) const { up(stream, size_); }
  /// Copies all numbers to the host, as the next work of the stream.
  void down(const CudaStream& stream) const {
    device_.check(device_.driver().cuMemcpyDtoHAsync_v2(here_, there_, size_ * sizeof(T),
                                                        stream.handle()),
                  "cuMemcpyDtoHAsync");
  }

 private:
  const CudaDevice& device_;
  std::size_t size_;
  CudaDriver::Pointer there_ = 0;
  T* here_ = nullptr;
};

}  // namespace tress::simulation
