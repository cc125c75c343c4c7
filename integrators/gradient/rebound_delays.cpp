#include "integrators/gradient/rebound_delays.h"

#include <algorithm>
#include <cmath>

namespace tress::integrators {
namespace {

/// Delays of points that rebound at once differ by less, over the longest.
constexpr double at_once = 1e-6;

}  // namespace

std::vector<std::size_t> ReboundDelays::new_rebounds() const {
  using Case = ContactDerivative::Case;
  const std::vector<Case>& cases = contacts_.cases();
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const bool was_open =
        std::ranges::find(before_, cases[k].id, &Case::id) == before_.end();
    if (cases[k].rebounds && was_open) found.push_back(k);
  }
  return found;
}

bool ReboundDelays::refuse(std::string why) {
  failure_ = std::move(why);
  return false;
}

/// The start of the step, as if a step had ended there: one too short to reach the body.
/// The laws of contact are then about the gap.
const WatchedSystem::Motion& ReboundDelays::before_impact(
    const WatchedSystem::Motion& end) {
  constexpr double part = 1e-6;
  start_ = end;
  start_.t = end.t - end.contact.tau;
  start_.q = end.contact.q0;
  start_.v = end.contact.v0;
  start_.contact.tau *= part;
  return start_;
}

bool ReboundDelays::rebounds_still() const {
  return std::ranges::any_of(contacts_.cases(), &ContactDerivative::Case::rebounds);
}

bool ReboundDelays::find(const WatchedSystem::Motion& end, In dq0) {
  delays_.clear();
  failure_.clear();
  if (!contacts_.hold(end)) {
    return refuse(std::string(ContactDerivative::other_contacts));
  }
  const std::vector<std::size_t> rebounding = new_rebounds();
  before_ = contacts_.cases();
  if (rebounding.empty()) return true;
  if (rebounding.size() < before_.size()) {
    return refuse("a point rebounds while others are in contact");
  }
  const std::size_t n = end.q.size();
  const double t0 = end.t - end.contact.tau;
  const In q0 = end.contact.q0, v0 = end.contact.v0;
  if (!contacts_.hold(before_impact(end)) || rebounds_still()) {
    return refuse("a point rebounds from inside the body");
  }
  std::vector<double> rate(before_.size()), change(rate);
  contacts_.normal_rates(t0, q0, v0, rate);
  for (std::size_t k = 0; n * k < dq0.size(); ++k) {
    contacts_.normal_laws(k, t0, q0, dq0.subspan(k * n, n), change);
    for (std::size_t i = 0; i < change.size(); ++i) change[i] /= -rate[i];
    const auto [least, most] = std::ranges::minmax(change);
    if (!(most - least <= at_once * std::max(std::abs(least), std::abs(most)))) {
      return refuse("points rebound at several times in one step: give a shorter step");
    }
    delays_.push_back(least);
  }
  return true;
}

}  // namespace tress::integrators
