#include "integrators/stage/lengthened.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tress::integrators {
namespace {

// The initial part of a step, and the limits below which lengthening it fails.
constexpr double first_part = 0.1, shortest_part = 1e-3, least_growth = 1.05;

}  // namespace

Status Lengthened::lengthen(Drift drift, Unknowns& x) noexcept {
  std::ranges::fill(x.a, 0.0);
  double before = 0, part = 0, growth = first_part;
  while (part < 1) {
    const double next = std::min(1.0, part == 0 ? growth : part * growth);
    solved_ = x;
    if (drift == Drift::whole) {
      for (double& entry : x.a) entry *= (part / next) * (part / next);  // same position
    } else {
      const double further = before > 0 ? (next - part) / (part - before) : 0;
      for (std::size_t i = 0; i < x.a.size(); ++i) {
        const double gained = part * x.a[i];
        x.a[i] = (gained + further * (gained - before * before_.a[i])) / next;
      }
    }
    equations_.take_part(next, drift);
    const Status s = damped_.solve(x);
    if (s == Status::fatal) return s;
    if (s == Status::ok) {
      growth = part == 0 ? 2 : std::min(2.0, growth * growth);
      before = part;
      part = next;
      std::swap(before_, solved_);
      continue;
    }
    x = solved_;
    growth = part == 0 ? growth / 4 : std::sqrt(growth);
    if (part == 0 && growth < shortest_part) return Status::retry;
    if (part > 0 && growth < least_growth) {
      return drift == Drift::own ? continuation_.solve(part, x) : Status::retry;
    }
  }
  return Status::ok;
}

}  // namespace tress::integrators
