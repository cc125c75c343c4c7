#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/cost_of_accuracy/decided_reference.h"
#include "experiments/cost_of_accuracy/study_rows.h"
#include "experiments/cost_of_accuracy/trial_scene.h"
#include "simulation/run/tip_paths.h"
#include "simulation/scene_changes/element_unit.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Shares of the time for an answer: at the first one references end, and as much is left
/// for what refers to changed data.
constexpr double reference_share = 0.4;

/// Fewer frames than this, or than this part of them, are no answer about a scene.
constexpr std::size_t fewest_frames = 12;
constexpr double least_part = 0.1;

/// How far the sides are apart after the first `frames`.
double beyond(const SceneReference& whole, std::size_t frames,
              const Comparison& comparison) {
  const std::size_t size = whole.tips.tip.size(), per_frame = size / (whole.frames + 1);
  const auto rest = [&](const std::vector<double>& x) {
    return std::span(x).subspan(per_frame * (frames + 1));
  };
  return frames < whole.frames
             ? simulation::grouped_distance(rest(whole.tips.other), rest(whole.tips.tip),
                                            comparison.group(size / 3)) /
                   comparison.length
             : 0;
}

/// Equilibria at the start are the same up to this distance, over the length: the errors
/// of coarse elements are smaller.
constexpr double same_start = 0.05;

/// Throws std::runtime_error where strands that begin in an equilibrium on their supports
/// begin in different ones, by the references or by the file as given.
void check_start(const Study& study, const SceneReference& whole) {
  const Comparison& comparison = study.comparison;
  const auto start = [&](const std::vector<double>& x) {
    return std::span(x).first(x.size() / (whole.frames + 1));
  };
  const auto refuse = [&](std::span<const double> a, std::string_view who) {
    const std::span<const double> b = start(whole.tips.tip);
    const double apart =
        simulation::grouped_distance(a, b, a.size() / 3) / comparison.length;
    if (apart <= same_start) return;
    throw std::runtime_error(fmt::format(
        "{} begin in different equilibria on the supports, {:.2g} % of the length apart: "
        "give [strand] a shape at the start close to the one that you mean",
        who, 1e2 * apart));
  };
  refuse(start(whole.tips.other), "the references (" + study.how + ")");
  std::vector<double> given;
  try {
    given =
        simulation::points_at_start(compared(study.given, comparison), comparison.read);
  } catch (const std::runtime_error&) {
    return;  // the row of the file as given has the reason
  }
  refuse(given, "your file and the references");
}

/// The reference of an own scene, on which the promise of an answer rests.
void decide(Study& study, const Deadline& deadline, Heartbeat& heartbeat) {
  const StudyPlan& plan = study.plan;
  const double target = plan.targets.back();
  const WantedGap wanted{target / believed, target / believed_in_advice};
  const Deadline enough(reference_share * deadline.remaining_s());
  DecidedReference made = kept_decided(study.given, study.comparison, wanted, enough,
                                       heartbeat, plan.references, study.given.name);
  study.how = std::move(made.how);
  if (held(study.given)) check_start(study, made.reference);
  study.reference = agreed(made.reference, study.comparison, wanted.allowed);
  const std::size_t frames = study.reference.frames;
  study.beyond = beyond(made.reference, frames, study.comparison);
  if (study.reference.tips.gap > wanted.allowed || frames < study.asked) {
    const auto part = static_cast<std::size_t>(
        std::ceil(least_part * static_cast<double>(study.asked)));
    if (frames < std::min(study.asked, std::max(fewest_frames, part))) {
      throw std::runtime_error(fmt::format(
          "the references agree for the first {:.2g} s of {:.3g} s only, beyond they "
          "differ by {:.2g} % of the length ({}): the motion is too sensitive, or more "
          "time is needed (--set answer_s)",
          study.comparison.time_of(frames), study.comparison.horizon(),
          1e2 * study.beyond, study.how));
    }
  }
  const std::size_t size = study.reference.tips.tip.size();
  made.changed.up.resize(size);
  made.changed.down.resize(size);
  study.changed = std::move(made.changed);
}

}  // namespace

Study ready(const std::string& file, const StudyPlan& plan, const Row& identity,
            const Deadline& deadline, Heartbeat& heartbeat) {
  Study study{.plan = plan, .given = read_open_scene(file), .identity = identity};
  const std::string name = study.given.name;
  study.comparison = comparison(study.given, plan.rate, plan.horizon, plan.strands);
  study.asked = study.comparison.frames;
  study.methods = methods(study.given, plan.methods);
  study.left_out = left_out(study.given, plan.methods, study.methods);
  study.element_unit = simulation::element_unit(study.given);
  if (plan.advise) {
    decide(study, deadline, heartbeat);
    study.comparison.frames = study.reference.frames;
    return study;
  }
  heartbeat.doing("computing the references");
  const auto kept = [&](const ReferenceCut& cut, const std::string& as) {
    // The stored gap may be that of another version: it is taken from the tips.
    return first_frames(
        kept_reference(study.given, study.comparison, cut, plan.references, as),
        study.comparison);
  };
  SceneReference whole = kept(plan.reference, name);
  std::optional<SceneReference> fine;
  if (plan.refine) fine = kept(plan.reference.refined(), name + ".refined");
  // Where the reference cannot resolve the tightest target the refined one takes its
  // place, and its own check is that both sides agree.
  if (fine && believed * whole.tips.gap > plan.targets.back()) {
    whole = *std::exchange(fine, std::nullopt);
  }
  study.reference = agreed(whole, study.comparison, parted);
  study.changed = kept_changed_tips(study.given, study.comparison, study.reference,
                                    plan.reference.halved(), plan.references, name);
  study.beyond = beyond(whole, study.reference.frames, study.comparison);
  study.comparison.frames = study.reference.frames;
  if (fine) study.refined = first_frames(*fine, study.comparison);
  return study;
}

}  // namespace tress::experiments::cost_of_accuracy
