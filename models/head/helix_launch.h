#pragma once

#include "models/head/head_motion.h"
#include "models/head/helix_strand.h"

/// Steps of many super-helices as a device takes them, a strand a thread: what
/// a head of super-helices does under gravity and linear drag, by the same HelixStrand.
/// This header is compiled for the host and for the device (helix_kernel.cu).
namespace tress::models {

/// Data of a strand that steps do not change, before the rest shape of its elements.
template <class T>
struct HelixFixed {
  ReducedMaterial<T> material;  // material of the elements
  LaneRoot<T> root;             // root of the strand

  static constexpr int numbers = 20;  // count of numbers before the rest shape
};
/// Numbers of a strand.
constexpr int helix_fixed(int elements) { return 20 + 3 * elements; }
/// Returns the count of numbers of a strand's state.
constexpr int helix_state(int elements) { return 6 * elements; }

/// A step from t to t + h.
struct HelixStep {
  HeadMotion motion;  // of the head at t + h
  double h;           // in the head's unit of time
};

/// One launch. Entry k of strand s of an array lies at [k strands + s], so that threads
/// side by side read numbers side by side. T = PackOf<double, 1> or PackOf<float, 1>.
template <class T>
struct HelixLaunch {
  HelixStrand<T> kernel;    // kernel of the steps
  long strands;             // number of strands
  int steps;                // steps of this launch
  int before;               // steps of earlier launches
  const HelixStep* motion;  // (steps)
  const T* fixed;           // (helix_fixed, strands)
  T* state;                 // (helix_state, strands)
  int* lost;  // (strands) 0, or the number of the step that lost it, from 1; < 0: earlier
};
// What the host's and the device's compiler make of it is the same.
static_assert(sizeof(HelixLaunch<PackOf<double, 1>>) == 320);
static_assert(sizeof(HelixLaunch<PackOf<float, 1>>) == 320);

/// Bounds of the elements of the two device kernels, whose memory is fixed.
inline constexpr int few_elements = 16, most_elements = 64;

/// All steps of strand s. A strand whose result is not finite stays as it was before the
/// step, at rest. `capacity` >= elements.
template <int capacity, class T>
void helix_steps(const HelixLaunch<T>& launch, long s) {
  if (launch.lost[s] != 0) return;
  const int n = launch.kernel.elements();
  const auto at = [&](auto* of, int entry) -> auto& {
    return of[entry * launch.strands + s];
  };
  HelixFixed<T> fixed;
  T* const numbers = &fixed.material.length;
  for (int k = 0; k < HelixFixed<T>::numbers; ++k) numbers[k] = at(launch.fixed, k);
  Vec3<T> rest[capacity], q[capacity], v[capacity], before[capacity];
  for (int i = 0; i < n; ++i) {
    const int k = HelixFixed<T>::numbers + 3 * i;
    rest[i] = {at(launch.fixed, k), at(launch.fixed, k + 1), at(launch.fixed, k + 2)};
    q[i] = {at(launch.state, 6 * i), at(launch.state, 6 * i + 1),
            at(launch.state, 6 * i + 2)};
    v[i] = {at(launch.state, 6 * i + 3), at(launch.state, 6 * i + 4),
            at(launch.state, 6 * i + 5)};
  }
  typename HelixStrand<T>::Scratch scratch[capacity];
  for (int step = 0; step < launch.steps; ++step) {
    const HelixStep& now = launch.motion[step];
    for (int i = 0; i < n; ++i) before[i] = q[i];
    const ReducedMotion<T> root = root_motion(fixed.root, now.motion);
    const auto end = launch.kernel.move(fixed.material, root, now.h, q, v, scratch);
    launch.kernel.linearly_implicit_step(fixed.material, end, nullptr, rest, now.h, q, v,
                                         scratch);
    T finite(0);  // 0 or NaN
    for (int i = 0; i < n; ++i) {
      const T all = q[i].x + q[i].y + q[i].z;
      finite += all - all;
    }
    if (all_up_to(finite, 0)) continue;
    for (int i = 0; i < n; ++i) {
      q[i] = before[i];
      v[i] = Vec3<T>{};
    }
    launch.lost[s] = launch.before + step + 1;
    break;
  }
  for (int i = 0; i < n; ++i) {
    const T all[] = {q[i].x, q[i].y, q[i].z, v[i].x, v[i].y, v[i].z};
    for (int k = 0; k < 6; ++k) at(launch.state, 6 * i + k) = all[k];
  }
}

}  // namespace tress::models
