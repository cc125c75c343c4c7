#pragma once

#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/methods.h"
#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/run/experiment.h"

namespace tress::experiments::cost_of_accuracy {

/// Parameters of the study, common to all scenes.
struct StudyPlan {
  std::vector<double> targets;          // errors of the tip over the length, descending
  std::vector<int> elements, substeps;  // coarse ladders
  MethodChoice methods;
  ReferenceCut reference;
  std::string references;   // folder of stored references
  double rate = 60;         // frames per second
  double horizon = 0.5;     // s
  std::size_t strands = 1;  // of a groom
  /// Work limit of one scene's search: elements x steps of all runs. A clock would make
  /// the answer depend on the load of the machine; the deadline of a row is for
  /// emergencies.
  double search_work = 3e6;
  long longest_run = 4096;  // elements x steps of a frame, per run
  double budget_s = 0;      // wall time per frame; 0: not requested
  int repeat = 3;           // repetitions of timed runs
  bool refine = true;       // winners are checked against a refined reference
  bool report = false;      // reports progress and the best so far
};

/// Errors are trusted from this multiple of the reference's gap on.
constexpr double believed = 10;

/// The horizon ends where the two sides are this far apart, over the length: beyond it
/// not even 1 % could be resolved.
constexpr double parted = 0.01 / believed;

/// All rows of one scene, each beginning with the cells of `identity`:
///
///     winner     the cheapest run that meets a target
///     runner_up  the cheapest of another model or integrator
///     without    the cheapest with one choice of the winner replaced: another model with
///                its best options; on the same model another integrator; the winner
///                with another value of one option, with twice as many elements, and with
///                half the step. Elements and step are tuned anew.
///     budget     the most accurate run within the given time per frame
///     front      runs that no other beats in both error and time
///     as_given   the scene as its file has it
///
/// A run meets a target when it does so wherever the rod is within the gap of the two
/// sides, error + gap <= target, and its neighbours do so for 1.5 times the target (see
/// Neighbour). If none meets it, the winner row has the nearest run and the status
/// not_met.
std::vector<Row> study_scene(const std::string& file, const StudyPlan& plan,
                             const Row& identity, const Deadline& deadline);

}  // namespace tress::experiments::cost_of_accuracy
