#include "integrators/stage/jump.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tress::integrators {
namespace {

// Newton's iteration alternates when two successive steps end this near to their start,
// relative to the length of one.
constexpr double back_again = 0.1;

// If corrections grow by more towards the point between the two sides, the cause is a
// singular matrix, not a jump.
constexpr double most_growth = 2;

// Means of the corrections of the two sides must shrink at least by this factor.
constexpr double slowest = 0.5;

}  // namespace

Status Jump::correct(Side& side) noexcept {
  equations_.place(side.x);
  return equations_.newton_correction(side.x, side.step, side.size);
}

/// Squared distance between the end points of the two steps.
double Jump::apart(const Side& one, const Side& other) const noexcept {
  const In typ = equations_.dynamics.q_typ();
  double sum = 0;
  for (std::size_t i = 0; i < typ.size(); ++i) {
    const double d =
        (one.x.a[i] - one.step.a[i] - other.x.a[i] + other.step.a[i]) / typ[i];
    sum += d * d;
  }
  return sum;
}

/// Bisects between here_ and there_ until they are adjacent. A point between them is on
/// the side whose step leads to about the same point.
Status Jump::close_in() noexcept {
  shifted(mean_.a, here_.x.a, -1, there_.x.a);
  const double largest = most_growth * std::max(here_.size, there_.size);
  double length = equations_.size_of(mean_);
  if (length > 2 * largest) return Status::retry;
  const auto halfway = [](double one, double other) { return (one + other) / 2; };
  for (; length > equations_.rules.tolerance; length /= 2) {
    std::ranges::transform(here_.x.a, there_.x.a, middle_.x.a.begin(), halfway);
    std::ranges::transform(here_.x.lambda, there_.x.lambda, middle_.x.lambda.begin(),
                           halfway);
    const Status s = correct(middle_);
    if (s != Status::ok) return s;
    if (middle_.size > largest) return Status::retry;
    std::swap(apart(middle_, here_) < apart(middle_, there_) ? here_ : there_, middle_);
  }
  return Status::ok;
}

Status Jump::solve(double rate, Unknowns& x) noexcept {
  if (!(std::abs(rate - 1) <= back_again)) return Status::retry;
  const auto take_step = [](const Side& from, Side& to) {
    to.x.become(from.x, -1, from.step);
  };
  here_.x = x;
  Status s = correct(here_);
  if (s != Status::ok) return s;
  take_step(here_, there_);
  s = correct(there_);
  if (s != Status::ok) return s;
  std::vector<double>& mean = mean_.a;
  shifted(mean, here_.step.a, 1, there_.step.a);
  if (equations_.size_of(mean_) > back_again * here_.size) return Status::retry;

  double previous = std::numeric_limits<double>::max();
  for (;;) {
    s = close_in();
    if (s != Status::ok) return s;
    // The smallest mean of the two corrections.
    shifted(mean, here_.step.a, -1, there_.step.a);
    const double share = std::clamp(
        equations_.dot(here_.step.a, mean) / equations_.dot(mean, mean), 0.0, 1.0);
    shifted(mean, here_.step.a, -share, mean);
    const double size = equations_.size_of(mean_);
    if (size <= equations_.rules.tolerance) {
      shifted(x.a, here_.x.a, -1, mean);
      for (std::size_t k = 0; k < x.lambda.size(); ++k) {
        x.lambda[k] = here_.x.lambda[k] - (1 - share) * here_.step.lambda[k] -
                      share * there_.step.lambda[k];
      }
      equations_.place(x);
      return Status::ok;
    }
    if (!(size <= slowest * previous)) return Status::retry;
    previous = size;
    take_step(here_, middle_);
    take_step(there_, here_);
    std::swap(there_, middle_);
    s = correct(here_);
    if (s == Status::ok) s = correct(there_);
    if (s != Status::ok) return s;
  }
}

}  // namespace tress::integrators
