#include "simulation/device/cuda_driver.h"

#include <dlfcn.h>

namespace tress::simulation {

void CudaDevice::Close::operator()(void* library) const { ::dlclose(library); }

CudaDevice::CudaDevice() : library_(::dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL)) {
  if (!library_) {
    throw DeviceFailure(std::string("no driver of NVIDIA: ") + ::dlerror());
  }
  const auto find = [&](auto& function, const char* name) {
    void* const found = ::dlsym(library_.get(), name);
    if (found == nullptr) {
      throw DeviceFailure(std::string("libcuda.so.1 has no ") + name);
    }
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(found);
  };
#define TRESS_FIND(name) find(driver_.name, #name)
  TRESS_FIND(cuInit);
  TRESS_FIND(cuGetErrorName);
  TRESS_FIND(cuDeviceGetCount);
  TRESS_FIND(cuDeviceGet);
  TRESS_FIND(cuDeviceGetName);
  TRESS_FIND(cuDevicePrimaryCtxRetain);
  TRESS_FIND(cuDevicePrimaryCtxRelease_v2);
  TRESS_FIND(cuCtxSetCurrent);
  TRESS_FIND(cuModuleLoadData);
  TRESS_FIND(cuModuleUnload);
  TRESS_FIND(cuModuleGetFunction);
  TRESS_FIND(cuMemAlloc_v2);
  TRESS_FIND(cuMemFree_v2);
  TRESS_FIND(cuMemHostAlloc);
  TRESS_FIND(cuMemFreeHost);
  TRESS_FIND(cuMemcpyHtoDAsync_v2);
  TRESS_FIND(cuMemcpyDtoHAsync_v2);
  TRESS_FIND(cuStreamCreate);
  TRESS_FIND(cuStreamDestroy_v2);
  TRESS_FIND(cuStreamSynchronize);
  TRESS_FIND(cuStreamWaitEvent);
  TRESS_FIND(cuEventCreate);
  TRESS_FIND(cuEventDestroy_v2);
  TRESS_FIND(cuEventRecord);
  TRESS_FIND(cuLaunchKernel);
#undef TRESS_FIND
  check(driver_.cuInit(0), "cuInit");
  int devices = 0;
  check(driver_.cuDeviceGetCount(&devices), "cuDeviceGetCount");
  if (devices == 0) throw DeviceFailure("the driver has no device");
  check(driver_.cuDeviceGet(&device_, 0), "cuDeviceGet");
  char name[256] = "";
  check(driver_.cuDeviceGetName(name, sizeof name, device_), "cuDeviceGetName");
  name_ = name;
  CudaDriver::Handle context = nullptr;
  check(driver_.cuDevicePrimaryCtxRetain(&context, device_), "cuDevicePrimaryCtxRetain");
  if (const auto result = driver_.cuCtxSetCurrent(context); result != 0) {
    driver_.cuDevicePrimaryCtxRelease_v2(device_);
    check(result, "cuCtxSetCurrent");
  }
}

CudaDevice::~CudaDevice() { driver_.cuDevicePrimaryCtxRelease_v2(device_); }

void CudaDevice::check(CudaDriver::Result result, const char* call) const {
  if (result == 0) return;
  const char* name = nullptr;
  if (driver_.cuGetErrorName(result, &name) != 0 || name == nullptr) name = "no name";
  throw DeviceFailure(std::string(call) + " failed: " + name + " (" +
                      std::to_string(result) + ")");
}

}  // namespace tress::simulation
