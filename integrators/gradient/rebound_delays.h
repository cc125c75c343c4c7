#pragma once

#include <string>
#include <vector>

#include "integrators/gradient/contact_derivative.h"

namespace tress::integrators {

/// Times of rebounds. At a rebound, neither the derivative of the step nor a difference
/// of runs is the derivative of the motion. States before and after belong together at
/// the time of the impact, which depends on the parameters. A delay dt of the impact
/// moves the state before it by (v-, a-) dt, and that after it by -(v+, a+) dt: the
/// saltation matrix [Aizerman and Gantmakher 1958].
class ReboundDelays {
 public:
  /// `contacts` must outlive it.
  explicit ReboundDelays(ContactDerivative& contacts) : contacts_(contacts) {}

  /// To be called before a run.
  void begin() { before_.clear(); }
  /// Computes the delay of the rebound in a step by each parameter, from the columns dq0
  /// at the step's start: minus the change of the gap over its rate. False: failure()
  /// tells why there is none.
  bool find(const WatchedSystem::Motion& end, In dq0);
  /// Returns the delays, s; empty: nothing rebounds, or what does was in contact in the
  /// step before, too.
  const std::vector<double>& delays() const { return delays_; }
  /// Returns why the last find() found none.
  const std::string& failure() const { return failure_; }

 private:
  std::vector<std::size_t> new_rebounds() const;
  const WatchedSystem::Motion& before_impact(const WatchedSystem::Motion& end);
  bool rebounds_still() const;
  bool refuse(std::string why);

  ContactDerivative& contacts_;
  std::vector<ContactDerivative::Case> before_;
  WatchedSystem::Motion start_;
  std::vector<double> delays_;
  std::string failure_;
};

}  // namespace tress::integrators
