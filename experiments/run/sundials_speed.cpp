#include "experiments/run/sundials_speed.h"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <algorithm>
#include <limits>

#include "simulation/run/timing.h"

namespace tress::experiments {
namespace {

constexpr int entries = 1000;  // three vectors: 24 kB
constexpr int sums_per_timing = 500;
constexpr int timings = 25;

/// Not inlined and on plain pointers, as in N_VLinearSum. This file is compiled for the
/// baseline instruction set (CMakeLists.txt), as SUNDIALS is: the ratio is to
/// distinguish optimisation levels, not vector widths.
[[gnu::noinline]] void linear_sum(double a, const double* x, double b, const double* y,
                                  double* z) {
  for (int i = 0; i < entries; ++i) z[i] = a * x[i] + b * y[i];
}

}  // namespace

double sundials_speed_ratio() {
  const sundials::Context context;
  N_Vector x = N_VNew_Serial(entries, context);
  N_Vector y = N_VClone(x);
  N_Vector z = N_VClone(x);
  N_VConst(1.5, x);
  N_VConst(0.5, y);
  double theirs = std::numeric_limits<double>::infinity(), ours = theirs;
  for (int i = 0; i < timings; ++i) {  // alternating, so that both see the same load
    const Timing library = time_it(1, [&] {
      for (int k = 0; k < sums_per_timing; ++k) N_VLinearSum(2.0, x, 3.0, y, z);
    });
    const Timing loop = time_it(1, [&] {
      for (int k = 0; k < sums_per_timing; ++k) {
        linear_sum(2.0, N_VGetArrayPointer(x), 3.0, N_VGetArrayPointer(y),
                   N_VGetArrayPointer(z));
      }
    });
    theirs = std::min(theirs, library.min_s);
    ours = std::min(ours, loop.min_s);
  }
  for (N_Vector v : {x, y, z}) N_VDestroy(v);
  return theirs / ours;
}

}  // namespace tress::experiments
