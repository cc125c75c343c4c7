#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/cost_of_accuracy/finalists.h"
#include "experiments/cost_of_accuracy/scene_measure.h"
#include "experiments/run/progress.h"

namespace tress::experiments::cost_of_accuracy {

/// Data from which all rows of a scene are written.
struct Study {
  const StudyPlan& plan;
  const Scene given;
  const Row& identity;
  Comparison comparison = {};  // truncated where the references diverge
  std::size_t asked = 0;       // frames, before that
  double beyond = 0;           // how far the references differ from there on
  std::string how = {};        // DecidedReference::how
  SceneReference reference = {};
  std::optional<SceneReference> refined = {};
  ChangedTips changed = {};
  std::vector<Method> methods = {};
  std::vector<LeftOut> left_out = {};  // models and integrators without a method
  int element_unit = 1;                // every number of elements is a multiple of it

  double gap() const { return reference.tips.gap; }
  bool cut() const { return comparison.frames < asked; }
  double trusted() const { return plan.advise ? believed_in_advice : believed; }
  double floor() const { return trusted() * gap(); }
};

/// The scene with its methods and its references: those that are kept, or, for advice,
/// one that decides. Throws std::runtime_error where there is none.
Study ready(const std::string& file, const StudyPlan& plan, const Row& identity,
            const Deadline& deadline, Heartbeat& heartbeat);

/// A row with the columns common to the study; the second with those of a run.
Row begin(const Study& study, std::string_view kind);
Row row_of(const Study& study, std::string_view kind, const Trial& run);

SceneMeasure measure_of(const Study& study);

/// Why a target below the floor has no answer, and for advice the remedy.
std::string below_reference(const Study& study, double target);

/// Winner, runner-up and replaced choices of one target.
void add_target(const Study& study, Finalists& finalists, double target,
                std::vector<Row>& rows);
/// Error control against steps, on the models for which that is asked.
void add_control(const Study& study, Finalists& finalists, double target,
                 std::vector<Row>& rows);
/// A row for each model and integrator without a method, with the reason.
void add_left_out(const Study& study, std::vector<Row>& rows);
/// The best run within the time per frame, if requested.
void add_budget(const Study& study, Finalists& finalists, std::vector<Row>& rows);
/// Runs the advised scene from its file, and writes the error and the time of that run
/// into its row. False: the error is not that of the row, or the file does not run.
bool confirm(const Study& study, Row& row);
/// The scene with the file's own model, integrator, elements and step; steps end at the
/// frames of the comparison, `most_s` of wall time at most.
void add_given(const Study& study, double most_s, std::vector<Row>& rows);

}  // namespace tress::experiments::cost_of_accuracy
