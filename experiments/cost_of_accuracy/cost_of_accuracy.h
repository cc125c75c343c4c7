#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiments/cost_of_accuracy/scene_reference.h"
#include "experiments/cost_of_accuracy/trial_scene.h"
#include "experiments/run/experiment.h"
#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"

namespace tress::experiments::cost_of_accuracy {

std::span<const Column> study_columns();

/// Writes a method into its columns.
void set_method(const Method& method, Row& row);

/// The configuration that a row describes.
struct Configuration {
  Method method;
  int elements = 0;
  Accuracy accuracy;
};
Configuration configuration(const Row& row);

/// Parameters of the study, common to all scenes.
struct StudyPlan {
  std::vector<double> targets;          // errors of the tip over the length, descending
  std::vector<int> elements, substeps;  // coarse ladders
  MethodChoice methods;
  /// Models on which methods with error control are compared with those without.
  std::vector<std::string> control;
  ReferenceCut reference;
  std::string references;   // folder of stored references
  double rate = 60;         // frames per second
  double horizon = 0.5;     // s; 0: the scene's duration
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
  /// The answer is for this scene: the reference is refined until it can decide
  /// (decided_reference), and the advised file is run as it is written.
  bool advise = false;
  double answer_s = 0;  // with advise: wall time for the answer; 0: that of the row
  /// Every method with every number of elements and substeps of the ladders as well: what
  /// did the search miss?
  bool exhaustive = false;
};

/// Errors are trusted from this multiple of the reference's gap on.
constexpr double believed = 10;

/// This multiple applies with advise, where the gap is part of the promise (see below)
/// and may be larger.
constexpr double believed_in_advice = 4;

/// The horizon ends where the two sides are this far apart, over the length: beyond it
/// not even 1 % could be resolved.
constexpr double parted = 0.01 / believed;

/// Returns all rows of one scene, each beginning with the cells of `identity`:
///
///     winner     the cheapest run that meets a target
///     runner_up  the cheapest of another model or integrator
///     without    the cheapest with one choice of the winner replaced: another model with
///                its best options; on the same model another integrator; the winner
///                with another value of one option, with twice as many elements, and with
///                half the step. Elements and step are tuned again.
///     by_step    of a model of StudyPlan::control, the cheapest of the methods with
///     fixed
///                steps only
///     by_tolerance  of the same model, the cheapest of the methods with error control,
///                adaptive or with fixed steps, extrapolated in elements or not; its
///                cost_factor is over by_step
///     budget     the most accurate run within the given time per frame
///     front      runs that no other beats in both error and time
///     as_given   the scene as its file has it
///
/// A run meets a target if error + gap <= target, with gap the distance of the two sides
/// of the reference. Its neighbours must do so for 1.5 times the target (see Neighbour).
/// If none meets it, the winner row has the nearest run and the status not_met, of advice
/// no_answer.
std::vector<Row> study_scene(const std::string& file, const StudyPlan& plan,
                             const Row& identity, const Deadline& deadline);

/// Returns the cheapest run of every model by every usual integrator, one row of kind
/// `method` each. Complements the search for the overall best (study_scene) with the cost
/// of each model and the errors of that run in lengths, momentum and energy. Counted work
/// decides, so that the table is the same on every machine (cheapest_run).
///
/// For scenes of one strand. Options of the scene's own model apply to every model with
/// these options. Models that cannot represent the scene are left out. Throws InputError
/// where the scene has another number of strands.
std::vector<Case> method_cases(const CommandLine& line, const std::string& file);

/// The midpoint rule conserves the angular momentum of a thrown body better than its tip.
void check_method_claims(const std::vector<Row>& rows, Verdicts& verdicts);

/// Checks the claims about every scene of the table. Its winners keep their error against
/// a once more refined reference. Their neighbours confirm that they are not accidental.
/// No run listed with a winner, for the same target or in the front, beats it.
void check_accuracy_claims(const std::vector<Row>& rows, Verdicts& verdicts);

/// Returns practical advice from the rows of one scene for one target (or one budget),
/// one line each. Lines are the configuration to take with the time for which that is
/// valid, its worst neighbour, the next best, and what to avoid. One more line follows if
/// the search was stopped early. If nothing meets the target, or nothing did so far, the
/// first line states this and the second has the best run known. If nothing is known the
/// only line gives the reason.
std::vector<std::string> advice(const std::vector<Row>& rows);

/// The cheapest run for each target, and the best within the budget, a line each.
std::vector<std::string> answers(const std::vector<Row>& rows);

/// "super_helix (modes=bend), 9 elements, implicit_midpoint, dt 8.3 ms: 0.82 % of the
/// length in 3.2 ms per simulated second (0.053 ms a frame)"
std::string configuration_and_price(const Row& row);

/// Time for which a row's error is known: "over the whole 2 s", "over the first 0.41 s of
/// 2 s".
std::string validity(const Row& row);

/// Gives rows of an answer that meet neither target nor budget the status no_answer, so
/// that the exit code is 3.
void mark_unanswered(std::vector<Row>& rows);

/// Exchanges winner and runner-up of an answer where the runner-up is both cheaper and
/// more accurate. The two are tied then, and the search took the simpler as the winner.
void put_better_first(std::vector<Row>& rows);

/// The recommended row, or the best known; null if there is none. The best run within the
/// budget, if that is requested, else the winner.
const Row* advised(const std::vector<Row>& rows);

/// Whether a file may be written as advised: it is the scene of advised(), and no worse
/// than the file as given where no run meets the target.
bool may_be_written(const std::vector<Row>& rows);

/// The scene file as advised, for `simulate`. Its duration is the time for which the
/// references agree.
std::string advised_text(const Scene& given, const Row& row, double rate);

}  // namespace tress::experiments::cost_of_accuracy
