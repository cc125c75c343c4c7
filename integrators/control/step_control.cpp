#include "integrators/control/step_control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/control/step_factors.h"

namespace tress::integrators {
namespace {

using step_factors::safety;

// A step within these factors of the one wanted is left alone.
constexpr double dead_from = 0.95, dead_to = 1.2;

}  // namespace

void StepControl::start(double h, double least) {
  h_ = std::max(h, least);
  least_ = least;
  ceiling_ = std::numeric_limits<double>::infinity();
  before_ = 1;
  rejected_ = false;
  cause_ = "start";
  shortest_ = {};
}

StepControl::Trial StepControl::next(double left, double longest) const {
  double h = std::min({h_, ceiling_, longest});
  // 1e-9: no sliver is left by rounding.
  if (h > (1 - 1e-9) * left) return {left, left < h_, true};
  if (2 * h > left) h = left / 2;  // nor by a step that ends shortly before
  return {h, h < h_, false};
}

void StepControl::accept(const Trial& taken, double error, double t) {
  if (!taken.cut && (shortest_.h == 0 || taken.h < shortest_.h)) {
    shortest_ = {taken.h, t, cause_};
  }
  // 1e-4: an estimate of 0 does not decide about the step after the next.
  const double now = std::max(error, 1e-4);
  double factor = safety * std::pow(now, -0.7 / k_) * std::pow(before_, 0.4 / k_);
  factor = std::clamp(factor, step_factors::least, rejected_ ? 1 : step_factors::most);
  if (factor >= dead_from && factor <= dead_to) factor = 1;
  // A step that was cut says nothing against the length that the control had chosen.
  const double wanted = factor * taken.h;
  if (wanted < taken.h) cause_ = "error";
  h_ = taken.cut ? std::max(h_, wanted) : wanted;
  h_ = std::max(h_, least_);  // unless that is rejected
  before_ = now;
  rejected_ = false;
  ceiling_ *= step_factors::ceiling_growth;
}

void StepControl::reject(const Trial& failed, double error) {
  const double factor = safety * std::pow(error, -1 / k_);
  shorten(std::clamp(factor, step_factors::least, safety) * failed.h, "error");
}

void StepControl::unsolved(const Trial& failed, std::string_view cause) {
  ceiling_ = step_factors::unsolved_ceiling * failed.h;
  shorten(step_factors::unsolved * failed.h, cause);
}

void StepControl::shorten(double h, std::string_view cause) {
  rejected_ = true;
  h_ = h;
  cause_ = cause;
}

}  // namespace tress::integrators
