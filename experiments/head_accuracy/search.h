#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/head_accuracy/measure.h"

namespace tress::experiments::head_accuracy {

/// Statistic of the errors of the hairs that has the target.
enum class Over { mean, p95, largest };
double value(const Spread& spread, Over over);

/// Factor by which the errors of a run's neighbours may exceed the target error.
inline constexpr double neighbour_allowance = 1.5;

/// Counted work of a follower's point, as measured, so that the choice does not depend on
/// the load of the machine. The unit is a step of an element: HeadMeasure::element_work
/// in double precision and half that work in single precision.
inline constexpr double point_work = 0.35;
double frame_work(const Choice& choice, const HeadMeasure& measure);

struct SearchPlan {
  std::vector<int> elements, substeps;  // ascending
  int bits = 32;
  std::size_t sample = 64;  // hairs by which elements and steps are judged beforehand
  std::size_t runs = 40;    // of the whole head for one target, neighbours aside
};

/// A run with the largest error of its neighbours: a tenth more guides and a tenth fewer,
/// one more element, one and a half times the steps. A head of which every hair is
/// simulated has no neighbour in guides.
struct Judged {
  HeadTrial trial;
  double error = 0, neighbours = 0;
};

/// Search for the cheapest batch for a target. Errors come from two parts that are cheap
/// to compute. Those of interpolation come from guides as in the reference, for half of
/// the hairs, a quarter and so on, or no followers. Those of elements and steps come from
/// a sample of hairs. The combinations whose parts allow for the target are run, the
/// cheapest first, until one meets it, with its neighbours. Guides, elements and steps
/// are then lowered one after the other for as long as that holds. Uses no clock but for
/// budgets.
class HeadSearch {
 public:
  /// `done`: true once time is up.
  HeadSearch(const HeadMeasure& measure, SearchPlan plan, Over over,
             std::function<bool()> done);

  /// Empty if no run that was tried meets the target.
  std::optional<Judged> cheapest(double target);
  /// The most accurate, with its neighbours, of the few runs that promise most.
  std::optional<Judged> best_within(double frame_s);
  /// The run with the least error so far.
  std::optional<Judged> most_accurate();
  std::optional<Judged> judged(const Choice& choice);
  /// The least error of interpolation of those numbers of guides that leave hairs to
  /// follow, and the number.
  std::pair<std::size_t, Spread> best_interpolation();
  bool interrupted() const { return done_(); }

  /// All runs of the whole head, by choice.
  const std::map<Choice, std::optional<HeadTrial>>& runs() const { return runs_; }
  double error(const HeadTrial& trial) const { return value(trial.all, over_); }

 private:
  struct Candidate {
    Choice choice;
    double work, expected;  // error
  };
  const HeadTrial* run(const Choice& choice);
  const Spread& interpolation(std::size_t guides);
  std::vector<Candidate> candidates();
  double neighbours(const Choice& choice);
  bool meets(const Choice& choice, double target);
  Choice lowered(Choice choice, double target);

  const HeadMeasure& measure_;
  SearchPlan plan_;
  Over over_;
  std::function<bool()> done_;
  std::vector<std::size_t> guides_;
  std::map<std::size_t, Spread> interpolation_;
  std::map<std::pair<int, int>, double> simulated_;
  std::map<Choice, std::optional<HeadTrial>> runs_;
};

}  // namespace tress::experiments::head_accuracy
