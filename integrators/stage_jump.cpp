#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "integrators/stage.h"
#include "linear/vector_ops.h"

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

double Stage::scaled_dot(In x, In y) const noexcept {
  const In typ = dynamics_.q_typ();
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i] / (typ[i] * typ[i]);
  return sum;
}

Status Stage::correction(double t, In q_bar, In v_bar, Weights w, Side& side) noexcept {
  place(q_bar, v_bar, w, side.a);
  return newton_step(t, w, side.a, side.lambda, side.a_step, side.lambda_step, side.size);
}

/// Squared distance between the end points of the two steps.
double Stage::apart(const Side& x, const Side& y) const noexcept {
  const In typ = dynamics_.q_typ();
  double sum = 0;
  for (std::size_t i = 0; i < typ.size(); ++i) {
    const double d = (x.a[i] - x.a_step[i] - y.a[i] + y.a_step[i]) / typ[i];
    sum += d * d;
  }
  return sum;
}

/// Bisects between here_ and there_ until they are adjacent. A point between them is on
/// the side whose step leads to about the same point.
Status Stage::close_in(double t, In q_bar, In v_bar, Weights w) noexcept {
  shifted(a_step_, here_.a, -1, there_.a);
  const double largest = most_growth * std::max(here_.size, there_.size);
  double length = size_of(a_step_, w);
  if (length > 2 * largest) return Status::retry;
  for (; length > rules_.tolerance; length /= 2) {
    for (std::size_t i = 0; i < middle_.a.size(); ++i) {
      middle_.a[i] = (here_.a[i] + there_.a[i]) / 2;
    }
    for (std::size_t k = 0; k < middle_.lambda.size(); ++k) {
      middle_.lambda[k] = (here_.lambda[k] + there_.lambda[k]) / 2;
    }
    const Status s = correction(t, q_bar, v_bar, w, middle_);
    if (s != Status::ok) return s;
    if (middle_.size > largest) return Status::retry;
    std::swap(apart(middle_, here_) < apart(middle_, there_) ? here_ : there_, middle_);
  }
  return Status::ok;
}

Status Stage::on_jump(double t, In q_bar, In v_bar, Weights w, InOut a,
                      InOut lambda) noexcept {
  if (!(std::abs(rate_ - 1) <= back_again)) return Status::retry;
  const auto taken = [](const Side& from, Side& to) {
    shifted(to.a, from.a, -1, from.a_step);
    shifted(to.lambda, from.lambda, -1, from.lambda_step);
  };
  std::ranges::copy(a, here_.a.begin());
  std::ranges::copy(lambda, here_.lambda.begin());
  Status s = correction(t, q_bar, v_bar, w, here_);
  if (s != Status::ok) return s;
  taken(here_, there_);
  s = correction(t, q_bar, v_bar, w, there_);
  if (s != Status::ok) return s;
  std::vector<double>& mean = a_kept_;
  shifted(mean, here_.a_step, 1, there_.a_step);
  if (size_of(mean, w) > back_again * here_.size) return Status::retry;

  double previous = std::numeric_limits<double>::max();
  for (;;) {
    s = close_in(t, q_bar, v_bar, w);
    if (s != Status::ok) return s;
    // The smallest mean of the two corrections.
    shifted(mean, here_.a_step, -1, there_.a_step);
    const double share =
        std::clamp(scaled_dot(here_.a_step, mean) / scaled_dot(mean, mean), 0.0, 1.0);
    shifted(mean, here_.a_step, -share, mean);
    const double size = size_of(mean, w);
    if (size <= rules_.tolerance) {
      shifted(a, here_.a, -1, mean);
      for (std::size_t k = 0; k < lambda.size(); ++k) {
        lambda[k] = here_.lambda[k] - (1 - share) * here_.lambda_step[k] -
                    share * there_.lambda_step[k];
      }
      place(q_bar, v_bar, w, a);
      return Status::ok;
    }
    if (!(size <= slowest * previous)) return Status::retry;
    previous = size;
    taken(here_, middle_);
    taken(there_, here_);
    std::swap(there_, middle_);
    s = correction(t, q_bar, v_bar, w, here_);
    if (s == Status::ok) s = correction(t, q_bar, v_bar, w, there_);
    if (s != Status::ok) return s;
  }
}

}  // namespace tress::integrators
