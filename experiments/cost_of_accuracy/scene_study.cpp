#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "contract/input_error.h"
#include "experiments/cost_of_accuracy/cost_of_accuracy.h"
#include "experiments/cost_of_accuracy/finalists.h"
#include "experiments/cost_of_accuracy/search.h"
#include "experiments/cost_of_accuracy/study_rows.h"
#include "experiments/run/progress.h"
#include "simulation/scene/scene_tables.h"

namespace tress::experiments::cost_of_accuracy {
namespace {

/// Factor by which load on the machine may lengthen a run: its processor time.
constexpr double slow_run = 1.15;

/// No shorter run is ended because it takes longer than others (s): a busy machine would
/// decide.
constexpr double never_ended_s = 0.05;

/// A stage of a search ends when this multiple of its work is done, or this part of the
/// time is over.
struct Share {
  double work, time;
};
/// One run of every method, in a search that is short of time.
constexpr Share probe_share{0.6, 0.25};
/// Climbing; the rest of the work refines the best runs, which on the ladders cost up to
/// `ladder_slack` times what they come to.
constexpr Share coarse_share{0.6, 0.5};
constexpr Share refine_share{1, 0.6};
/// The sweep over runs that are cheaper than the best.
constexpr Share sweep_share{3, 0.7};
/// Replacing each choice of the winners.
constexpr Share last_share{4, 0.8};
/// Part of the time of a search that the run of the file as given has, even where the
/// search has used all of it.
constexpr double given_share = 0.1;

/// Counts the work of a search. The time until the deadline matters only in an emergency;
/// each stage leaves some of it to later ones.
class Work {
 public:
  Work(const Study& study, const Deadline& deadline)
      : most_(study.plan.search_work),
        steps_(static_cast<double>(study.comparison.frames * study.comparison.strands)),
        deadline_(deadline),
        time_s_(deadline.remaining_s()) {}

  double done() const { return done_; }
  void add(const Method& method, int elements, int substeps) {
    done_ += steps_ * frame_work(method, elements, substeps);
  }
  /// True when this share of the work is done, or of the time is over.
  std::function<bool()> until(const Share& share) {
    return [this, share] {
      if (done_ >= share.work * most_) return true;
      cut_by_clock_ = cut_by_clock_ || late(share);
      return late(share);
    };
  }
  bool late(const Share& share) const {
    return deadline_.remaining_s() < (1 - share.time) * time_s_;
  }
  /// Whether the clock ended a stage.
  bool cut_by_clock() const { return cut_by_clock_; }

 private:
  double most_, steps_, done_ = 0;
  const Deadline& deadline_;
  double time_s_;
  bool cut_by_clock_ = false;
};

/// Tells a heartbeat how far a search is, and the best run so far.
class SearchProgress {
 public:
  SearchProgress(const Study& study, double target, Heartbeat& heartbeat)
      : study_(study), target_(target), heartbeat_(heartbeat) {}

  void say(const Search& search) {
    const Clock::time_point now = Clock::now();
    if (now - last_ < between) return;
    last_ = now;
    const Trial* best = cheapest(search.runs(), target_);
    if (best == nullptr) best = most_accurate(search.runs(), never, 0);
    if (best == nullptr) return;
    heartbeat_.doing(
        fmt::format("{} runs, best so far {}", search.runs().size(),
                    configuration_and_price(row_of(study_, "winner", *best))));
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds between{1};

  const Study& study_;
  double target_;
  Heartbeat& heartbeat_;
  Clock::time_point last_ = Clock::now();
};

/// The first method with the model and integrator of this one that chooses the accuracy
/// of a run in the same way: they differ in options.
std::size_t kind_of(const std::vector<Method>& methods, std::size_t index) {
  const Method& own = methods[index];
  const auto first = std::ranges::find_if(methods, [&own](const Method& other) {
    return other.model == own.model && other.integrator == own.integrator &&
           other.by_tolerance == own.by_tolerance &&
           other.extrapolated == own.extrapolated;
  });
  return static_cast<std::size_t>(first - methods.begin());
}

SearchPlan::Orders orders_of(const Method& method) {
  const int time =
      find_integrator(method.integrator).order(method.formulation).value_or(1);
  return {.space = static_cast<double>(method.model->order),
          .time = static_cast<double>(std::max(1, time))};
}

/// Repeats all answers until none changes: a replaced choice of a winner must not turn
/// out cheaper than the winner. Every round but the last tries or times a new run, so
/// there are few.
void settle(const Study& study, Finalists& finalists, const std::vector<double>& targets,
            const Deadline& deadline) {
  std::size_t before = 0;
  while (finalists.known() != before && !deadline.passed()) {
    before = finalists.known();
    for (const double target : targets) {
      static_cast<void>(finalists.of(target, !study.plan.advise));
      for (const std::string& id : study.plan.control) {
        static_cast<void>(finalists.control(find_model(id), target));
      }
    }
    if (study.plan.advise) continue;
    static_cast<void>(finalists.front(study.floor(), study.plan.targets.front()));
  }
}

/// The row that is advised: its file is run as it is written. An answer for a part of the
/// scene is none for the whole, and a run that misses the target is none.
void conclude(const Study& study, std::vector<Row>& rows) {
  put_better_first(rows);
  mark_unanswered(rows);
  const Row* best = advised(rows);
  if (best == nullptr) return;
  Row& row = rows[static_cast<std::size_t>(best - rows.data())];
  if (!row.ok() || !confirm(study, row) || !study.cut()) return;
  row.failed("valid_in_part",
             fmt::format("the references agree for the first {:.3g} s of {:.3g} s only",
                         row.number("horizon_s"), row.number("asked_s")));
}

/// Elements and substeps of the exhaustive search, half an octave apart.
constexpr int every_substep[] = {1, 2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64};

/// Tries every method with all elements of the ladder and every_substep. By target, the
/// time of the search's winner over that of the cheapest that then is known.
std::map<double, double> exhaust(const Study& study, Search& search, Finalists& finalists,
                                 const std::vector<double>& targets,
                                 const Deadline& deadline) {
  std::map<double, double> before, gains;
  for (const double target : targets) {
    if (const auto best = finalists.of(target, false))
      before[target] = best->winner.wall_s;
  }
  for (std::size_t method = 0; method < study.methods.size(); ++method) {
    for (const int elements : study.plan.elements) {
      for (const int substeps : every_substep) {
        search.run(method, elements, substeps * search.unit(method));
      }
    }
  }
  settle(study, finalists, targets, deadline);
  for (const auto& [target, wall_s] : before) {
    gains[target] = wall_s / finalists.of(target, false)->winner.wall_s;
  }
  return gains;
}

std::vector<Row> all_rows(Study& study, const Deadline& deadline, Heartbeat& heartbeat) {
  const StudyPlan& plan = study.plan;
  const SceneMeasure measure = measure_of(study);
  SearchPlan search_plan{
      .targets = {},
      .elements = plan.elements,
      .substeps = plan.substeps,
      .longest_run = plan.longest_run,
      .unit = [&study](std::size_t method) { return steps_unit(study.methods[method]); },
      .orders = [&study](std::size_t method) { return orders_of(study.methods[method]); },
      .kind = [&study](std::size_t method) { return kind_of(study.methods, method); },
      .slack = 0,
      .element_unit = study.element_unit};
  for (const double target : plan.targets) {
    if (target >= study.floor()) search_plan.targets.push_back(target - study.gap());
  }
  search_plan.slack = ladder_slack(search_plan, slow_run);
  std::vector<Row> rows;
  if (search_plan.targets.empty()) {
    Row row = begin(study, "winner");
    rows.push_back(
        row.failed("below_reference", below_reference(study, plan.targets.front())));
    if (plan.advise) conclude(study, rows);
    return rows;
  }
  const double time_s = deadline.remaining_s();
  bool bounded = true;  // runs, by the time of the best
  Work work(study, deadline);
  SearchProgress progress(study, search_plan.targets.back(), heartbeat);
  heartbeat.doing("searching");
  Search search(
      search_plan, study.methods.size(),
      [&](std::size_t method, int elements, int substeps) {
        progress.say(search);
        work.add(study.methods[method], elements, substeps);
        const Trial* best =
            bounded ? cheapest(search.runs(), search_plan.targets.back()) : nullptr;
        const double most_own_s =
            best == nullptr ? never
                            : std::max(never_ended_s, search_plan.slack * best->wall_s);
        auto run = measure.quick(study.methods[method], elements, substeps,
                                 deadline.remaining_s(), most_own_s);
        if (run) run->method = method;
        return run;
      },
      [&](const Trial& run, Neighbour change) {
        work.add(study.methods[run.method], run.elements, run.substeps);
        return measure.neighbour_error(study.methods[run.method], run.elements,
                                       run.substeps, change, deadline.remaining_s());
      },
      work.until(coarse_share));
  search.coarse(work.until(probe_share));
  search.go_on(work.until(refine_share));
  search.refine();
  search.go_on(work.until(sweep_share));
  search.sweep();
  const bool whole = !search.cut() && search.tried() == study.methods.size();
  std::string how = fmt::format("{}: {} of {} methods searched", whole ? "whole" : "cut",
                                search.tried(), study.methods.size());
  search.go_on(work.until(last_share));
  bounded = false;  // what replaces a winner's choice may take longer
  Finalists finalists(search, study.given, study.methods, [&](const Trial& run) {
    // Once the clock has ended the search, the time of the one run that there is must do.
    if (work.late(last_share)) return WallTime{run.wall_s, slow_run - 1};
    return measure.time(study.methods[run.method], run.elements, run.substeps,
                        plan.repeat);
  });
  heartbeat.doing("timing the best runs again");
  settle(study, finalists, search_plan.targets, deadline);
  std::map<double, double> gains;
  if (plan.exhaustive) {
    search.go_on([&] { return deadline.passed(); });
    gains = exhaust(study, search, finalists, search_plan.targets, deadline);
  }
  for (const double target : plan.targets) {
    const std::size_t winner = rows.size();
    add_target(study, finalists, target, rows);
    const auto gain = gains.find(target - study.gap());
    if (gain != gains.end()) rows[winner].set("exhaustive_gain", gain->second);
    add_control(study, finalists, target, rows);
  }
  add_budget(study, finalists, rows);
  if (!plan.advise) {
    for (const Trial& run : finalists.front(study.floor(), plan.targets.front())) {
      rows.push_back(row_of(study, "front", run));
      rows.back().set("time_scatter", finalists.scatter(run));
    }
  }
  add_given(study,
            plan.advise ? std::max(deadline.remaining_s(), given_share * time_s) : never,
            rows);
  if (plan.advise) add_left_out(study, rows);
  if (search.cut()) how += ", cut while the best runs were compared";
  if (work.cut_by_clock()) how += ", by the clock";
  for (Row& row : rows) {
    row.set("runs", search.runs().size()).set("passed_over", search.passed_over());
    row.set("work", 1e-6 * work.done()).set("search", how);
  }
  if (plan.advise) conclude(study, rows);
  return rows;
}

}  // namespace

std::vector<Row> study_scene(const std::string& file, const StudyPlan& plan,
                             const Row& identity, const Deadline& of_row) {
  const bool own = plan.advise && plan.answer_s > 0;
  const Deadline deadline(own ? std::min(plan.answer_s, of_row.remaining_s())
                              : of_row.remaining_s());
  Heartbeat heartbeat(plan.report ? ProgressMode::automatic : ProgressMode::none,
                      identity.text("scene"));
  std::optional<Study> study;
  try {
    study.emplace(ready(file, plan, identity, deadline, heartbeat));
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& failure) {
    Row row = identity;
    return {row.failed("no_reference", failure.what())};
  }
  return all_rows(*study, deadline, heartbeat);
}

}  // namespace tress::experiments::cost_of_accuracy
