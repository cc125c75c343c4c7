#include "simulation/fit/profile.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tress::simulation {
namespace {

constexpr int most_fits = 30;           // of one end
constexpr double farthest = 10;         // linear half intervals
constexpr double longest_stride = 3;    // over the distance before
constexpr double end_tolerance = 1e-3;  // of the root of the rise, over deviation

class Profile {
 public:
  Profile(FitSearch& search, const ProfileTask& task)
      : search_(search), task_(task), best_(search.place()), u_(search.u()[task.k]) {}

  /// The end above (side = 1) or below (-1).
  double end(double side) {
    const FitVariable& variable = search_.variables()[task_.k];
    double inner = 0, inner_excess = -1;
    std::optional<double> outer;
    double outer_excess = 0, distance = task_.half;
    search_.go_to(best_);
    for (int fits = 0; fits < most_fits; ++fits) {
      const double asked = u_ + side * distance, u = variable.within(asked);
      const double here = excess(u);
      const bool bounded = u != asked && here < 0;
      if (std::isnan(here) || bounded || std::abs(here) < end_tolerance) {
        return std::isnan(here) ? here : u;
      }
      (here < 0 ? inner : outer.emplace()) = distance;
      (here < 0 ? inner_excess : outer_excess) = here;
      if (outer) {
        const double part = inner_excess / (inner_excess - outer_excess);
        distance = inner + std::clamp(part, 0.05, 0.95) * (*outer - inner);
        continue;
      }
      if (inner >= farthest * task_.half) break;
      // The root of the rise grows about in proportion.
      const double stride = std::min(longest_stride, 1.1 / (1 + here));
      distance = std::min(farthest * task_.half, inner * stride);
    }
    return not_there;
  }

  void leave() { search_.go_to(best_); }

 private:
  /// Root of the rise over deviation, less 1. NaN: the search fails.
  double excess(double u) {
    FitSearch::Place from = search_.place();
    if (from.held[task_.k]) {
      from.held[task_.k] = u;
      search_.go_to(std::move(from));
    } else {
      search_.hold(task_.k, u);
    }
    if (!search_.run().empty()) return not_there;
    const auto found = search_.linear(RecordRuns::Finer::no);
    if (!found) return not_there;
    const double rise = std::max(0.0, found->r.squaredNorm() - task_.least);
    return std::sqrt(rise) / task_.deviation - 1;
  }

  FitSearch& search_;
  const ProfileTask& task_;
  FitSearch::Place best_;
  double u_;
};

}  // namespace

ProfileInterval profile_interval(FitSearch& search, const ProfileTask& task) {
  Profile profile(search, task);
  const double low = profile.end(-1), high = profile.end(1);
  profile.leave();
  return {low, high};
}

}  // namespace tress::simulation
