// Runs by tolerance, rod by rod and model by model: is there a solution, is its error
// in time what was asked for, and what would the best fixed step have cost? All runs of a
// row have the same elements, so that no error is one of space.
//
// Control of errors holds those of steps. What they grow to is the motion's affair: where
// an error is larger than was asked for, the growth of a deviation is measured. A motion
// is called sensitive if its deviation grows by more than that of a free body; within the
// tolerance times the growth, the run is as good as one of a rod that deviates by the
// tolerance, and no control of steps knows better.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/family/family.h"
#include "experiments/family/horizon.h"
#include "experiments/numerics/tip_track.h"

namespace tress::experiments::family {
namespace {

constexpr Claim claims[] = {
    {"tolerance_met", "the error of an adaptive run stays within the tolerance",
     "tip error in time over the length; 1: no solution"},
    {"tolerance_cheaper_at_error",
     "an adaptive run needs no more work than the best fixed step that is as accurate",
     "work of the best fixed step as accurate over that of the adaptive run; 0.2: or "
     "only a fixed step is a solution, 5: no fixed step is as accurate"},
    {"tolerance_cheaper_as_asked",
     "an adaptive run needs no more work than the best fixed step within the "
     "tolerance",
     "work of the best fixed step within the tolerance over that of the adaptive "
     "run; 0.2: or only a fixed step is within it, 5: only the adaptive run"}};

// Models with a material frame. mass_spring and inextensible_strand have none: a section
// that is not round and twist at rest mean nothing to them.
constexpr std::string_view models[] = {"super_helix",
                                       "articulated_chain",
                                       "der",
                                       "force_transport",
                                       "corde",
                                       "xpbd_cosserat",
                                       "dynamic_spline",
                                       "kirchhoff_nodal"};
constexpr std::array by_tolerance{"tr_bdf2", "esdirk43"};
// The best first: what costs more than the best so far is not finished.
constexpr std::array by_step{"linearly_implicit_midpoint", "implicit_midpoint", "bdf2"};
constexpr std::string_view reference_method = "esdirk43";       // of the higher order
constexpr std::string_view other_method = "implicit_midpoint";  // keeps energy best
constexpr std::string_view second_method = "tr_bdf2";  // by tolerance, of other formulas

constexpr double t_end = 0.4;  // s
constexpr int samples = 24;
constexpr double coarsest = 1 / 60.0;  // s, of the fixed steps, which halve
constexpr double no_solution = 1;      // value of the error
constexpr double finer = 100;          // tolerance of a run over that of its reference
constexpr double reference_calls = 5;  // times those of a run: 100^(1/4) = 3 in steps
// The best fixed step is sought for runs of so many calls of the model. Beyond, the
// search would take hours, and a run is only asked for its error.
constexpr double compared_calls = 4e5;
constexpr double newton_part = 1e-2;  // of the tolerance: it is not seen
constexpr double trusted = 10;  // an error over what it is uncertain by, at a horizon
// A run that is within the tolerance on less than this share of its time has not met it.
constexpr double least_share = 0.5;
constexpr double calls_of_step = 16;  // of other_method at short steps, at most
constexpr double most = 5;            // times the work; no ratio is beyond
constexpr int repeats = 3;

/// One model of one hair.
struct Subject {
  const Rod& rod;
  std::string_view model;
  double tolerance;
  double most_calls;
  int elements = elements_of(rod);

  std::unique_ptr<System> system() const { return make_system(rod, model, elements); }
};

double work_of_call(const System& system) { return system.layout().coordinates + 10; }

Options options_of(System& system, double max_work) {
  Options options;
  options.max_work = max_work;
  // Multipliers there are those of a spline's clamp.
  if (system.layout().constraints > 0) options.formulation = Formulation::projection;
  return options;
}

TipRun run_by_tolerance(const Subject& subject, std::string_view integrator,
                        double tolerance, double most_calls, int repeat) {
  const auto system = subject.system();
  Guard guard = make_guard(subject.rod, subject.model, subject.elements, *system);
  Options options = options_of(*system, most_calls * work_of_call(*system));
  options.tolerance = tolerance;
  return run_tip(integrator, *system, options, t_end, samples, repeat, &guard);
}

TipRun run_by_step(const Subject& subject, std::string_view integrator, double dt,
                   double max_work, int repeat) {
  const auto system = subject.system();
  Options options = options_of(*system, max_work);
  options.step = dt;
  options.newton_tolerance = newton_part * subject.tolerance;
  options.refresh = Refresh::when_slow;
  return run_tip(integrator, *system, options, t_end, samples, repeat);
}

double calls_of_reference(const Subject& subject) {
  return reference_calls * std::min(subject.most_calls, compared_calls);
}

/// The longest fixed step of the ladder with which the calls allowed to the reference
/// of a compared run do not suffice for more than t_end.
double finest_step(const Subject& subject) {
  const double steps = calls_of_reference(subject) / calls_of_step;
  double dt = coarsest;
  while (t_end / dt < steps / 2) dt /= 2;
  return dt;
}

/// Returns the horizon where no run comes to the end, no two agree there, or the search
/// for a step would take too long. It ends where the reference and a method of another
/// family no longer agree within a tenth of the tolerance, or their calls are used up.
Horizon horizon_of(const Subject& subject) {
  const auto one = subject.system(), other = subject.system();
  const double most_work = reference_calls * subject.most_calls * work_of_call(*one);
  Options by_error = options_of(*one, most_work), stepping = by_error;
  by_error.tolerance = subject.tolerance / finer;
  stepping.step = finest_step(subject);
  stepping.newton_tolerance = newton_part * subject.tolerance;
  stepping.refresh = Refresh::when_slow;
  return horizon({*one, reference_method, by_error}, {*other, other_method, stepping},
                 t_end, samples, subject.rod.length, subject.tolerance / trusted);
}

double work_of(const TipRun& run) { return total_work(run.stats, run.unknowns); }

/// An adaptive run with its error in time.
struct Outcome {
  TipRun run;
  double error = std::numeric_limits<double>::infinity();

  bool solved() const { return run.status == Status::ok; }
};

struct Rung {
  std::string_view integrator;
  double dt, error, work;
};

/// Tries every method's steps, halved until one is as accurate as the best outcome and as
/// the target. Halving also ends when one is as expensive as another that meets these, or
/// `most` times as expensive as the cheapest outcome.
std::vector<Rung> ladder(const Subject& subject, const std::vector<Outcome>& outcomes,
                         In reference) {
  double least_error = subject.tolerance;
  double most_work = std::numeric_limits<double>::infinity();
  for (const Outcome& outcome : outcomes) {
    if (!outcome.solved()) continue;
    least_error = std::min(least_error, outcome.error);
    most_work = std::min(most_work, most * work_of(outcome.run));
  }
  std::vector<Rung> all;
  for (const std::string_view integrator : by_step) {
    for (double dt = coarsest;; dt /= 2) {
      const TipRun run = run_by_step(subject, integrator, dt, most_work, 0);
      const double error = tip_error(run.tip, reference, subject.rod.length);
      all.push_back({integrator, dt, error, work_of(run)});
      if (error <= least_error) most_work = std::min(most_work, work_of(run));
      if (work_of(run) >= most_work) break;
    }
  }
  return all;
}

const Rung* cheapest(const std::vector<Rung>& rungs, double error) {
  const Rung* best = nullptr;
  for (const Rung& rung : rungs) {
    if (rung.error > error || (best != nullptr && rung.work >= best->work)) continue;
    best = &rung;
  }
  return best;
}

Row described(Row row, std::string_view integrator, const Outcome& outcome) {
  const Stats& done = outcome.run.stats;
  row.set("integrator", integrator).set("steps", done.steps);
  row.set("rejected", done.rejected).set("work", work_of(outcome.run));
  if (outcome.solved()) return row.set("wall_s", outcome.run.wall_s);
  return row.set("failure", outcome.run.failure);
}

Row compared(const Subject& subject, Row row, const Claim& claim, const Outcome& outcome,
             const std::vector<Rung>& rungs, double error) {
  const Rung* step = cheapest(rungs, error);
  const bool met = outcome.solved() && outcome.error <= error;
  if (step == nullptr) {
    if (met) return answer(row, claim, most, true);
    return no_answer(row, claim, "not_met", "neither way is within the tolerance");
  }
  const double wall = run_by_step(subject, step->integrator, step->dt, 0, repeats).wall_s;
  row.set("fixed_integrator", step->integrator).set("fixed_dt_s", step->dt);
  row.set("fixed_work", step->work).set("fixed_wall_s", wall);
  if (!met) return answer(row, claim, 1 / most, false);
  const double ratio = std::clamp(step->work / work_of(outcome.run), 1 / most, most);
  return answer(row, claim, ratio, ratio >= 1);
}

double calls_of(const TipRun& run) { return work_of(run) / (run.unknowns + 10.0); }

/// Whether steps are sought that are as good.
bool compares(const Outcome& outcome) {
  return outcome.solved() && calls_of(outcome.run) <= compared_calls;
}

std::vector<Outcome> outcomes_of(const Subject& subject) {
  std::vector<Outcome> all;
  all.reserve(std::size(by_tolerance));
  for (const std::string_view integrator : by_tolerance) {
    const auto made = [&](int repeat) {
      return run_by_tolerance(subject, integrator, subject.tolerance, subject.most_calls,
                              repeat);
    };
    Outcome outcome{made(0)};
    if (compares(outcome)) outcome.run = made(repeats);
    all.push_back(std::move(outcome));
  }
  return all;
}

/// Empty without a run to compare.
std::optional<std::vector<double>> reference_of(const Subject& subject,
                                                const std::vector<Outcome>& outcomes) {
  if (std::ranges::none_of(outcomes, compares)) return {};
  TipRun run = run_by_tolerance(subject, reference_method, subject.tolerance / finer,
                                calls_of_reference(subject), 0);
  if (run.status != Status::ok) return {};
  return std::move(run.tip);
}

/// Distance of the reference from a run of the same tolerance by another method: where no
/// fixed step is short enough.
double gap_of_second(const Subject& subject, In reference) {
  const TipRun run = run_by_tolerance(subject, second_method, subject.tolerance / finer,
                                      calls_of_reference(subject), 0);
  return tip_error(run.tip, reference, subject.rod.length);
}

void measure(const Subject& subject, In reference, std::vector<Outcome>& outcomes) {
  for (Outcome& outcome : outcomes) {
    if (!outcome.solved()) continue;
    outcome.error = tip_error(outcome.run.tip, reference, subject.rod.length);
  }
}

/// Rows of a subject without a reference: that a run has no solution is certain
/// nevertheless.
std::vector<Row> unconfirmed(const Row& row, const std::vector<Outcome>& outcomes) {
  constexpr std::string_view reason = "no two methods agree at all";
  std::vector<Row> rows;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Row one = described(row, by_tolerance[i], outcomes[i]);
    rows.push_back(outcomes[i].solved()
                       ? no_answer(one, claims[0], "no_reference", reason)
                       : answer(one, claims[0], no_solution, false));
    rows.push_back(no_answer(one, claims[1], "no_reference", reason));
    rows.push_back(no_answer(one, claims[2], "no_reference", reason));
  }
  return rows;
}

/// Of a hair whose error is beyond the tolerance, up to that many samples.
double growth_of(const Subject& subject, int until) {
  const auto system = subject.system();
  Options options =
      options_of(*system, reference_calls * subject.most_calls * work_of_call(*system));
  options.tolerance = subject.tolerance / finer;
  return growth({*system, reference_method, options}, t_end, samples, until,
                subject.tolerance / trusted);
}

/// Makes rows about errors up to that many samples.
class Judge {
 public:
  Judge(const Subject& subject, int until) : subject_(subject), until_(until) {}

  Row operator()(Row row, double error) {
    const double asked = subject_.tolerance;
    if (error <= asked) return within_tolerance(row, claims[0], error, until_, samples);
    if (error >= no_solution) return answer(row, claims[0], no_solution, false);
    if (!growth_) growth_ = growth_of(subject_, until_);
    row.set("growth", *growth_);
    const double last = TipSamples::time(t_end, until_, samples);
    const bool sensitive =
        *growth_ > free_growth(last, subject_.rod.length) && error <= *growth_ * asked;
    if (!sensitive) return answer(row, claims[0], error, false);
    return no_answer(row.set("value", error), claims[0], "sensitive",
                     "a deviation grows by more than that of a free body; the error is "
                     "within the tolerance times its growth");
  }

 private:
  const Subject& subject_;
  int until_;
  std::optional<double> growth_;
};

/// Returns the tips up to a horizon; empty if the run does not reach it or fails. Running
/// out of calls beyond the time where two methods part is no failure.
std::vector<double> tips_until(const Horizon& known, const TipRun& run) {
  const bool sound =
      run.status == Status::ok || (known.parted && run.limit == Limit::work);
  if (!sound || run.tip.size() < known.tip.size()) return {};
  return {run.tip.begin(),
          run.tip.begin() + static_cast<std::ptrdiff_t>(known.tip.size())};
}

/// Rows of a subject whose solution is known up to a horizon only, or by runs that are
/// not compared.
std::vector<Row> judged_until(const Subject& subject, const Horizon& known, Row row,
                              const std::vector<Outcome>& outcomes) {
  const double length = subject.rod.length;
  if (known.samples() < samples) {
    row.set("horizon_s", TipSamples::time(t_end, known.samples(), samples));
  }
  row.set("gap", tip_error(known.other, known.tip, length));
  Judge judge(subject, known.samples());
  std::vector<Row> rows;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Row one = described(row, by_tolerance[i], outcomes[i]);
    const auto tips = tips_until(known, outcomes[i].run);
    rows.push_back(
        judge(one, tips.empty() ? no_solution : tip_error(tips, known.tip, length)));
    for (const Claim& claim : {claims[1], claims[2]}) {
      rows.push_back(no_answer(one, claim, "no_reference",
                               "work is compared where the solution is known to the end "
                               "of the motion, and a run takes no more than 4e5 calls"));
    }
  }
  return rows;
}

std::vector<Row> judged(const Subject& subject, const Row& row,
                        const std::vector<Outcome>& outcomes,
                        const std::vector<Rung>& rungs) {
  Judge judge(subject, samples);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Outcome& outcome = outcomes[i];
    const Row one = described(row, by_tolerance[i], outcome);
    const bool solved = outcome.solved();
    const double asked = subject.tolerance;
    rows.push_back(judge(one, solved ? outcome.error : no_solution));
    rows.push_back(compared(subject, one, claims[1], outcome, rungs,
                            solved ? outcome.error : asked));
    rows.push_back(compared(subject, one, claims[2], outcome, rungs, asked));
  }
  return rows;
}

std::vector<Row> run(const Rod& rod, const Row& row) {
  const Subject subject{rod, row.text("model"), row.number("position_tol_rel"),
                        row.number("most_calls")};
  Row with = Row(row).set("elements", subject.elements);
  auto outcomes = outcomes_of(subject);
  if (const auto reference = reference_of(subject, outcomes)) {
    measure(subject, *reference, outcomes);
    const auto rungs = ladder(subject, outcomes, *reference);
    double gap = std::ranges::min(rungs, {}, &Rung::error).error;
    if (gap > subject.tolerance) gap = gap_of_second(subject, *reference);
    with.set("gap", gap);
    if (gap <= subject.tolerance) {
      return judged(subject, with, outcomes, rungs);
    }
  }
  const Horizon known = horizon_of(subject);
  if (known.samples() > 0) return judged_until(subject, known, with, outcomes);
  return unconfirmed(with, outcomes);
}

}  // namespace

Row within_tolerance(Row row, const Claim& claim, double error, int agreed, int all) {
  if (agreed >= least_share * all) return answer(row, claim, error, true);
  return no_answer(row.set("value", error), claim, "short_horizon",
                   "within the tolerance, but two methods agree on less than half of the "
                   "time");
}

const Study tolerance{"tolerance", claims, run, models, {16, 3}};

}  // namespace tress::experiments::family
