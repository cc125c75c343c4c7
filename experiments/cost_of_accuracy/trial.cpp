#include "experiments/cost_of_accuracy/trial.h"

#include <fmt/format.h>

#include <algorithm>

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Of two runs on the front the cheaper represents both if the other reduces the error
/// less.
constexpr double front_gain = 0.9;

}  // namespace

std::string name(Neighbour neighbour, const RunKind& kind) {
  const char* const control = kind.by_tolerance ? "tolerance" : "dt";
  const char* const data = kind.held ? "moduli" : "moduli and lengths";
  const auto more = [](int elements) {
    return fmt::format("{} element{} more", elements, elements == 1 ? "" : "s");
  };
  switch (neighbour) {
    case Neighbour::one_more_element:
      return more(kind.element_unit);
    case Neighbour::two_more:
      return more(2 * kind.element_unit);
    case Neighbour::shorter_steps:
      return fmt::format("{} x {}", control, shorter);
    case Neighbour::longer_steps:
      return fmt::format("{} x {}", control, longer);
    case Neighbour::data_up:
      return fmt::format("{} + 2 %", data);
    case Neighbour::data_down:
      break;
  }
  return fmt::format("{} - 2 %", data);
}

double Trial::judged() const { return std::max(error, neighbours / neighbour_allowance); }

const Trial* cheapest(const std::vector<Trial>& runs, double target,
                      const std::function<bool(const Trial&)>& accept) {
  const Trial* best = nullptr;
  for (const Trial& run : runs) {
    if (run.judged() > target || (accept && !accept(run))) continue;
    if (best == nullptr || run.wall_s < best->wall_s) best = &run;
  }
  return best;
}

const Trial* most_accurate(const std::vector<Trial>& runs, double wall_s, double floor) {
  const Trial* best = nullptr;
  for (const Trial& run : runs) {
    if (run.wall_s > wall_s) continue;
    const double error = std::max(run.judged(), floor);
    const double least = best == nullptr ? never : std::max(best->judged(), floor);
    if (best == nullptr || error < least ||
        (error == least && run.wall_s < best->wall_s)) {
      best = &run;
    }
  }
  return best;
}

std::vector<Trial> pareto_front(std::vector<Trial> runs, double floor) {
  std::ranges::sort(runs, {}, &Trial::wall_s);
  std::vector<Trial> front;
  double least = never;
  for (const Trial& run : runs) {
    const double error = std::max(run.judged(), floor);
    if (!(error < front_gain * least)) continue;
    least = error;
    front.push_back(run);
  }
  std::ranges::reverse(front);
  return front;
}

}  // namespace tress::experiments::cost_of_accuracy
