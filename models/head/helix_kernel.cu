// Device code of heads of super-helices, for clang's CUDA mode alone: neither CUDA's
// headers nor its libraries are needed. The sources of the kernel are those of the host,
// whose functions the pragma below makes callable on both.
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))

// The standard library's own functions stay the host's; those used here are constexpr.
#include <cstdlib>
//
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#pragma clang force_cuda_host_device begin
#include "math/lane_math.h"
#include "models/head/helix_launch.h"
#include "models/head/long_windings.h"

namespace tress::helix {

/// With the sine and cosine of kernels instead of the C library's.
HelixFunctions<double> closed_forms(double s, double x2) noexcept {
  const double half = 0.5 * __builtin_sqrt(x2) * s;
  const SineCosine<PackOf<double, 1>> of = sine_cosine(PackOf<double, 1>(half));
  return closed_forms(s, x2, half, of.sine[0], of.cosine[0]);
}

}  // namespace tress::helix
#pragma clang force_cuda_host_device end

namespace {

using namespace tress;

__device__ long thread() {
  return static_cast<long>(__nvvm_read_ptx_sreg_ctaid_x()) *
             __nvvm_read_ptx_sreg_ntid_x() +
         __nvvm_read_ptx_sreg_tid_x();
}

template <int capacity, class T>
__device__ void steps(const models::HelixLaunch<T>& launch) {
  const long s = thread();
  if (s < launch.strands) models::helix_steps<capacity>(launch, s);
}

using Long = PackOf<double, 1>;
using Short = PackOf<float, 1>;

}  // namespace

// 255 registers a thread at most, the limit of a device: so many threads at least fit.
#define TRESS_THREADS __attribute__((launch_bounds(64)))

extern "C" {
__global__ TRESS_THREADS void helix_64_few(models::HelixLaunch<Long> launch) {
  steps<models::few_elements>(launch);
}
__global__ TRESS_THREADS void helix_64_most(models::HelixLaunch<Long> launch) {
  steps<models::most_elements>(launch);
}
__global__ TRESS_THREADS void helix_32_few(models::HelixLaunch<Short> launch) {
  steps<models::few_elements>(launch);
}
__global__ TRESS_THREADS void helix_32_most(models::HelixLaunch<Short> launch) {
  steps<models::most_elements>(launch);
}
}
