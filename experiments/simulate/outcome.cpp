#include "experiments/simulate/outcome.h"

#include <fmt/format.h>

#include <vector>

#include "simulation/files/csv.h"

namespace tress::experiments::scene_runs {
namespace {

constexpr Column columns_of_outcome[] = {
    {"scene", "name of the scene"},
    {"frames", "frames written"},
    {"simulated_s", "simulated time, of a failed run until the failure"},
    {"rejected_steps", "steps tried again with shorter ones"},
    {"steps",
     "accepted steps; this and the following columns: since the run began or was "
     "resumed"},
    {"rejected_by_error", "rejected steps with too large an error"},
    {"rejected_by_newton", "rejected steps in which Newton's method found no solution"},
    {"smallest_step_s", "shortest step that error control chose"},
    {"smallest_step_at_s", "time of the shortest step"},
    {"smallest_step_cause", "cause of the shortest step: start, error or newton"},
    {"exchanges",
     "intervals between exchanges of strands that touch, where error control "
     "chose them"},
    {"rejected_exchanges", "intervals that were too long"},
    {"residuals", "residual or acceleration evaluations"},
    {"linearizations", "matrices built and factored"},
    {"solves", "linear solves"},
    {"newton_iterations", "Newton iterations"},
    {"replaced_steps",
     "steps that are backward Euler steps, of guarded and guarded_esdirk43"},
    {"contact_iterations", "solutions of steps until the law of exact friction held"},
    {"contact_unfinished", "steps or stages that ended before the law held"},
    {"contact_violation_m_s", "largest speed by which these steps violate the law"},
    {"method_dissipated_j",
     "energy that the method dissipated (negative: created). Energy at the "
     "start, and the work of loads, root and friction, less the energy at the "
     "end. Work by the trapezoidal rule over every fourth step. Where it is empty, "
     "method_dissipated_missing has the reason"},
    {"method_dissipated_missing",
     "reason why no account of the method's dissipation is kept: no guard, SIMD lanes, "
     "impulses, strands that touch"},
    {"method_dissipated_bound_j",
     "estimated bound of the error of method_dissipated_j: the sum of the changes of "
     "power between two checks times the intervals. The run warns where "
     "method_dissipated_j exceeds it by a tenth of the energy of the motion"},
    {"method_dissipated_rel",
     "method_dissipated_j over the energy of the motion: the highest above the "
     "lowest potential, and the work put in"},
    {"energy_excess_j",
     "largest energy above the start and the work of the loads, of the strand that uses "
     "most of the guard's slack. Physics allows none: it is an error of the steps"},
    {"energy_excess_rel",
     "energy_excess_j over the slack, at which the guard ends the run"},
    {"not_smooth", "reason why the motion is not smooth, where forces jump"},
    {"pilot_elements",
     "[strand] tolerance_m: elements of these strands, by trials in motion; see "
     "pilot_missing"},
    {"pilot_elements_at_rest",
     "[strand] tolerance_m: elements of these strands for their shapes at rest"},
    {"pilot_error_rel",
     "estimated error in space over the tolerance: largest of a strand"},
    {"pilot_tries",
     "pairs of runs of the pilot, with a number of elements and with twice"},
    {"pilot_s", "time of these runs", true},
    {"pilot_missing", "reason why there was no pilot: elements are those at rest"},
    {"time_error_max_rel",
     "estimated error in time: largest of a point of the strand with the largest, over "
     "its length, at the frames before the two runs part"},
    {"time_error_rms_rel",
     "estimated error in time: root mean square over the strand's points"},
    {"time_error_bound_rel",
     "bound of time_error_max_rel that held in 90 % of the calibration runs: 6 single "
     "clamped hairs, 3 models, 5 methods (simulation/errors/error_bars.h)"},
    {"time_error_at_s", "time at which the error in time is largest"},
    {"time_error_strand",
     "strand with the largest error in time, where there are several"},
    {"time_error_median_rel", "median over strands of their largest errors in time"},
    {"time_horizon_s",
     "time when the first strand's two runs part: no estimate from there"},
    {"time_parted", "strands whose two runs part"},
    {"time_error_missing", "reason why there is no estimate of the error in time"},
    {"space_error_max_rel", "estimated error in space, as in time"},
    {"space_error_rms_rel",
     "estimated error in space: root mean square over the strand's points"},
    {"space_error_bound_rel", "bound of space_error_max_rel, as in time"},
    {"space_error_at_s", "time at which the error in space is largest"},
    {"space_error_strand", "strand with the largest error in space"},
    {"space_error_median_rel", "median over strands of their largest errors in space"},
    {"space_horizon_s", "time when the first strand's two runs part"},
    {"space_parted", "strands whose two runs part"},
    {"space_error_missing", "reason why there is no estimate of the error in space"},
    {"strands", "number of strands of a batch"},
    {"failed_strands",
     "strands whose step was impossible, of a batch or with failed_strands = stay"},
    {"precision", "floating-point precision of a batch in bits"},
    {"simd_width", "strands of a batch per SIMD pack"},
    {"engine",
     "engine of a batch: lanes, or replicated (each strand is a system of its "
     "own, as a single strand is)"},
    {"device", "device that took a batch's steps: cpu, or the name of a GPU"},
    {"ranks", "processes that shared a batch"},
    {"rank_strands", "largest number of strands of a rank"},
    {"peak_memory_mb", "largest memory of the whole program on a rank", true},
    {"ghosts_per_step",
     "ghosts of the rank with most: strands of other ranks that may touch its own"},
    {"sent_per_step",
     "strands sent to other ranks by the rank that sends most, once for each"},
    {"claims_per_step",
     "searches for ghosts over the steps since the strands were divided"},
    {"claim_s", "time per step to find ghosts, largest over ranks", true},
    {"exchange_s",
     "time per step to send and receive, waiting included, largest over ranks", true},
    {"meet_s", "time per step to list contacts with ghosts, largest over ranks", true},
    {"bytes_per_strand", "memory of a batch: state, rest shape, material, root"},
    {"state_hash",
     "checksum of all states of a batch at the end, the same for any number of "
     "ranks, threads and lanes"},
    {"build_s", "time to make the strands of a batch", true},
    {"step_s", "time to step the strands of a batch", true},
    {"read_s", "time to read and compress the frames and energies of a batch", true},
    {"write_s", "time to write frames and states of a batch", true},
    {"support_force_max_n",
     "largest force of a support on its strand, or of a joint, at a frame; without both "
     "empty"},
    {"wall_s", "wall time of the run, output included", true},
};

/// Elements of the strands of a pilot.
struct Totals {
  int elements = 0, at_rest = 0;
};

Totals totals_of(const Pilot& pilot) {
  Totals all;
  for (const Pilot::OfStrand& one : pilot.strands) {
    all.elements += one.elements;
    all.at_rest += one.at_rest;
  }
  return all;
}

std::string strands_in_words(const ErrorBar& bar) {
  if (bar.strands.size() == 1) return "";
  return fmt::format("; strand {} of {}, median {:.2g}", bar.worst(), bar.strands.size(),
                     bar.median());
}

bool replaces_steps(const Scene& scene) {
  return find_integrator(scene.integrator).replaces_steps;
}

double bound(std::string_view part) { return part == "time" ? time_bound : space_bound; }

void set_frame(std::string_view part, const ErrorBar& bar, std::size_t frame, Row& row) {
  if (frame >= bar.frames.size()) return;
  row.set(fmt::format("{}_error_max_rel", part), bar.frames[frame].largest);
  row.set(fmt::format("{}_error_rms_rel", part), bar.frames[frame].rms);
}

}  // namespace

std::span<const Column> outcome_columns() { return columns_of_outcome; }

Row outcome(const Scene& scene, const SceneRun& run) {
  Row row;
  row.set("scene", scene.name).set("frames", run.frames);
  row.set("simulated_s", run.simulated_s).set("rejected_steps", run.rejected);
  const Stats& work = run.work;
  row.set("steps", work.steps);
  if (scene.options.tolerance > 0) {
    row.set("rejected_by_error", work.rejected_by_error);
    row.set("rejected_by_newton", work.rejected_by_newton);
  }
  if (work.smallest_step > 0) {
    row.set("smallest_step_s", work.smallest_step);
    row.set("smallest_step_at_s", work.smallest_step_at);
    row.set("smallest_step_cause", work.smallest_step_cause);
  }
  if (run.exchanges.accepted + run.exchanges.rejected > 0) {
    row.set("exchanges", run.exchanges.accepted);
    row.set("rejected_exchanges", run.exchanges.rejected);
  }
  if (!run.head) {  // strands of a batch count their iterations alone
    row.set("residuals", work.residuals).set("linearizations", work.linearizations);
    row.set("solves", work.solves);
  }
  row.set("newton_iterations", work.newton_iterations);
  if (run.dissipation) {
    row.set("method_dissipated_j", run.dissipation->dissipated);
    row.set("method_dissipated_bound_j", run.dissipation->uncertain);
    row.set("method_dissipated_rel", run.dissipation->share());
  } else if (!run.no_dissipation.empty()) {
    row.set("method_dissipated_missing", run.no_dissipation);
  }
  if (run.excess.slack > 0) {
    row.set("energy_excess_j", run.excess.gained);
    row.set("energy_excess_rel", run.excess.share());
  }
  if (replaces_steps(scene)) row.set("replaced_steps", work.replaced);
  if (!run.not_smooth.empty()) row.set("not_smooth", run.not_smooth);
  if (work.contact_iterations > 0) {
    row.set("contact_iterations", work.contact_iterations);
    row.set("contact_unfinished", work.contact_unfinished);
    row.set("contact_violation_m_s", work.contact_violation);
  }
  if (run.head) {
    const HeadOutcome& head = *run.head;
    row.set("strands", head.strands).set("failed_strands", head.lost);
    row.set("precision", bits_of(head.pack));
    row.set("device", head.device).set("ranks", head.ranks);
    row.set("rank_strands", head.rank_strands);
    row.set("peak_memory_mb", head.peak_memory_mb);
    if (head.claims_per_step > 0) {
      row.set("ghosts_per_step", head.ghosts_per_step);
      row.set("sent_per_step", head.sent_per_step);
      row.set("claims_per_step", head.claims_per_step);
      row.set("claim_s", head.claim_s).set("exchange_s", head.exchange_s);
      row.set("meet_s", head.meet_s);
    }
    row.set("simd_width", head.pack.lanes).set("engine", head.engine);
    row.set("bytes_per_strand", head.bytes_per_strand);
    row.set("state_hash", head.state).set("build_s", head.build_s);
    row.set("step_s", head.step_s).set("read_s", head.read_s);
    row.set("write_s", head.write_s);
  }
  if (!run.head && scene.failed_strands == FailedStrands::stay) {
    row.set("failed_strands", run.lost);
  }
  if (!run.supports.empty()) row.set("support_force_max_n", run.support_force);
  row.set("wall_s", run.wall_s);
  if (run.end == SceneRun::End::failed) row.failed("diverged", run.reason);
  return row;
}

void set_errors(std::string_view part, const ErrorBar& bar, Row& row) {
  const auto column = [part](std::string_view name) {
    return fmt::format("{}_{}", part, name);
  };
  if (!bar.missing.empty()) {
    row.set(column("error_missing"), bar.missing);
    return;
  }
  const StrandError& worst = bar.strands[bar.worst()];
  row.set(column("error_max_rel"), worst.error.largest);
  row.set(column("error_rms_rel"), worst.error.rms);
  row.set(column("error_bound_rel"), bound(part) * worst.error.largest);
  row.set(column("error_at_s"), worst.largest_at);
  if (bar.strands.size() > 1) {
    row.set(column("error_strand"), bar.worst());
    row.set(column("error_median_rel"), bar.median());
    row.set(column("parted"), bar.parted());
  }
  if (worst.parts) row.set(column("horizon_s"), *worst.parts);
}

namespace {

std::string shortest_in_words(double h, double at, std::string_view cause) {
  if (h == 0) return {};
  return fmt::format(", the shortest {:.3g} s at {:.3g} s ({})", h, at, cause);
}

/// The counts of a run that was resumed begin there.
std::string_view since(const SceneRun& run) {
  return run.resumed ? " since the run was resumed" : "";
}

std::string replaced_in_words(const Scene& scene, const SceneRun& run) {
  if (!replaces_steps(scene)) return {};
  return fmt::format(
      "; {} of {} steps{} replaced by backward Euler (no solution, or energy gained)",
      run.work.replaced, run.work.steps, since(run));
}

std::string contact_in_words(const Stats& work) {
  if (work.contact_unfinished == 0) return {};
  return fmt::format(
      "; exact friction: {} stages of {} steps end before its law holds, by up to {:.2g} "
      "m/s",
      work.contact_unfinished, work.steps, work.contact_violation);
}

}  // namespace

std::string supports_in_words(const SceneRun& run) {
  std::string words;
  for (const NamedLoad& support : run.supports) {
    words += fmt::format("{}{}", words.empty() ? "" : ", ", support.name);
    const auto add = [&](const std::optional<Vec>& load, const char* unit) {
      if (!load) return;
      words +=
          fmt::format(" ({:.4g}, {:.4g}, {:.4g}) {}", load->x, load->y, load->z, unit);
    };
    add(support.force, "N");
    add(support.moment, "N m");
  }
  return words;
}

std::string control_in_words(const Scene& scene, const SceneRun& run) {
  const Stats& work = run.work;
  if (scene.options.tolerance == 0) {
    const std::string again =
        run.rejected == 0
            ? ""
            : fmt::format("; {} steps tried again with shorter ones", run.rejected);
    return again + replaced_in_words(scene, run) + contact_in_words(work);
  }
  std::string words = fmt::format(
      "; {} steps{}, {} rejected by their error and {} by Newton's iteration{}",
      work.steps, since(run), work.rejected_by_error, work.rejected_by_newton,
      shortest_in_words(work.smallest_step, work.smallest_step_at,
                        work.smallest_step_cause));
  words += contact_in_words(work);
  const Exchanges& exchanges = run.exchanges;
  if (exchanges.accepted + exchanges.rejected == 0) return words;
  return words +
         fmt::format("; {} exchanges between strands, {} rejected{}", exchanges.accepted,
                     exchanges.rejected,
                     shortest_in_words(exchanges.shortest.h, exchanges.shortest.at,
                                       exchanges.shortest.cause));
}

std::string pictures_in_words(const SceneRun& run) {
  if (!run.head) return {};
  const HeadOutcome& head = *run.head;
  if (head.shown_strands == head.strands && head.shown_frames == run.frames) return {};
  return fmt::format("; pictures show {} of {} strand{} and {} of {} frames",
                     head.shown_strands, head.strands, head.strands == 1 ? "" : "s",
                     head.shown_frames, run.frames);
}

std::string in_words(std::string_view part, const ErrorBar& bar, const Scene& scene) {
  if (!bar.missing.empty()) return fmt::format("no {} error: {}", part, bar.missing);
  const StrandError& worst = bar.strands[bar.worst()];
  std::string words = fmt::format(
      "{} error {:.2g} of the length at {:.3g} s, root mean square {:.2g} "
      "(estimates; bound with 90 % coverage, by {}: {:.2g})",
      part, worst.error.largest, worst.largest_at, worst.error.rms,
      part == "time" ? time_population : space_population,
      bound(part) * worst.error.largest);
  words += strands_in_words(bar);
  if (worst.parts) {
    words += fmt::format(
        "; until {:.3g} s, from where the run and a finer one are different motions",
        *worst.parts);
    if (bar.strands.size() > 1) words += fmt::format(" ({} strands)", bar.parted());
  }
  if (part == "time" && scene.options.tolerance > 0) {
    words += fmt::format("; requested tolerance {:g}", scene.options.tolerance);
  }
  return words;
}

void set_pilot(const Pilot& pilot, Row& row) {
  if (!pilot.missing.empty()) {
    row.set("pilot_missing", pilot.missing);
    return;
  }
  const Totals totals = totals_of(pilot);
  row.set("pilot_elements", totals.elements);
  row.set("pilot_elements_at_rest", totals.at_rest);
  row.set("pilot_error_rel", pilot.worst().error / pilot.worst().tolerance);
  row.set("pilot_tries", pilot.tries).set("pilot_s", pilot.wall_s);
}

std::string in_words(const Pilot& pilot) {
  if (!pilot.missing.empty()) {
    return fmt::format("no pilot, elements are those that shapes at rest ask for: {}",
                       pilot.missing);
  }
  const Totals totals = totals_of(pilot);
  const Pilot::OfStrand& worst = pilot.worst();
  std::string words = fmt::format(
      "pilot: {} elements ({} at rest), estimated error in space {:.2g} m, "
      "tolerance {:g} m; {} tries in {:.3g} s",
      totals.elements, totals.at_rest, worst.error, worst.tolerance, pilot.tries,
      pilot.wall_s);
  if (pilot.strands.size() > 1) {
    words += fmt::format("; strand {} of {}", worst.strand, pilot.strands.size());
  }
  if (worst.error > worst.tolerance) {
    words += "; not within the tolerance: `elements` of its table allows no more";
  }
  return words;
}

std::string errors_csv(const Scene& scene, const ErrorBar& time, const ErrorBar& space) {
  const std::vector<std::string> header{"t_s", "time_error_max_rel", "time_error_rms_rel",
                                        "space_error_max_rel", "space_error_rms_rel"};
  std::string text = csv_line(header);
  for (std::size_t frame = 0; frame <= scene.last_frame(); ++frame) {
    Row row;
    row.set("t_s", scene.time_of(frame));
    set_frame("time", time, frame, row);
    set_frame("space", space, frame, row);
    text += csv_line(in_order(row, header));
  }
  return text;
}

}  // namespace tress::experiments::scene_runs
