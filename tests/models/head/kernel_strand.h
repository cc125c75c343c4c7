#pragma once

#include <cmath>
#include <vector>

#include "contract/system.h"
#include "math/pack.h"

/// A strand by itself, as the kernels of heads of edges see it and as the System does.
namespace tress::testing_support {

// Of no head: functions of theirs must not come from here, where optimisation is another.
using One = PackOf<double, 2>;

inline std::vector<One> packed(const std::vector<double>& x) {
  return {x.begin(), x.end()};
}
inline std::vector<double> plain(const std::vector<One>& x) {
  std::vector<double> all;
  all.reserve(x.size());
  for (const One& y : x) all.push_back(y[0]);
  return all;
}

/// A state that has nothing special: bent, twisted, stretched and moving.
struct BentState {
  std::vector<double> q, v, a;  // of the System
};
/// The first `nodes` coordinates are places (m), the others angles.
inline BentState bent_state(System& system, double seed, std::size_t nodes) {
  const auto size = static_cast<std::size_t>(system.layout().coordinates);
  BentState s{std::vector<double>(size), std::vector<double>(size),
              std::vector<double>(size)};
  system.initial_state(s.q, s.v);
  for (std::size_t i = 0; i < size; ++i) {
    const double x = std::sin(seed + 1.7 * static_cast<double>(i * i % 23));
    s.q[i] += (i < nodes ? 2e-3 : 0.4) * x;
    s.v[i] += (i < nodes ? 0.3 : 8.0) * std::cos(3 * x + 1);
    s.a[i] += (i < nodes ? 5.0 : 90.0) * std::sin(5 * x + 2);
  }
  return s;
}

}  // namespace tress::testing_support
