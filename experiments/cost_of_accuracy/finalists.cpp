#include "experiments/cost_of_accuracy/finalists.h"

#include <algorithm>
#include <limits>
#include <set>

#include "integrators/catalogue.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Number of the cheapest runs that are timed again before one of them wins.
constexpr std::size_t contenders = 5;

/// Times of two runs that are compared with each other are taken alternately so often.
constexpr int turns = 3;

/// A time whose repeats scatter more than most_scatter is taken again, so often at most.
constexpr int most_retimed = 3;

/// If no more methods than this are considered they are tried near the winner, with up to
/// `dearest` times its substeps.
constexpr std::ptrdiff_t few_methods = 6;
constexpr int dearest = 16;

}  // namespace

Finalists::Finalists(Search& search, const Scene& given, std::vector<Method>& methods,
                     Time time)
    : search_(search), given_(given), methods_(methods), time_(std::move(time)) {}

std::vector<Trial> Finalists::runs() const {
  std::vector<Trial> all = search_.runs();
  if (search_.cut()) {
    std::erase_if(all, [](const Trial& run) { return run.examined < neighbour_count; });
  }
  for (Trial& run : all) {
    const auto found = times_.find(place(run));
    if (found != times_.end()) run.wall_s = found->second.least_s;
  }
  return all;
}

bool Finalists::time(const Trial& run) {
  if (times_.contains(place(run))) return false;
  WallTime measured = time_(run);
  for (int i = 0; i < most_retimed && measured.scatter > most_scatter; ++i) {
    const WallTime again = time_(run);
    measured = {std::min(measured.least_s, again.least_s), again.scatter};
  }
  times_.emplace(place(run), measured);
  return true;
}

bool Finalists::tied(const Trial& run, const Trial& best) const {
  return run.wall_s <= tie(scatter(best)) * best.wall_s;
}

/// The same elements and substeps by methods with a subset of the options: one may do as
/// well.
void Finalists::time_simpler(const Trial& run) {
  const Method& method = methods_[run.method];
  for (std::size_t i = 0; i < methods_.size(); ++i) {
    const Method& other = methods_[i];
    if (other.model != method.model || other.integrator != method.integrator ||
        other.by_tolerance != method.by_tolerance ||
        other.extrapolated != method.extrapolated ||
        other.options.size() >= method.options.size()) {
      continue;
    }
    const bool part = std::ranges::all_of(other.options, [&method](const auto& one) {
      return std::ranges::count(method.options, one) > 0;
    });
    if (!part) continue;
    if (const Trial* found = search_.run(i, run.elements, run.substeps)) {
      static_cast<void>(time(*found));
    }
  }
}

/// The run after its neighbours were examined.
Trial Finalists::known(const Trial& run) {
  Trial now = *search_.run(run.method, run.elements, run.substeps);
  now.wall_s = run.wall_s;
  return now;
}

/// The cheapest that counts.
std::optional<Trial> Finalists::counting(double target, const Accept& accept) {
  while (true) {
    const std::vector<Trial> all = runs();
    const Trial* next = cheapest(all, target, accept);
    if (next == nullptr) return {};
    if (search_.holds(*next, target)) return known(*next);
  }
}

bool Finalists::simpler(const Trial& a, const Trial& b) const {
  const auto key = [this](const Trial& run) {
    const Method& method = methods_[run.method];
    return std::tuple(method.extrapolated, method.cut_at_rest, method.options.size(),
                      frame_work(method, run.elements, run.substeps), run.elements,
                      run.method);
  };
  return key(a) < key(b);
}

std::optional<Trial> Finalists::settled(double target, const Accept& accept) {
  std::set<Place> tried;
  for (std::size_t i = 0; i < contenders; ++i) {
    const auto next = counting(target, [&](const Trial& run) {
      return !tried.contains(place(run)) && (!accept || accept(run));
    });
    if (!next) break;
    static_cast<void>(time(*next));
    tried.insert(place(*next));
    if (i == 0) time_simpler(*next);
  }
  while (const auto best = counting(target, accept)) {
    if (time(*best)) continue;
    Trial simplest = *best;
    for (const Trial& run : runs()) {
      const bool meets = run.judged() <= target && (!accept || accept(run));
      if (meets && tied(run, *best) && simpler(run, simplest)) simplest = run;
    }
    if (time(simplest)) continue;
    if (search_.holds(simplest, target)) return known(simplest);
  }
  return {};
}

/// The search may have dropped the methods considered here: if they are few, one run that
/// meets the target is sought near the winner. The cheapest is then tuned like the
/// winner.
std::optional<Trial> Finalists::replaced(
    const Trial& winner, double target, const std::function<bool(const Method&)>& other) {
  const Accept accept = [&](const Trial& run) { return other(methods_[run.method]); };
  const bool few = std::ranges::count_if(methods_, other) <= few_methods;
  for (std::size_t method = 0; few && method < methods_.size(); ++method) {
    const auto own = [method](const Trial& run) { return run.method == method; };
    if (!other(methods_[method]) || cheapest(search_.runs(), target, own) != nullptr) {
      continue;
    }
    const int substeps =
        std::max(1, winner.substeps * search_.unit(method) / search_.unit(winner.method));
    for (const int elements : {winner.elements, winner.elements + winner.elements / 2}) {
      search_.fewest_that_hold(method, elements, target, substeps, dearest * substeps);
    }
  }
  const Trial* first = search_.robust(target, accept);
  if (first == nullptr) return {};
  search_.refine(first->method, target);
  return settled(target, accept);
}

/// Ensures that the methods with another option value exist; false if there are none.
bool Finalists::varied(const Method& method, std::string_view choice) {
  const std::vector<Method> others = with_other_words(given_, method, choice);
  for (const Method& other : others) {
    const bool known = std::ranges::any_of(
        methods_, [&other](const Method& one) { return same(one, other); });
    if (!known) methods_.push_back(other);
  }
  return !others.empty();
}

std::optional<Trial> Finalists::twice_the_elements(const Trial& winner, double target) {
  const Trial* found =
      search_.fewest_that_hold(winner.method, 2 * winner.elements, target,
                               winner.substeps, dearest * winner.substeps);
  if (found == nullptr) return {};
  return settled(target, [place_of = place(*found)](const Trial& run) {
    return place(run) == place_of;
  });
}

std::optional<Trial> Finalists::half_the_step(const Trial& winner, double target) {
  const int substeps = 2 * winner.substeps;
  const auto meets = [&](int elements) {
    const Trial* found = search_.run(winner.method, elements, substeps);
    return found != nullptr && search_.holds(*found, target);
  };
  int elements = winner.elements;
  // Spatial and temporal errors may have cancelled each other: more elements then.
  while (!meets(elements) && elements < 2 * winner.elements) {
    elements += std::max(1, elements / 10);
  }
  while (elements > 1 && meets(elements)) --elements;
  return settled(target, [&winner, substeps](const Trial& run) {
    return run.method == winner.method && run.substeps == substeps;
  });
}

std::optional<BestRuns> Finalists::of(double target, bool choices) {
  auto winner = settled(target, {});
  if (!winner) return {};
  for (std::size_t before = 0; before != search_.runs().size();) {
    before = search_.runs().size();
    search_.comb(*winner);
    winner = settled(target, {});
  }
  BestRuns best{*winner, {}, {}};
  if (choices) replace_choices(*winner, target, best);
  const Method& won = methods_[winner->method];
  best.runner_up = settled(target, [&](const Trial& run) {
    const Method& method = methods_[run.method];
    return method.model != won.model || method.integrator != won.integrator;
  });
  return best;
}

void Finalists::replace_choices(const Trial& winner, double target, BestRuns& best) {
  const Method won = methods_[winner.method];
  const auto model = [&](const Method& method) { return method.model == won.model; };
  const auto integrator = [&](const Method& method) {
    return method.integrator == won.integrator;
  };
  const auto same = [&](const Method& method, auto... choices) {
    return ((method.*choices == won.*choices) && ...);
  };
  const auto control = [&](const Method& method) {
    return same(method, &Method::by_tolerance, &Method::extrapolated, &Method::refresh,
                &Method::cut_at_rest);
  };
  const auto add = [&](std::string_view choice, const auto& other) {
    best.without.emplace_back(choice, replaced(winner, target, other));
  };
  add("model", [&](const Method& method) { return !model(method); });
  add("integrator",
      [&](const Method& method) { return model(method) && !integrator(method); });
  for (const std::string_view id : always_shown) {
    const auto own = [id](const Method& method) { return method.integrator == id; };
    if (id != won.integrator && std::ranges::any_of(methods_, own)) add(id, own);
  }
  for (const std::string_view choice : choices_of(*won.model)) {
    if (!varied(won, choice)) continue;
    add(choice, [&](const Method& method) {
      if (!model(method) || !integrator(method) || !control(method)) return false;
      return std::ranges::all_of(choices_of(*won.model), [&](std::string_view one) {
        return (method.word(one) == won.word(one)) != (one == choice);
      });
    });
  }
  // Another value of a choice, and the winner's of those to be kept.
  const auto replace = [&](std::string_view choice, auto changed, auto... kept) {
    const auto other = [=](const Method& method) {
      return integrator(method) && !same(method, changed) && same(method, kept...);
    };
    if (std::ranges::none_of(methods_, other)) return;
    add(choice, [=](const Method& method) { return model(method) && other(method); });
  };
  replace("tolerance", &Method::by_tolerance, &Method::extrapolated);
  replace("extrapolated", &Method::extrapolated, &Method::by_tolerance);
  replace("refresh", &Method::refresh, &Method::by_tolerance);
  replace("mesh", &Method::cut_at_rest, &Method::by_tolerance, &Method::extrapolated);
  best.without.emplace_back("elements", twice_the_elements(winner, target));
  best.without.emplace_back("dt_s", half_the_step(winner, target));
}

/// The run's method with the options of another one, from the run's place.
void Finalists::try_options(const Trial& run, const Trial& with, double target) {
  Method method = methods_[run.method];
  method.options = methods_[with.method].options;
  const auto known = std::ranges::find_if(
      methods_, [&method](const Method& one) { return same(one, method); });
  const auto index = static_cast<std::size_t>(known - methods_.begin());
  if (known == methods_.end()) methods_.push_back(method);
  search_.fewest_that_hold(index, run.elements, target, run.substeps,
                           dearest * run.substeps);
  search_.refine(index, target);
}

ControlCompared Finalists::control(const ModelEntry& model, double target) {
  const auto best = settled(
      target, [&](const Trial& run) { return methods_[run.method].model == &model; });
  if (!best) return {};
  const auto side = [&](bool controlled) {
    return replaced(*best, target, [&model, controlled](const Method& method) {
      return method.model == &model &&
             find_integrator(method.integrator).error_controlled == controlled;
    });
  };
  ControlCompared both{side(false), side(true)};
  if (!both.by_step || !both.by_tolerance) return both;
  // What options do for one side they may do for the other.
  try_options(*both.by_step, *both.by_tolerance, target);
  try_options(*both.by_tolerance, *both.by_step, target);
  both = {side(false), side(true)};
  for (int turn = 0; turn < turns; ++turn) {
    for (Trial* run : {&*both.by_step, &*both.by_tolerance}) {
      double& least_s = times_.at(place(*run)).least_s;
      run->wall_s = least_s = std::min(least_s, time_(*run).least_s);
    }
  }
  return both;
}

std::optional<Trial> Finalists::within(double wall_s, double floor) {
  while (true) {
    const std::vector<Trial> all = runs();
    const Trial* next = most_accurate(all, wall_s, floor);
    if (next == nullptr) return {};
    if (time(*next)) continue;
    if (search_.holds(*next, std::max(next->judged(), floor))) return known(*next);
  }
}

std::optional<Trial> Finalists::nearest() {
  constexpr double any = std::numeric_limits<double>::infinity();
  const Trial* best = most_accurate(search_.runs(), any, 0);
  if (best == nullptr) return {};
  return *best;
}

std::vector<Trial> Finalists::front(double floor, double loosest) {
  while (true) {
    std::vector<Trial> all = runs();
    std::erase_if(all, [loosest](const Trial& run) { return run.judged() > loosest; });
    std::vector<Trial> shown = pareto_front(std::move(all), floor);
    bool settled = true;
    for (Trial& run : shown) {
      const bool timed = !time(run);
      settled = search_.holds(run, std::max(run.judged(), floor)) && timed && settled;
      run = known(run);
    }
    if (settled) return shown;
  }
}

}  // namespace tress::experiments::cost_of_accuracy
