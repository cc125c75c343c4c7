#include "integrators/block/block_method.h"

#include "integrators/tr_bdf2.h"

namespace tress::integrators {
namespace {

using tr_bdf2_entries::d, tr_bdf2_entries::w, tr_bdf2_entries::table;

constexpr BlockStage backward_euler[] = {{}};
/// One correction from the line through the last two accelerations, as integrators/
/// linearly_implicit_midpoint.cpp.
constexpr BlockStage midpoint[] = {{.time = 0.5, .gamma = 0.5}};
/// The trapezoidal rule to t_n + 2 d h, then BDF2, as integrators/tr_bdf2.h:
///
///     v_1 = v_n + d h (a_0 + a_1),    v_2 = v_n + w h (a_0 + a_1) + d h a_2
///
/// and q by the same sums of velocities, in which 2 w + d = 1.
constexpr double both = 2 * w * d;  // by v_1, and by v_bar
constexpr BlockStage tr_bdf2[] = {
    {.time = 0, .gamma = 0},
    {.time = 2 * d, .gamma = d, .rate = {d, 0}, .drift = {d / 2, 0}},
    {.time = 1, .gamma = d, .rate = {w, w}, .drift = {both, both}}};
/// Off the comparison: velocities enter q by the accelerations that made them, in which
/// what cancels is left out.
constexpr double off(std::size_t k) { return table.a[2][k] - table.embedded[k]; }

}  // namespace

constexpr BlockEstimate tr_bdf2_estimate{
    .rate = {off(0), off(1), off(2)},
    .drift = {off(1) * d + off(2) * w, off(1) * d + off(2) * w, off(2) * d},
    .falls = table.embedded_order,
    .share = table.share,
    .power = table.power};

/// Of linearly_implicit_euler one correction of backward_euler's stage, from a = 0.
BlockMethod block_method(HeadMethod method) {
  switch (method) {
    case HeadMethod::linearly_implicit_euler:
      return {.stages = backward_euler, .iterates = false};
    case HeadMethod::linearly_implicit_midpoint:
      return {
          .stages = midpoint, .iterates = false, .first_steps = 2, .accelerations = 2};
    case HeadMethod::tr_bdf2:
      return {.stages = tr_bdf2,
              .iterates = true,
              .first_steps = 1,
              .accelerations = 2,
              .estimate = &tr_bdf2_estimate};
    case HeadMethod::backward_euler:
      break;
  }
  return {.stages = backward_euler, .iterates = true, .accelerations = 1};
}

}  // namespace tress::integrators
