#include "experiments/harness/sundials_speed.h"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include "experiments/harness/timing.h"

namespace tress {
namespace {

constexpr int entries = 1000;  // three vectors: 24 kB
constexpr int sums_per_timing = 500;
constexpr int timings = 9;

/// Not inlined and on plain pointers, as N_VLinearSum has it.
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
  const Timing theirs = time_it(timings, [&] {
    for (int i = 0; i < sums_per_timing; ++i) N_VLinearSum(2.0, x, 3.0, y, z);
  });
  const Timing ours = time_it(timings, [&] {
    for (int i = 0; i < sums_per_timing; ++i) {
      linear_sum(2.0, N_VGetArrayPointer(x), 3.0, N_VGetArrayPointer(y),
                 N_VGetArrayPointer(z));
    }
  });
  for (N_Vector v : {x, y, z}) N_VDestroy(v);
  return theirs.min_s / ours.min_s;
}

}  // namespace tress
