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

#include "experiments/cost_of_accuracy/reference_side.h"
#include "experiments/run/message.h"
#include "simulation/scene_changes/element_unit.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Rounded up to multiples of element_unit(), and doubled twice at least.
constexpr int fewest_elements = 10, most_elements = 640;

/// The model of references whose elements are curved.
constexpr const char* curved_model = "super_helix";

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

SceneReference pair_of(const ReferenceSide& a, const ReferenceSide& b,
                       const Comparison& comparison) {
  const bool first = a.change() <= b.change();
  SceneReference made{{first ? a.limit() : b.limit(), first ? b.limit() : a.limit()},
                      comparison.frames};
  made.tips.gap = compared_error(made.tips.other, made.tips.tip, comparison);
  return made;
}

/// Runs sides at the same time.
void refine_all(const std::vector<ReferenceSide*>& sides, const Level& level,
                double most_s) {
  std::vector<std::future<void>> running;
  for (ReferenceSide* side : sides) {
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
        heartbeat_(heartbeat),
        unit_(simulation::element_unit(given)),
        fewest_(unit_ * ((fewest_elements + unit_ - 1) / unit_)) {
    std::vector<std::string> models{curved_model, "der", "articulated_chain"};
    if (held(given)) models.emplace_back("corde");
    for (const std::string& model : models) {
      if (auto method = side_method(given, model)) {
        sides_.emplace_back(given, comparison, std::move(*method));
      }
    }
    if (sides_.size() < 2) {
      std::string why =
          "fewer than two of the models for references take this scene: there is nothing "
          "to compare with";
      for (const LeftOut& one : left_out(given, side_choice(models, {"none"}), {})) {
        const bool taken = std::ranges::count(sides_, one.id, &ReferenceSide::model) > 0;
        if (!taken) why += fmt::format("; {}: {}", one.id, one.why);
      }
      throw std::runtime_error(why);
    }
  }

  DecidedReference result() {
    climb();
    for (std::size_t k = 2; !decided_ && k < sides_.size(); ++k) {
      catch_up(sides_[k]);
      decided_ = agree();
    }
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
    for (int n = fewest_; n <= std::max(most_elements, 4 * fewest_); n *= 2) {
      const bool two = n > 2 * fewest_;  // a limit takes two runs
      if (two && dearer * took_s > deadline_.remaining_s()) return;
      const Deadline::Clock::time_point start = Deadline::Clock::now();
      level_ = level_of(n);
      heartbeat_.doing(fmt::format("computing the reference, {} elements", n));
      refine_all({&sides_[0], &sides_[1]}, level_, deadline_.remaining_s());
      took_s = std::chrono::duration<double>(Deadline::Clock::now() - start).count();
      for (ReferenceSide* side : {&sides_[0], &sides_[1]}) {
        const auto spare =
            std::find_if(sides_.begin() + 2, sides_.end(),
                         [](const ReferenceSide& other) { return other.failures() < 2; });
        if (side->failures() < 2 || spare == sides_.end()) continue;
        std::swap(*side, *spare);
        catch_up(*side);
      }
      const ReferenceSide &a = sides_[0], &b = sides_[1];
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
  void catch_up(ReferenceSide& side) {
    heartbeat_.doing(fmt::format("computing the reference, {} as well", side.model()));
    for (const int n : {level_.elements / 4, level_.elements / 2, level_.elements}) {
      if (n >= 2 && n % unit_ == 0) side.refine(level_of(n), deadline_.remaining_s());
    }
  }

  /// Models of straight edges have similar errors on curls. One of a pair has curved
  /// elements, where a model with them has a limit.
  std::optional<std::pair<const ReferenceSide*, const ReferenceSide*>> best_pair() const {
    const auto curved = [](const ReferenceSide& side) {
      return side.model() == curved_model && side.has_limit();
    };
    const bool choice = std::ranges::any_of(sides_, curved);
    std::optional<std::pair<const ReferenceSide*, const ReferenceSide*>> best;
    std::size_t longest = 0;
    double least = never;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      for (std::size_t j = i + 1; j < sides_.size(); ++j) {
        if (!sides_[i].has_limit() || !sides_[j].has_limit()) continue;
        if (choice && !curved(sides_[i]) && !curved(sides_[j])) continue;
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

  /// Whether some pair is as close as is allowed over all frames.
  bool agree() const {
    const auto best = best_pair();
    if (!best) return false;
    const SceneReference both = pair_of(*best->first, *best->second, comparison_);
    return both.tips.gap <= wanted_.allowed;
  }

  std::string why_not() const {
    std::string why =
        deadline_.passed()
            ? "out of time before two models reached the end: continue with a "
              "larger --timeout and --set answer_s"
            : "fewer than two models reached the end";
    for (const ReferenceSide& side : sides_) {
      if (!side.failure().empty()) why += "; " + side.failure();
    }
    return why;
  }

  /// As of kept_changed_tips.
  ChangedTips changed_tips(const ReferenceSide& side, const SceneReference& reference) {
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
  const int unit_, fewest_;  // elements
  std::vector<ReferenceSide> sides_;
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
