// Stands in for libcuda.so.1 where there is no device: kernels are the same functions
// compiled for the host (models/head/helix_launch.h), a thread after the other. As of a
// device nothing is done before somebody waits for it, so a missing wait is seen; what a
// program has not given back when it leaves ends it. TRESS_FAKE_CUDA says what fails:
// no_device, no_memory, bad_image, or launch=<number of the launch>,
// launch=next.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <functional>
#include <string>

#include "models/head/helix_launch.h"
#include "models/head/long_windings.h"

namespace {

using tress::PackOf;
using tress::models::HelixLaunch;

enum Result {
  done = 0,
  no_memory = 2,
  no_device = 100,
  bad_image = 218,
  no_name = 500,
  launch_failed = 719
};

bool fails(const std::string& what) {
  const char* const mode = std::getenv("TRESS_FAKE_CUDA");
  return mode != nullptr && what == mode;
}

/// Of a stream: what was asked for and not done yet.
struct Stream {
  std::deque<std::function<void()>> waiting;
  std::size_t finished = 0;

  std::size_t end() const { return finished + waiting.size(); }
  void run(std::size_t until) {
    while (finished < until) {
      const std::function<void()> next = std::move(waiting.front());
      waiting.pop_front();
      ++finished;
      next();
    }
  }
};
struct Event {
  Stream* stream = nullptr;
  std::size_t until = 0;
};
struct Module {
  std::string ptx;
};

int owned = 0, launches = 0;
/// What the next call returns; memory and handles are counted.
template <class T>
T* own(T* made) {
  ++owned;
  return made;
}
template <class T>
int give_back(T* it) {
  --owned;
  delete it;
  return done;
}

template <int capacity, class T>
void launch(const void* argument, Stream* stream, long threads) {
  HelixLaunch<T> all = *static_cast<const HelixLaunch<T>*>(argument);
  stream->waiting.push_back([all, threads] {
    for (long s = 0; s < threads; ++s) {
      if (s < all.strands) tress::models::helix_steps<capacity>(all, s);
    }
  });
}

struct Kernel {
  const char* name;
  void (*launch)(const void*, Stream*, long);
};
using tress::models::few_elements;
using tress::models::most_elements;
constexpr Kernel kernels[] = {{"helix_64_few", launch<few_elements, PackOf<double, 1>>},
                              {"helix_64_most", launch<most_elements, PackOf<double, 1>>},
                              {"helix_32_few", launch<few_elements, PackOf<float, 1>>},
                              {"helix_32_most", launch<most_elements, PackOf<float, 1>>}};

}  // namespace

extern "C" {

int cuInit(unsigned) { return done; }
int cuGetErrorName(int result, const char** name) {
  *name = result == no_memory       ? "CUDA_ERROR_OUT_OF_MEMORY"
          : result == no_device     ? "CUDA_ERROR_NO_DEVICE"
          : result == bad_image     ? "CUDA_ERROR_INVALID_PTX"
          : result == launch_failed ? "CUDA_ERROR_LAUNCH_FAILED"
                                    : "CUDA_ERROR_NOT_FOUND";
  return done;
}
int cuDeviceGetCount(int* count) {
  *count = fails("no_device") ? 0 : 1;
  return done;
}
int cuDeviceGet(int* device, int) {
  *device = 0;
  return done;
}
int cuDeviceGetName(char* name, int length, int) {
  std::snprintf(name, static_cast<std::size_t>(length), "no device (host twin)");
  return done;
}
int cuDevicePrimaryCtxRetain(void** context, int) {
  *context = &owned;
  return done;
}
int cuDevicePrimaryCtxRelease_v2(int) {
  if (owned == 0) return done;
  std::fprintf(stderr, "fake libcuda: %d things were not given back\n", owned);
  std::abort();
}
int cuCtxSetCurrent(void*) { return done; }

int cuModuleLoadData(void** module, const void* image) {
  if (fails("bad_image")) return bad_image;
  *module = own(new Module{static_cast<const char*>(image)});
  return done;
}
int cuModuleUnload(void* module) { return give_back(static_cast<Module*>(module)); }
int cuModuleGetFunction(const void** function, void* module, const char* name) {
  const std::string& ptx = static_cast<Module*>(module)->ptx;
  if (ptx.find(std::string(".visible .entry ") + name + "(") == std::string::npos) {
    return no_name;
  }
  for (const Kernel& kernel : kernels) {
    if (std::strcmp(kernel.name, name) != 0) continue;
    *function = &kernel;
    return done;
  }
  return no_name;
}

int cuMemAlloc_v2(unsigned long long* at, std::size_t bytes) {
  if (fails("no_memory")) return no_memory;
  void* const made = own(std::malloc(bytes));
  std::memset(made, 0x7f, bytes);  // whoever reads before he writes has strange numbers
  *at = reinterpret_cast<unsigned long long>(made);
  return done;
}
int cuMemFreeHost(void* at) {
  --owned;
  std::free(at);
  return done;
}
int cuMemFree_v2(unsigned long long at) {
  return cuMemFreeHost(reinterpret_cast<void*>(at));
}
int cuMemHostAlloc(void** at, std::size_t bytes, unsigned) {
  *at = own(std::malloc(bytes));
  return done;
}
int cuMemcpyHtoDAsync_v2(unsigned long long to, const void* from, std::size_t bytes,
                         void* stream) {
  static_cast<Stream*>(stream)->waiting.push_back(
      [=] { std::memcpy(reinterpret_cast<void*>(to), from, bytes); });
  return done;
}
int cuMemcpyDtoHAsync_v2(void* to, unsigned long long from, std::size_t bytes,
                         void* stream) {
  static_cast<Stream*>(stream)->waiting.push_back(
      [=] { std::memcpy(to, reinterpret_cast<const void*>(from), bytes); });
  return done;
}

int cuStreamCreate(void** stream, unsigned) {
  *stream = own(new Stream);
  return done;
}
int cuStreamDestroy_v2(void* stream) {
  auto* const ends = static_cast<Stream*>(stream);
  ends->run(ends->end());
  return give_back(ends);
}
int cuStreamSynchronize(void* stream) {
  auto* const all = static_cast<Stream*>(stream);
  all->run(all->end());
  return done;
}
int cuStreamWaitEvent(void* stream, void* event, unsigned) {
  static_cast<Stream*>(stream)->waiting.push_back(
      [of = *static_cast<Event*>(event)] { of.stream->run(of.until); });
  return done;
}
int cuEventCreate(void** event, unsigned) {
  *event = own(new Event);
  return done;
}
int cuEventDestroy_v2(void* event) { return give_back(static_cast<Event*>(event)); }
int cuEventRecord(void* event, void* stream) {
  auto* const of = static_cast<Stream*>(stream);
  *static_cast<Event*>(event) = {of, of->end()};
  return done;
}

int cuLaunchKernel(const void* function, unsigned blocks, unsigned, unsigned,
                   unsigned threads, unsigned, unsigned, unsigned, void* stream,
                   void** arguments, void**) {
  ++launches;
  if (fails("launch=" + std::to_string(launches)) || fails("launch=next")) {
    return launch_failed;
  }
  static_cast<const Kernel*>(function)->launch(arguments[0], static_cast<Stream*>(stream),
                                               static_cast<long>(blocks) * threads);
  return done;
}
}  // extern "C"
