#include "experiments/head_accuracy/search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tress::experiments::head_accuracy {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
/// Elements by which interpolation is judged beforehand.
constexpr int usual_elements = 8;
/// The parts of an error that are independent add by their squares; runs that are
/// expected this much beyond a target are not tried.
constexpr double slack = 1.25;

std::size_t tenth_more(std::size_t guides) { return guides + (guides + 9) / 10; }
std::size_t tenth_fewer(std::size_t guides) { return guides - (guides + 9) / 10; }

}  // namespace

double value(const Spread& spread, Over over) {
  return over == Over::mean  ? spread.mean
         : over == Over::p95 ? spread.p95
                             : spread.largest;
}

double frame_work(const Choice& choice, const HeadMeasure& measure) {
  const auto simulated = static_cast<double>(choice.guides),
             others = static_cast<double>(measure.hairs() - choice.guides);
  const double step = measure.element_work(choice.elements) * choice.elements;
  return simulated * step * choice.substeps * (choice.bits == 32 ? 0.5 : 1) +
         point_work * others * (choice.elements + 1);
}

HeadSearch::HeadSearch(const HeadMeasure& measure, SearchPlan plan, Over over,
                       std::function<bool()> done)
    : measure_(measure), plan_(std::move(plan)), over_(over), done_(std::move(done)) {
  for (std::size_t g = measure.hairs() / 2; g > 0; g /= 2) guides_.push_back(g);
}

const HeadTrial* HeadSearch::run(const Choice& choice) {
  const auto [found, is_new] = runs_.try_emplace(choice);
  if (is_new) found->second = measure_.trial(choice);
  return found->second ? &*found->second : nullptr;
}

const Spread& HeadSearch::interpolation(std::size_t guides) {
  const auto [found, is_new] = interpolation_.try_emplace(guides);
  if (is_new) found->second = measure_.interpolation(guides, usual_elements);
  return found->second;
}

std::pair<std::size_t, Spread> HeadSearch::best_interpolation() {
  std::pair<std::size_t, Spread> best{0, {never, never, never}};
  for (const std::size_t g : guides_) {
    const Spread& of = interpolation(g);
    if (value(of, over_) < value(best.second, over_)) best = {g, of};
  }
  return best;
}

std::vector<HeadSearch::Candidate> HeadSearch::candidates() {
  std::vector<Candidate> all;
  const std::size_t sample = std::min(plan_.sample, measure_.hairs());
  for (const int n : plan_.elements) {
    for (const int s : plan_.substeps) {
      const auto [part, is_new] = simulated_.try_emplace({n, s});
      if (is_new) {
        part->second = value(measure_.simulated(sample, n, s, plan_.bits), over_);
      }
      const auto add = [&, own = part->second](std::size_t g, double between) {
        const Choice choice{g, n, s, plan_.bits};
        all.push_back({choice, frame_work(choice, measure_), std::hypot(between, own)});
      };
      for (const std::size_t g : guides_) add(g, value(interpolation(g), over_));
      add(measure_.hairs(), 0);
    }
  }
  std::ranges::stable_sort(all, {}, &Candidate::work);
  return all;
}

double HeadSearch::neighbours(const Choice& choice) {
  std::vector<Choice> all(2, choice);
  ++all[0].elements;
  all[1].substeps = (3 * choice.substeps + 1) / 2;
  if (choice.guides < measure_.hairs()) {
    all.push_back(choice);
    all.back().guides = std::min(measure_.hairs(), tenth_more(choice.guides));
    if (tenth_fewer(choice.guides) > 0) {
      all.push_back(choice);
      all.back().guides = tenth_fewer(choice.guides);
    }
  }
  double most = 0;
  for (const Choice& one : all) {
    const HeadTrial* trial = run(one);
    most = std::max(most, trial == nullptr ? never : error(*trial));
  }
  return most;
}

std::optional<Judged> HeadSearch::judged(const Choice& choice) {
  const HeadTrial* trial = run(choice);
  if (trial == nullptr) return {};
  const HeadTrial own = *trial;
  return Judged{own, error(own), neighbours(choice)};
}

bool HeadSearch::meets(const Choice& choice, double target) {
  const double gap = value(measure_.gap(), over_);
  const HeadTrial* trial = run(choice);
  return trial != nullptr && error(*trial) + gap <= target &&
         neighbours(choice) + gap <= neighbour_allowance * target;
}

Choice HeadSearch::lowered(Choice choice, double target) {
  // The ladder's own resolution is a factor of two.
  if (choice.guides < measure_.hairs()) {
    std::size_t low = choice.guides / 2;
    while (low > 0 && tenth_more(low) < choice.guides && !done_()) {
      Choice middle = choice;
      middle.guides = (low + choice.guides) / 2;
      if (meets(middle, target)) {
        choice = middle;
      } else {
        low = middle.guides;
      }
    }
  }
  for (int Choice::*part : {&Choice::elements, &Choice::substeps}) {
    for (Choice less = choice; --(less.*part) > 0 && !done_() && meets(less, target);) {
      choice = less;
    }
  }
  return choice;
}

std::optional<Judged> HeadSearch::cheapest(double target) {
  std::size_t tried = 0;
  for (const Candidate& candidate : candidates()) {
    if (candidate.expected > slack * target) continue;
    if (++tried > plan_.runs || done_()) return {};
    if (meets(candidate.choice, target)) return judged(lowered(candidate.choice, target));
  }
  return {};
}

std::optional<Judged> HeadSearch::best_within(double frame_s) {
  constexpr int most_runs = 12, enough = 3;
  const auto seconds = [](const HeadTrial& trial) {
    return trial.step_s + trial.follow_s;
  };
  std::vector<Candidate> all = candidates();
  std::ranges::stable_sort(all, {}, &Candidate::expected);
  // What a unit of work takes: of the runs so far, the least.
  double unit_s = never;
  for (const auto& [choice, trial] : runs_) {
    if (!trial) continue;
    unit_s = std::min(unit_s, seconds(*trial) / frame_work(choice, measure_));
  }
  std::optional<Judged> best;
  int tried = 0, within = 0;
  for (const Candidate& candidate : all) {
    if (unit_s < never && candidate.work * unit_s > frame_s) continue;
    if (++tried > most_runs || within == enough || done_()) break;
    const HeadTrial* trial = run(candidate.choice);
    if (trial == nullptr || seconds(*trial) > frame_s) continue;
    const auto one = judged(candidate.choice);
    if (one->neighbours > neighbour_allowance * one->error) continue;
    ++within;
    if (!best || one->error < best->error) best = one;
  }
  return best;
}

std::optional<Judged> HeadSearch::most_accurate() {
  std::optional<Choice> best;
  double least = never;
  for (const auto& [choice, trial] : runs_) {
    if (!trial || error(*trial) >= least) continue;
    least = error(*trial);
    best = choice;
  }
  if (!best) return {};
  return judged(*best);
}

}  // namespace tress::experiments::head_accuracy
