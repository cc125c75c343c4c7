#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/cost_of_accuracy/scene_measure.h"

namespace tress::experiments::cost_of_accuracy {

/// Returns these models by these integrators with default options, with a tolerance.
MethodChoice side_choice(std::vector<std::string> models,
                         std::vector<std::string> integrators);

/// Returns the model by esdirk43, or by tr_bdf2 if that cannot drive it; empty: neither
/// can.
std::optional<Method> side_method(const Scene& given, std::string_view model);

/// Elements and tolerance of a run.
struct Level {
  int elements;      // of each strand
  double tolerance;  // over the length
};

/// Runs of one model for a reference, finer and finer, and their limit.
class ReferenceSide {
 public:
  ReferenceSide(const Scene& given, const Comparison& comparison, Method method)
      : given_(&given), comparison_(&comparison), method_(std::move(method)) {}

  std::string_view model() const { return method_.model->id; }

  /// The next run, and a limit where there was one before it.
  void refine(const Level& level, double most_s);

  int failures() const { return failures_; }
  const std::string& failure() const { return failure_; }
  bool has_limit() const { return !limit_.empty(); }
  const std::vector<double>& limit() const { return limit_; }
  double change() const { return change_; }  // of the limit, by the last refinement

  /// Returns the displacements of the compared points by changed data, from the coarser
  /// run of its limit.
  std::vector<double> moved(Change change, double most_s) const;

 private:
  std::vector<double> run(const Level& level, double most_s,
                          std::optional<Change> change = {}) const;

  const Scene* given_;
  const Comparison* comparison_;
  Method method_;
  std::vector<double> coarse_, fine_, limit_;
  Level coarse_level_{}, fine_level_{};
  double change_ = never;
  int failures_ = 0;
  std::string failure_;
};

}  // namespace tress::experiments::cost_of_accuracy
