#include "integrators/stage/secant_updates.h"

#include <algorithm>
#include <cmath>

#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

// Newton's iteration rarely takes more steps before its matrix is built anew.
constexpr std::size_t most_updates = 12;

// Steps that shrink by less than half are no ground for an update [Deuflhard 2011,
// section 2.1.4].
constexpr double most_along = 0.5;

}  // namespace

SecantUpdates::SecantUpdates(In typical)
    : typical_(typical),
      updates_(most_updates, {std::vector<double>(typical.size()),
                              std::vector<double>(typical.size())}),
      last_(typical.size()) {}

void SecantUpdates::forget() noexcept {
  count_ = 0;
  follows_ = false;
}

double SecantUpdates::product(In x, In y) const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += x[i] * y[i] / (typical_[i] * typical_[i]);
  }
  return sum;
}

void SecantUpdates::improve(InOut step) noexcept {
  for (std::size_t k = 0; k < count_; ++k) {
    add(step, product(updates_[k].before, step), updates_[k].step);
  }
  const double square = product(last_, last_);
  const double along = follows_ && square > 0 ? product(step, last_) / square : 0;
  if (along != 0 && std::abs(along) < most_along) {
    for (double& entry : step) entry /= 1 - along;
    if (count_ < most_updates) {
      Update& update = updates_[count_++];
      std::ranges::copy(step, update.step.begin());
      for (std::size_t i = 0; i < last_.size(); ++i) update.before[i] = last_[i] / square;
    }
  }
  std::ranges::copy(step, last_.begin());
  follows_ = true;
}

}  // namespace tress::integrators
