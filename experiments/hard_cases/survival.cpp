#include "experiments/hard_cases/survival.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "contract/input_error.h"
#include "experiments/hard_cases/course.h"
#include "experiments/numerics/tip_track.h"
#include "experiments/problems/formulations.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr std::string_view names[] = {"refused", "not finished", "unstable", "stable",
                                      "stable and accurate"};
// Of order 2; no step of the table resolves what it damps at the reference's steps.
constexpr std::string_view reference_integrator = "bdf2";
// A reference is valid if it is this much better than what it judges.
constexpr double reference_margin = 5;

std::string text(double x) {
  std::ostringstream out;
  out.precision(3);
  out << x;
  return out.str();
}

/// Why no formulation is supported: the reason for the most usual one.
std::string objection(const IntegratorEntry& entry, System& system) {
  std::string reason = refusal(entry, system,
                               system.layout().constraints > 0 ? Formulation::projection
                                                               : Formulation::parametric);
  return reason.empty() ? "no error control with exact contact" : reason;
}

/// The reference's tips at one step; empty, with `why`, if there is none.
std::vector<double> tips_at(const HardCase& hard, const Subject& subject,
                            const Parameters& defaults, const Options& options, double dt,
                            const WorkLimit& limit, std::string& why) {
  Situation s = situation(hard, subject, defaults);
  Course c{Pace{dt}.applied(options), {hard.horizon}, 1.5};
  const IntegratorEntry& entry = find_integrator(reference_integrator);
  const auto formulation = preferred_formulation(entry, *s.system);
  if (!formulation) {
    why = objection(entry, *s.system);
    return {};
  }
  c.options.formulation = *formulation;
  Watched run = watch(reference_integrator, hard, subject, s, c, limit,
                      [](double, In, In) { return true; });
  if (run.end.status == Status::ok) return std::move(run.tips);
  why = run.cut ? cut_at(run.end.t) : run.end.failure;
  return {};
}

/// As `subject`, but the rod of super_helix of `elements`.
Subject rod() { return {&find_model("super_helix"), {}, ""}; }

}  // namespace

std::string_view name(Outcome outcome) { return names[static_cast<int>(outcome)]; }

void set_survival(const Survival& s, Row& row) {
  row.set("wall_s", s.wall_s);
  row.set("outcome", name(s.outcome)).set("passed", passed(s.outcome));
  if (!s.why.empty()) row.set("why", s.why);
  if (!s.formulation.empty()) row.set("formulation", s.formulation);
  if (s.measure) row.set("measure", *s.measure);
  if (s.error) row.set("error_rel", *s.error);
  if (s.gap) row.set("reference_gap", *s.gap);
  if (s.outcome != Outcome::refused) {
    row.set("t_s", s.t).set("steps", s.stats.steps);
    row.set("newton_iterations", s.stats.newton_iterations);
    if (s.stats.replaced > 0) row.set("replaced_steps", s.stats.replaced);
  }
  if (!passed(s.outcome)) row.failed(name(s.outcome), s.why);
}

std::string cut_at(double t) { return "its work was done at t = " + text(t) + " s"; }

Outcome outcome_of(std::string_view word, const std::string& where) {
  const auto found = std::ranges::find(names, word);
  if (found == std::end(names)) {
    throw InputError("no outcome is called '" + std::string(word) + "'", where,
                     "write refused, not finished, unstable, stable or stable and "
                     "accurate");
  }
  return static_cast<Outcome>(found - std::begin(names));
}

Reference reference(const HardCase& hard, const Subject& subject,
                    const Parameters& defaults, const Options& options, double coarser,
                    const WorkLimit& limit) {
  HardCase finer = hard;
  finer.impulses.reset();
  Subject whose = subject;
  Parameters parameters = defaults;
  if (hard.rod_elements > 0) {
    whose = rod();
    parameters = Parameters(setup_parameters(*whose.model), "reference");
    finer.settings.emplace_back("elements", std::to_string(hard.rod_elements));
  }
  Reference found;
  const double dt = coarser * hard.reference_step;
  const auto at = [&](double step) {
    return tips_at(finer, whose, parameters, options, step, limit, found.why);
  };
  const std::vector<double> coarse = at(2 * dt);
  if (!coarse.empty()) found.tip = at(dt);
  if (found.why.empty()) {
    const Situation s = situation(hard, subject, defaults);
    found.gap = tip_error(coarse, found.tip,
                          hard.error_scale != nullptr ? hard.error_scale(s) : s.length);
    if (!(found.gap <= largest_error / reference_margin)) {
      found.why = "its own error is " + text(found.gap);
    }
  }
  if (!found.why.empty()) {
    found.why = "no reference by bdf2 at " + text(dt) + " s: " + found.why;
  }
  return found;
}

Survival survive(const Attempt& attempt, const WorkLimit& limit,
                 const std::function<Reference()>& find) {
  const HardCase& hard = *attempt.hard;
  const IntegratorEntry& entry = find_integrator(attempt.integrator);
  Survival result;
  std::optional<Situation> made;
  try {
    if (!hard.not_for_strands.empty() && attempt.subject.model->on_strand != nullptr) {
      result.why = hard.not_for_strands;
      return result;
    }
    made.emplace(situation(hard, attempt.subject, attempt.defaults));
  } catch (const InputError& error) {
    result.why = error.what();
    return result;
  }
  Situation& s = *made;
  const auto formulation =
      preferred_formulation(entry, *s.system, attempt.pace.tolerance);
  if (!formulation) {
    result.why = objection(entry, *s.system);
    return result;
  }
  Course c = course(attempt);
  c.options.formulation = *formulation;
  if (s.system->layout().constraints > 0) result.formulation = name(*formulation);

  const StabilityBounds bounds = hard.bounds(s, c.stops.back());
  StabilityJudge judge(*s.system, bounds, s.start);
  const std::unique_ptr<Gauge> gauge = hard.gauge != nullptr ? hard.gauge(s) : nullptr;
  const auto began = std::chrono::steady_clock::now();
  Watched run;
  try {
    run = watch(attempt.integrator, hard, attempt.subject, s, c, limit,
                [&](double t, In q, In v) {
                  if (gauge) gauge->see(t, q, v);
                  return judge(t, q, v);
                });
  } catch (const InputError& error) {
    result.why = error.what();
    return result;
  }
  result.wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();

  const StabilityRun verdict = judge.verdict(run.end);
  result.t = run.end.t;
  result.stats = run.end.stats;
  const auto part = [](double value, double bound) {
    return bound < StabilityBounds::none ? value / bound : 0;
  };
  result.measure = gauge ? gauge->measure()
                         : std::max({part(verdict.energy_gain, bounds.energy),
                                     part(verdict.reach, bounds.reach),
                                     part(verdict.speed, bounds.speed)});
  if (run.cut) {
    result.outcome = Outcome::not_finished;
    result.why = cut_at(run.end.t);
    return result;
  }
  result.outcome = Outcome::unstable;
  if (!verdict.stable()) {
    result.why = std::string(name(verdict.broken)) + " at t = " + text(run.end.t) + " s" +
                 (verdict.failure.empty() ? "" : ": " + verdict.failure);
    return result;
  }
  if (!(*result.measure <= hard.limit)) {
    result.why = std::string(hard.measure) + " = " + text(*result.measure) + " > " +
                 text(hard.limit);
    return result;
  }
  result.outcome = Outcome::stable;
  if (gauge) result.error = gauge->error();
  if (hard.horizon > 0) {
    const Reference exact = find();
    if (!exact.why.empty()) {
      result.why = exact.why;
      return result;
    }
    result.gap = exact.gap;
    result.error =
        tip_error(run.tips, exact.tip,
                  hard.error_scale != nullptr ? hard.error_scale(s) : s.length);
  }
  if (!result.error) {
    result.why = "nothing to compare with";
  } else if (*result.error <= largest_error) {
    result.outcome = Outcome::accurate;
  } else {
    result.why = "error " + text(*result.error) + " > " + text(largest_error);
  }
  return result;
}

}  // namespace tress::experiments::hard_cases
