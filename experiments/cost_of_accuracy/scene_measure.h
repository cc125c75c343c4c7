#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/cost_of_accuracy/trial.h"

namespace tress::experiments::cost_of_accuracy {

/// The moduli and the length of strands, all increased by data_change or all decreased:
/// they are not known better. Moduli of hair scatter by tens of per cent between hairs,
/// and two per cent of a length is a curl pulled a little straighter. The solution
/// changes with them, but the error that a run adds must not depend on them.
inline constexpr double data_change = 0.02;
enum class Change { up, down };
Scene changed(Scene scene, Change change);

/// Tips of the rod with changed data, as in SceneReference.
struct ChangedTips {
  std::vector<double> up, down;
};

/// Computes the reference plus the effect of the change on one fine run, `cut` of
/// super_helix by implicit_midpoint:
///
///     x(changed) = x + (fine(changed) - fine).
///
/// The error e of the fine run cancels except for its own change with the data, a few
/// times data_change e. With e = 1 % of the length that is less than 1e-3 of the length.
/// The change itself need not be small. Three runs; stored next to the reference as
/// <name>.changed.
ChangedTips kept_changed_tips(const Scene& given, const Comparison& comparison,
                              const SceneReference& reference, const ReferenceCut& cut,
                              const std::string& folder, const std::string& name);

/// Repeated times of one run: the least (s), since other load on the machine only adds to
/// it, and its repeatability. Repeatability is the least of the even-numbered times over
/// that of the odd ones, less 1.
struct WallTime {
  double least_s = 0, scatter = 0;
};
WallTime wall_time(const std::vector<double>& seconds);

/// Runs a scene by any method and compares its tips with the reference. Times are those
/// of ThreadTimer, the least of several runs.
///
/// A run is abandoned by its count of Newton iterations, so that the result does not
/// depend on the machine. An adaptive run is also abandoned by its steps of a frame,
/// `longest_run` over its elements. A run ends early if its error over the whole horizon
/// must exceed `useless`, and only in an emergency after `most_s`.
class SceneMeasure {
 public:
  SceneMeasure(const Scene& given, const Comparison& comparison,
               std::vector<double> reference, ChangedTips changed, long longest_run,
               double useless = never)
      : given_(given),
        comparison_(comparison),
        reference_(std::move(reference)),
        changed_(std::move(changed)),
        longest_run_(longest_run),
        useless_(useless) {}

  /// One run, repeated a few times if it is short. Empty where the method cannot
  /// represent the scene, fails, or is abandoned.
  /// `most_own_s`: a run that takes longer by ThreadTimer is of no use.
  std::optional<Trial> quick(const Method& method, int elements, int substeps,
                             double most_s, double most_own_s = never) const;
  /// The error with longer or shorter steps, or with changed data against their
  /// reference; infinite where `quick` is empty.
  double neighbour_error(const Method& method, int elements, int substeps,
                         Neighbour which, double most_s) const;
  /// Measures a run of any scene `count` times, as `quick` does. Where the result is
  /// empty, `why` has the reason.
  std::optional<Trial> best_of(const Scene& scene, int count, double most_s,
                               std::string& why) const;
  /// The time alone.
  WallTime time(const Method& method, int elements, int substeps, int count) const;
  /// Against another reference.
  double error(const Method& method, int elements, int substeps,
               const std::vector<double>& reference) const;

 private:
  /// Results of one run, or of two whose tips are extrapolated.
  struct Outcome {
    std::vector<double> tips;
    double once_s = 0, work = 0, indicator = 0, steps = 0;
  };
  Scene scene(const Method& method, int elements, int substeps) const;
  Outcome outcome(const Method& method, int elements, int substeps, double most_s = never,
                  std::optional<Neighbour> as = {}, double most_own_s = never) const;
  const std::vector<double>& reference(std::optional<Neighbour> of) const;
  /// RunLimit::useless against this reference.
  std::function<bool(const std::vector<double>&)> useless(
      const std::vector<double>& reference) const;
  WallTime repeated(const Method& method, int elements, int substeps, int count,
                    double at_least_s) const;

  const Scene& given_;
  Comparison comparison_;
  std::vector<double> reference_;
  ChangedTips changed_;
  long longest_run_;
  double useless_;
};

}  // namespace tress::experiments::cost_of_accuracy
