#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

namespace tress::simulation {

/// The few calls of NVIDIA's driver API that a head needs (CUDA Driver API Reference),
/// under the names and with the types of its library. No SDK is needed: who has a device
/// has the library with its driver.
struct CudaDriver {
  using Result = int;  // 0: done
  /// Address on the device.
  using Pointer = unsigned long long;
  using Handle = struct Opaque*;  // of contexts, modules, functions, streams, events

  /// Call of the driver, as in the CUDA Driver API Reference. @{
  Result (*cuInit)(unsigned flags);
  Result (*cuGetErrorName)(Result, const char** name);
  Result (*cuDeviceGetCount)(int* count);
  Result (*cuDeviceGet)(int* device, int ordinal);
  Result (*cuDeviceGetName)(char* name, int length, int device);
  Result (*cuDevicePrimaryCtxRetain)(Handle* context, int device);
  Result (*cuDevicePrimaryCtxRelease_v2)(int device);
  Result (*cuCtxSetCurrent)(Handle context);
  Result (*cuModuleLoadData)(Handle* module, const void* image);
  Result (*cuModuleUnload)(Handle module);
  Result (*cuModuleGetFunction)(Handle* function, Handle module, const char* name);
  Result (*cuMemAlloc_v2)(Pointer*, std::size_t bytes);
  Result (*cuMemFree_v2)(Pointer);
  Result (*cuMemHostAlloc)(void**, std::size_t bytes, unsigned flags);
  Result (*cuMemFreeHost)(void*);
  Result (*cuMemcpyHtoDAsync_v2)(Pointer to, const void* from, std::size_t, Handle);
  Result (*cuMemcpyDtoHAsync_v2)(void* to, Pointer from, std::size_t, Handle stream);
  Result (*cuStreamCreate)(Handle* stream, unsigned flags);
  Result (*cuStreamDestroy_v2)(Handle stream);
  Result (*cuStreamSynchronize)(Handle stream);
  Result (*cuStreamWaitEvent)(Handle stream, Handle event, unsigned flags);
  Result (*cuEventCreate)(Handle* event, unsigned flags);
  Result (*cuEventDestroy_v2)(Handle event);
  Result (*cuEventRecord)(Handle event, Handle stream);
  Result (*cuLaunchKernel)(Handle function, unsigned blocks_x, unsigned blocks_y,
                           unsigned blocks_z, unsigned threads_x, unsigned threads_y,
                           unsigned threads_z, unsigned shared_bytes, Handle stream,
                           void** arguments, void** extra);
  /// @}
};

/// The device is not available or has failed; what() gives the reason.
struct DeviceFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The first device of libcuda.so.1, its driver and its primary context, until the end of
/// the object. Throws DeviceFailure if there is none.
class CudaDevice {
 public:
  /// Opens the library, the first device and its primary context.
  CudaDevice();
  ~CudaDevice();
  CudaDevice(const CudaDevice&) = delete;
  CudaDevice& operator=(const CudaDevice&) = delete;

  /// Returns the calls of the driver.
  const CudaDriver& driver() const { return driver_; }
  /// Returns the device's name.
  const std::string& name() const { return name_; }
  /// Throws DeviceFailure unless `result` is that of a call that is done.
  void check(CudaDriver::Result result, const char* call) const;

 private:
  struct Close {
    void operator()(void* library) const;
  };
  std::unique_ptr<void, Close> library_;
  CudaDriver driver_{};
  std::string name_;
  int device_ = 0;
};

}  // namespace tress::simulation
