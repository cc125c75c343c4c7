#include "experiments/cost_of_accuracy/decided_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <future>
#include <stdexcept>
#include <utility>
#include <vector>

#include "contract/input_error.h"
#include "experiments/run/message.h"
#include "simulation/run/tip_paths.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

constexpr int fewest_elements = 10, most_elements = 640;

/// Two limits are compared from here on: three runs of a side.
constexpr int fewest_compared = 40;

/// Doubling the elements lengthens a run by 2, by 4 where a matrix is dense, and the
/// tolerance by 1.4.
constexpr double dearer = 3.5;

/// The first tolerance over the gap that is sought; it falls with the square of the
/// elements. A run ends within ten times its tolerance: from fewest_compared on within a
/// sixteenth of the gap.
constexpr double tighter = 0.1;

/// A refinement that changes both sides by less than this part of their gap will not
/// close it.
constexpr double converged_part = 0.1;

/// Steps of a frame; beyond it a run is given up.
constexpr long most_steps = 20000;

/// The model by the first of these integrators that can drive it; empty: none can.
std::optional<Method> method_of(const Scene& given, std::string_view model) {
  for (const std::string_view integrator : {"esdirk43", "tr_bdf2"}) {
    const MethodChoice choice{.models = {std::string(model)},
                              .integrators = {std::string(integrator)},
                              .options = {"none"},
                              .fixed_steps = false,
                              .extrapolated = false};
    for (const Method& method : methods(given, choice)) {
      if (method.by_tolerance) return method;
    }
  }
  return {};
}

struct Level {
  int elements;
  double tolerance;
};

/// Runs of one model, and their limit.
class Side {
 public:
  Side(const Scene& given, const Comparison& comparison, Method method)
      : given_(&given), comparison_(&comparison), method_(std::move(method)) {}

  std::string_view model() const { return method_.model->id; }

  std::vector<double> run(const Level& level, double most_s,
                          std::optional<Change> change = {}) const {
    Scene scene = compared(trial_scene(*given_, method_, level.elements,
                                       {.tolerance = level.tolerance}, comparison_->rate),
                           *comparison_);
    scene.options.max_step = 1 / comparison_->rate;
    scene.options.max_steps = most_steps;
    if (change) scene = changed(std::move(scene), *change);
    return tip_paths(scene, 0, {.wall_s = most_s}).x;
  }

  /// The next run, and a limit where there was one before it.
  void refine(const Level& level, double most_s) {
    try {
      std::vector<double> x = run(level, most_s);
      if (!fine_.empty()) {
        std::vector<double> limit = x;
        const double factor = extrapolation(method_, level.elements);
        for (std::size_t i = 0; i < x.size(); ++i) limit[i] += factor * (x[i] - fine_[i]);
        change_ = limit_.empty() ? never : compared_error(limit, limit_, *comparison_);
        limit_ = std::move(limit);
        coarse_ = std::move(fine_);
        coarse_level_ = fine_level_;
      }
      fine_ = std::move(x);
      fine_level_ = level;
    } catch (const std::runtime_error& failure) {  // including refusals
      failure_ = fmt::format("{}: {}", model(), failure.what());
      ++failures_;
      fine_.clear();
    }
  }

  int failures() const { return failures_; }
  const std::string& failure() const { return failure_; }
  bool has_limit() const { return !limit_.empty(); }
  const std::vector<double>& limit() const { return limit_; }
  double change() const { return change_; }  // of the limit, by the last refinement

  /// What changed data do to the tips, by the coarser run of its limit.
  std::vector<double> moved(Change change, double most_s) const {
    std::vector<double> x = run(coarse_level_, most_s, change);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= coarse_[i];
    return x;
  }

 private:
  const Scene* given_;
  const Comparison* comparison_;
  Method method_;
  std::vector<double> coarse_, fine_, limit_;
  Level coarse_level_{}, fine_level_{};
  double change_ = never;
  int failures_ = 0;
  std::string failure_;
};

SceneReference pair_of(const Side& a, const Side& b, const Comparison& comparison) {
  const bool first = a.change() <= b.change();
  SceneReference made{{first ? a.limit() : b.limit(), first ? b.limit() : a.limit()},
                      comparison.frames};
  made.tips.gap = compared_error(made.tips.other, made.tips.tip, comparison);
  return made;
}

/// Runs sides at the same time.
void refine_all(const std::vector<Side*>& sides, const Level& level, double most_s) {
  std::vector<std::future<void>> running;
  for (Side* side : sides) {
    running.push_back(std::async(
        std::launch::async, [side, &level, most_s] { side->refine(level, most_s); }));
  }
  for (std::future<void>& one : running) one.get();
}

class Refinement {
 public:
  Refinement(const Scene& given, const Comparison& comparison, const WantedGap& wanted,
             const Deadline& deadline, Heartbeat& heartbeat)
      : given_(given),
        comparison_(comparison),
        wanted_(wanted),
        deadline_(deadline),
        heartbeat_(heartbeat) {
    for (const std::string_view model : {"super_helix", "der", "articulated_chain"}) {
      if (auto method = method_of(given, model)) {
        sides_.emplace_back(given, comparison, std::move(*method));
      }
    }
    if (sides_.size() < 2) {
      throw std::runtime_error(
          "fewer than two models take this scene: there is nothing to compare with");
    }
  }

  DecidedReference result() {
    climb();
    if (!decided_ && sides_.size() > 2) catch_up(sides_[2]);
    const auto best = best_pair();
    if (!best) throw std::runtime_error(why_not());
    const auto& [a, b] = *best;
    DecidedReference made{pair_of(*a, *b, comparison_), {}, {}};
    made.how = fmt::format("{} and {}, {} elements, tolerance {:.2g}", a->model(),
                           b->model(), level_.elements, level_.tolerance);
    made.changed = changed_tips(a->change() <= b->change() ? *a : *b, made.reference);
    return made;
  }

 private:
  Level level_of(int elements) const {
    const double coarseness = static_cast<double>(fewest_elements) / elements;
    return {elements, tighter * wanted_.sought * coarseness * coarseness};
  }

  void climb() {
    double took_s = 0;
    for (int n = fewest_elements; n <= most_elements; n *= 2) {
      const bool two = n > 2 * fewest_elements;  // a limit takes two runs
      if (two && dearer * took_s > deadline_.remaining_s()) return;
      const Deadline::Clock::time_point start = Deadline::Clock::now();
      level_ = level_of(n);
      heartbeat_.doing(fmt::format("computing the reference, {} elements", n));
      refine_all({&sides_[0], &sides_[1]}, level_, deadline_.remaining_s());
      took_s = std::chrono::duration<double>(Deadline::Clock::now() - start).count();
      for (Side* side : {&sides_[0], &sides_[1]}) {
        if (side->failures() < 2 || sides_.size() < 3 || sides_[2].failures() > 1)
          continue;
        std::swap(*side, sides_[2]);
        catch_up(*side);
      }
      const Side &a = sides_[0], &b = sides_[1];
      if (n < fewest_compared || !a.has_limit() || !b.has_limit()) continue;
      const double gap = pair_of(a, b, comparison_).tips.gap;
      const double change = std::max(a.change(), b.change());
      const bool converged = change <= converged_part * gap;
      decided_ = (gap <= wanted_.sought && change <= wanted_.sought) ||
                 (gap <= wanted_.allowed && converged);
      // Two limits that differ: der may stretch, which the others do not.
      if (decided_ || converged) return;
    }
  }

  /// A model that has not run yet, up to where the others are.
  void catch_up(Side& side) {
    heartbeat_.doing(fmt::format("computing the reference, {} as well", side.model()));
    for (const int n : {level_.elements / 4, level_.elements / 2, level_.elements}) {
      if (n >= 2) side.refine(level_of(n), deadline_.remaining_s());
    }
  }

  std::optional<std::pair<const Side*, const Side*>> best_pair() const {
    std::optional<std::pair<const Side*, const Side*>> best;
    std::size_t longest = 0;
    double least = never;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (std::size_t j = i + 1; j < sides_.size(); ++j) {
        if (!sides_[i].has_limit() || !sides_[j].has_limit()) continue;
        const SceneReference both = pair_of(sides_[i], sides_[j], comparison_);
        const std::size_t frames = agreed(both, comparison_, wanted_.allowed).frames;
        if (best && frames < longest) continue;
        if (best && frames == longest && both.tips.gap >= least) continue;
        best = {&sides_[i], &sides_[j]};
        longest = frames;
        least = both.tips.gap;
      }
    }
    return best;
  }

  std::string why_not() const {
    std::string why =
        deadline_.passed()
            ? "out of time before two models reached the end: continue with a "
              "larger --timeout and --set answer_s"
            : "fewer than two models reached the end";
    for (const Side& side : sides_) {
      if (!side.failure().empty()) why += "; " + side.failure();
    }
    return why;
  }

  /// As of kept_changed_tips.
  ChangedTips changed_tips(const Side& side, const SceneReference& reference) {
    heartbeat_.doing("computing the reference with changed data");
    const auto moved = [&](Change change) {
      std::vector<double> x = side.moved(change, never);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += reference.tips.tip[i];
      return x;
    };
    auto up = std::async(std::launch::async, moved, Change::up);
    ChangedTips made;
    made.down = moved(Change::down);
    made.up = up.get();
    return made;
  }

  const Scene& given_;
  const Comparison& comparison_;
  const WantedGap wanted_;
  const Deadline& deadline_;
  Heartbeat& heartbeat_;
  std::vector<Side> sides_;
  Level level_{};
  bool decided_ = false;
};

const ReferenceSides decided_sides{
    "tips of the rod by two models, extrapolated in element length",
    "the tip by the model that changed less", "the tip by the other"};
const ReferenceSides changed_sides{
    "tips of the rod with moduli and lengths changed by 2 %", "up", "down"};

}  // namespace

DecidedReference decided_reference(const Scene& given, const Comparison& comparison,
                                   const WantedGap& wanted, const Deadline& deadline,
                                   Heartbeat& heartbeat) {
  return Refinement(given, comparison, wanted, deadline, heartbeat).result();
}

DecidedReference kept_decided(const Scene& given, const Comparison& comparison,
                              const WantedGap& wanted, const Deadline& deadline,
                              Heartbeat& heartbeat, const std::string& folder,
                              const std::string& name) {
  const std::string key =
      reference_key(given, comparison, {}) + fmt::format(" {:.3g}", wanted.sought);
  const std::string changed_name = name + ".changed";
  if (!folder.empty()) {
    auto tips = load_reference(folder, name, key);
    auto moved = load_reference(folder, changed_name, key);
    if (tips && moved) {
      return {std::move(*tips), {moved->tips.tip, moved->tips.other}, "kept"};
    }
  }
  tell("{}: computing the reference\n", name);
  DecidedReference made =
      decided_reference(given, comparison, wanted, deadline, heartbeat);
  if (folder.empty() || made.reference.tips.gap > wanted.allowed) return made;
  const ReferenceCut finest{};
  save_reference(folder, name, key, made.reference, comparison, finest, decided_sides);
  const SceneReference moved{{made.changed.up, made.changed.down}, comparison.frames};
  save_reference(folder, changed_name, key, moved, comparison, finest, changed_sides);
  return made;
}

}  // namespace tress::experiments::cost_of_accuracy
