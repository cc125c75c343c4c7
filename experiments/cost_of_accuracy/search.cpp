#include "experiments/cost_of_accuracy/search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Ratios of errors above which the remaining error is not temporal, for half the step
/// and for two thirds of the step.
constexpr double little_gain = 0.8, hardly_any_gain = 0.95;

/// Counts the runs in a row that reduced the error by less than a ratio.
class Gain {
 public:
  explicit Gain(double ratio) : ratio_(ratio) {}
  void add(double error) {
    const bool gains = error <= ratio_ * last_;
    idle_ = gains ? 0 : idle_ + 1;
    gaining_ = gains ? gaining_ + 1 : 0;
    before_ = std::exchange(last_, error);
  }
  int idle() const { return idle_; }
  double last() const { return last_; }
  /// The error that is at least left in the steps, which the last runs halved; 0: errors
  /// do not say.
  double of_steps(double order) const {
    return gaining_ > 2 ? (before_ - last_) / (std::exp2(order) - 1) : 0;
  }

 private:
  double ratio_, before_ = never, last_ = never;
  int idle_ = 0, gaining_ = 0;
};

/// A method of the same kind may need this many times the substeps.
constexpr int alike = 2;

/// Apparent cost ratio that may be due to noise in a single run.
constexpr double noise = 1.2;

/// A comb tries numbers of elements within a quarter, and runs down to three quarters of
/// the work, a tenth apart.
constexpr int comb_width = 4, comb_teeth = 10;
constexpr double comb_depth = 0.75;

/// Numbers of elements from two thirds to three halves of this, a tenth apart, nearest
/// first.
std::vector<int> around(int elements) {
  std::vector<int> all{elements};
  int low = elements, high = elements;
  while (2 * high < 3 * elements) {
    high += std::max(1, high / 10);
    all.push_back(high);
    low -= std::max(1, low / 10);
    if (low > 0 && 3 * low >= 2 * elements) all.push_back(low);
  }
  return all;
}

/// A sweep ends for a number of elements where the error is this many times the target:
/// shorter steps meet it, longer ones do not.
constexpr double out_of_reach = 3;

/// Numbers from `first` to `last`, an eighth apart; six of these steps double a number.
constexpr std::ptrdiff_t eighths_of_double = 6;
std::vector<int> eighths(int first, int last) {
  std::vector<int> all;
  for (int n = first; n <= last; n += std::max(1, n / 8)) all.push_back(n);
  return all;
}

double largest_ratio(const std::vector<int>& ladder) {
  double ratio = 1;
  for (std::size_t i = 1; i < ladder.size(); ++i) {
    ratio = std::max(ratio, static_cast<double>(ladder[i]) / ladder[i - 1]);
  }
  return ratio;
}

}  // namespace

double ladder_slack(const SearchPlan& plan, double run_noise) {
  return largest_ratio(plan.elements) * largest_ratio(plan.substeps) * run_noise;
}

Search::Search(SearchPlan plan, std::size_t methods, Measure measure, Changed changed,
               std::function<bool()> stop)
    : plan_(std::move(plan)),
      methods_(methods),
      measure_(std::move(measure)),
      changed_(std::move(changed)),
      stop_(std::move(stop)) {
  // Pointers into runs_ are held across a few runs.
  runs_.reserve(1 << 16);
}

void Search::go_on(std::function<bool()> stop) {
  stop_ = std::move(stop);
  cut_ = false;
}

bool Search::stopped() {
  cut_ = cut_ || stop_() || runs_.size() == runs_.capacity();
  return cut_;
}

const Trial* Search::run(std::size_t method, int wanted, int substeps) {
  const int cells = (wanted + plan_.element_unit / 2) / plan_.element_unit;
  const int elements = plan_.element_unit * std::max(1, cells);
  const Place place{method, elements, substeps};
  const auto known = seen_.find(place);
  if (known != seen_.end()) {
    return known->second ? &runs_[*known->second] : nullptr;
  }
  if (stopped()) return nullptr;
  const auto found = measure_(method, elements, substeps);
  if (!found || !std::isfinite(found->error)) {
    seen_.emplace(place, std::nullopt);
    return nullptr;
  }
  seen_.emplace(place, runs_.size());
  runs_.push_back(*found);
  price(runs_.back());
  return &runs_.back();
}

void Search::price(Trial& measured) {
  if (measured.work <= 0) return;
  const auto key = [](const Trial& run) {
    return std::pair(run.method, std::ilogb(run.elements));
  };
  const double now = measured.wall_s / measured.work;
  const auto [known, first] = price_.try_emplace(key(measured), now);
  if (first || now >= known->second) {
    measured.wall_s = known->second * measured.work;
    return;
  }
  known->second = now;
  for (Trial& run : runs_) {
    if (key(run) == known->first) run.wall_s = now * run.work;
  }
}

double Search::neighbour_error(const Trial& own, Neighbour which) {
  const auto error = [](const Trial* run) { return run == nullptr ? never : run->error; };
  switch (which) {
    case Neighbour::one_more_element:
      return error(run(own.method, own.elements + plan_.element_unit, own.substeps));
    case Neighbour::two_more:
      return error(run(own.method, own.elements + 2 * plan_.element_unit, own.substeps));
    case Neighbour::shorter_steps:
    case Neighbour::longer_steps:
    case Neighbour::data_up:
    case Neighbour::data_down:
      break;
  }
  return stopped() ? never : changed_(own, which);
}

bool Search::holds(const Trial& given, double target) {
  const auto index = seen_.at({given.method, given.elements, given.substeps});
  Trial& own = runs_[*index];
  while (own.judged() <= target && own.examined < neighbour_count) {
    const auto which = static_cast<Neighbour>(own.examined);
    const double error = neighbour_error(own, which);
    if (cut_) return false;  // unknown
    if (error >= own.neighbours) own.worst = which;
    own.neighbours = std::max(own.neighbours, error);
    ++own.examined;
  }
  return own.judged() <= target;
}

const Trial* Search::robust(double target,
                            const std::function<bool(const Trial&)>& accept) {
  while (const Trial* next = cheapest(runs_, target, accept)) {
    if (holds(*next, target)) return next;
    if (cut_) break;
    ++passed_over_;
  }
  return cheapest(runs_, target, [&accept](const Trial& run) {
    return run.examined == neighbour_count && (!accept || accept(run));
  });
}

/// Extrapolated from the method's run nearest in elements, then in substeps; 0 without
/// one.
double Search::expected_s(std::size_t method, int elements, int substeps) const {
  const auto away = [&](const Trial& run) {
    return 4 * std::abs(std::log(static_cast<double>(run.elements) / elements)) +
           std::abs(std::log(static_cast<double>(run.substeps) / substeps));
  };
  const Trial* near = nullptr;
  for (const Trial& run : runs_) {
    if (run.method != method) continue;
    if (near == nullptr || away(run) < away(*near)) near = &run;
  }
  if (near == nullptr) return 0;
  return near->wall_s * (static_cast<double>(elements) / near->elements) *
         (static_cast<double>(substeps) / near->substeps);
}

/// Beyond it a run is longer than the longest that is tried.
int Search::most_substeps(std::size_t method, int elements) const {
  return static_cast<int>(plan_.longest_run * unit(method) / elements);
}

void Search::climb(std::size_t method) {
  const auto& ladder = plan_.substeps;
  const double tightest = plan_.targets.back(), loosest = plan_.targets.front();
  std::size_t begin = 0;
  int met = 0;  // the next rung after the first success may allow longer steps
  for (const int elements : plan_.elements) {
    if (met > 1) return;
    Gain gain(little_gain);
    enum { none, gaining, spatial, enough } end = none;
    std::size_t at = begin;
    for (; at < ladder.size() && end != spatial && end != enough; ++at) {
      const int substeps = ladder[at] * unit(method);
      if (substeps > most_substeps(method, elements)) break;
      // Longer than any run that could still keep the method.
      const Trial* best = robust(tightest);
      const double most_s = best == nullptr ? never : plan_.slack * best->wall_s;
      if (cut_ || expected_s(method, elements, substeps) > most_s) break;
      const Trial* found = run(method, elements, substeps);
      if (cut_) return;
      if (found == nullptr) continue;  // too long a step
      // The neighbours of a run that cannot win decide nothing.
      const bool dearer = best != nullptr && found->wall_s > best->wall_s;
      if (found->judged() <= tightest && (dearer || holds(*found, tightest))) {
        end = enough;
      } else {
        gain.add(found->judged());
        // A motion that is fully damped also gains little, for a while.
        const int most_idle = found->judged() < loosest ? 0 : 2;
        end = gain.idle() > most_idle ? spatial : gaining;
      }
      if (cut_) return;
    }
    if (end == enough) ++met;
    // More elements help where a target is above the error of the steps, of which they
    // allow no more, and not met.
    const double of_steps = gain.of_steps(orders(method).time);
    if (end == gaining && std::ranges::none_of(plan_.targets, [&](double target) {
          return of_steps < target && target < gain.last();
        })) {
      return;
    }
    if (end != none) begin = std::max(begin, at < 4 ? 0 : at - 4);
  }
}

bool Search::follow(std::size_t method) {
  if (!plan_.kind) return false;
  const auto same_kind = [&](const Trial& run) {
    return run.method != method && plan_.kind(run.method) == plan_.kind(method);
  };
  // The tightest target says whether the kind has climbed: it may meet no other.
  if (cheapest(runs_, plan_.targets.back(), same_kind) == nullptr) return false;
  for (const double target : plan_.targets) {
    const Trial* leader = robust(target, same_kind);
    if (cut_) return true;
    if (leader == nullptr) continue;
    fewest_substeps(method, leader->elements, target, leader->substeps,
                    alike * leader->substeps);
  }
  return true;
}

/// By expected cost to a factor of 2, then in the order of the catalogue: the same order
/// under any load of the machine. An error above the target needs more elements and more
/// substeps, each by its order.
std::vector<std::size_t> Search::promising_first(const std::function<bool()>& probed) {
  std::vector<std::size_t> probes;
  for (const bool first_of_kind : {true, false}) {
    for (std::size_t method = 0; method < methods_; ++method) {
      const bool first = !plan_.kind || plan_.kind(method) == method;
      if (first == first_of_kind) probes.push_back(method);
    }
  }
  const int elements = plan_.elements[plan_.elements.size() / 2];
  const int substeps = plan_.substeps[plan_.substeps.size() / 3];
  const double tightest = plan_.targets.back();
  std::vector<std::pair<double, std::size_t>> order;
  for (const std::size_t method : probes) {
    const Trial* probe =
        probed && probed() ? nullptr : run(method, elements, substeps * unit(method));
    const auto [space, time] = orders(method);
    const auto price = [&](const Trial& of) {
      return std::log2(of.wall_s) +
             (1 / space + 1 / time) * std::log2(of.error / tightest);
    };
    order.emplace_back(probe == nullptr ? never : std::round(price(*probe)), method);
  }
  std::ranges::sort(order);
  std::vector<std::size_t> methods;
  methods.reserve(order.size());
  for (const auto& [price, method] : order) methods.push_back(method);
  return methods;
}

void Search::coarse(const std::function<bool()>& probed) {
  order_ = promising_first(probed);
  for (const std::size_t method : order_) {
    if (stopped()) return;
    if (!follow(method)) climb(method);
    ++tried_;
  }
}

const Trial* Search::fewest_substeps(std::size_t method, int elements, double target,
                                     int guess, int most) {
  const auto meets = [target](const Trial* run) {
    return run != nullptr && run->judged() <= target;
  };
  most = std::min(most, most_substeps(method, elements));
  // Bracket: `few` fails, or is not tried; `enough` succeeds.
  const int least = unit(method);
  if (most < least) return nullptr;
  int few = least - 1, enough = std::clamp(guess, least, most);
  const Trial* best = run(method, elements, enough);
  Gain gain(hardly_any_gain);
  while (!meets(best)) {
    if (best != nullptr) gain.add(best->judged());
    if (cut_ || enough == most || gain.idle() > 1) return nullptr;
    few = enough;
    enough = std::min(most, enough + std::max(1, enough / 2));
    best = run(method, elements, enough);
  }
  while (enough > few + 1 && enough > resolution * few) {
    const int middle = few < least
                           ? (least + enough) / 2
                           : static_cast<int>(std::lround(std::sqrt(1.0 * few * enough)));
    const int next = std::clamp(middle, few + 1, enough - 1);
    const Trial* found = run(method, elements, next);
    if (cut_) return best;
    if (meets(found)) {
      best = found;
      enough = next;
    } else {
      few = next;
    }
  }
  return best;
}

const Trial* Search::fewest_that_hold(std::size_t method, int elements, double target,
                                      int guess, int most) {
  while (const Trial* found = fewest_substeps(method, elements, target, guess, most)) {
    if (holds(*found, target)) return found;
    if (cut_) return nullptr;
    ++passed_over_;
  }
  return nullptr;
}

void Search::refine(std::size_t method, double target, Bound bound) {
  if (!refined_.emplace(method, target, bound).second) return;
  const auto own = [method](const Trial& run) { return run.method == method; };
  for (const Trial* before = nullptr; !stopped();) {
    const Trial* start = robust(target, own);
    if (start == nullptr || start == before) return;
    before = start;
    for (const int elements : around(start->elements)) {
      if (stopped()) return;
      // More substeps than make it dearer than the best so far are useless.
      const Trial* best = bound == Bound::own ? robust(target, own) : robust(target);
      if (best == nullptr) return;
      const double one_s =
          expected_s(method, elements, start->substeps) / start->substeps;
      const int most =
          static_cast<int>(std::min(noise * best->wall_s / one_s, 4.0 * start->substeps));
      if (most < 1) continue;
      fewest_substeps(method, elements, target, start->substeps, most);
    }
  }
}

void Search::comb(const Trial& best) {
  const auto [method, n, k] = Place{best.method, best.elements, best.substeps};
  for (int elements = std::max(1, n - n / comb_width); elements <= n + n / comb_width;
       ++elements) {
    const double as_dear = 1.0 * n * k / elements;
    for (int substeps = std::max(unit(method), static_cast<int>(comb_depth * as_dear));
         substeps < as_dear; substeps += std::max(1, substeps / comb_teeth)) {
      if (stopped()) return;
      run(method, elements, substeps);
    }
  }
}

/// Errors of space and of time may cancel: the cheapest run may lie where neither fewer
/// elements nor longer steps lead to it. All methods are tried wherever a run would be
/// cheaper than the best so far.
void Search::sweep() {
  const std::vector<int> elements =
      eighths(plan_.elements.front(), plan_.elements.back());
  for (const std::size_t method : order_) {
    for (const double target : plan_.targets) {
      if (stopped()) return;
      for (const int n : elements) sweep(method, n, target);
    }
  }
}

void Search::sweep(std::size_t method, int elements, double target) {
  const Trial* best = robust(target);
  if (stopped() || best == nullptr) return;
  // The same for any times of runs.
  const std::vector<int> tried = eighths(unit(method), most_substeps(method, elements));
  // The last that may cost no more than the best, by the run nearest to one with `like`.
  const auto affordable = [&](int like) {
    const double one_s = expected_s(method, elements, like) / like;
    const double most = one_s > 0 ? noise * best->wall_s / one_s : 0;
    return std::ranges::upper_bound(tried, most) - tried.begin() - 1;
  };
  // Where a tolerance chooses the steps, each run corrects what the next one may take.
  std::ptrdiff_t at = -1;
  for (auto next = affordable(unit(method)); next > at;
       next = std::min(affordable(tried[static_cast<std::size_t>(at)]),
                       at + eighths_of_double)) {
    at = next;
    if (run(method, elements, tried[static_cast<std::size_t>(at)]) == nullptr) break;
  }
  for (; at >= 0; --at) {
    const Trial* found = run(method, elements, tried[static_cast<std::size_t>(at)]);
    if (stopped()) return;
    // None: it fails, or takes far longer than the best.
    if (found != nullptr && found->error > out_of_reach * target) return;
  }
}

/// From the cheapest on: what is found bounds how many more are refined, and how far.
bool Search::refine_next(double target) {
  const Trial* best = robust(target);
  const Trial* next = cheapest(runs_, target, [&](const Trial& run) {
    return !refined_.contains({run.method, target, Bound::all});
  });
  if (stopped() || best == nullptr || next == nullptr) return false;
  if (next->wall_s > plan_.slack * best->wall_s) return false;
  refine(next->method, target, Bound::all);
  return true;
}

/// One method for each target in turn, so that no target uses up the work of another.
void Search::refine() {
  std::vector<double> open = plan_.targets;
  while (!open.empty()) {
    std::erase_if(open, [this](double target) { return !refine_next(target); });
  }
}

}  // namespace tress::experiments::cost_of_accuracy
