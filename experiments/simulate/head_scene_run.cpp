#include "experiments/simulate/head_scene_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "contract/input_error.h"
#include "experiments/run/machine.h"
#include "experiments/run/message.h"
#include "experiments/simulate/failed_strands.h"
#include "experiments/simulate/head_pictures.h"
#include "experiments/simulate/head_reading.h"
#include "experiments/simulate/head_recording.h"
#include "experiments/simulate/head_series.h"
#include "experiments/simulate/held_report.h"
#include "experiments/simulate/save_clock.h"
#include "experiments/simulate/starts_inside.h"
#include "experiments/simulate/stop_request.h"
#include "experiments/simulate/time_bar.h"
#include "simulation/head/head_balance.h"
#include "simulation/head/head_device.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/remedy.h"
#include "simulation/run/timing.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::scene_runs {
namespace {

class HeadSceneRun {
 public:
  HeadSceneRun(const SceneOutline& outline, RunKey key, const SceneRunOptions& options,
               Interruption& interruption)
      : outline_(outline),
        scene_(outline.scene),
        options_(options),
        interruption_(interruption),
        ranks_(*options.ranks),
        key_(std::move(
            key.add("run", fmt::format("head of {} bits, frames of {}",
                                       bits_of(options.pack), options.frame_bits)))),
        lost_(ranks_) {}

  SceneRun run() {
    SceneRun made{SceneRun::End::complete, {}, 0, 0, 0, 0};
    made.wall_s = seconds_of([&] { run(made); });
    return made;
  }

 private:
  void run(SceneRun& made) {
    HeadOutcome& outcome = made.head.emplace();
    outcome.build_s = seconds_of([&] {
      SceneHead head = make_head(outline_, options_.pack, options_.threads, ranks_);
      report(head);
      run_ = std::make_unique<HeadRun>(std::move(head), options_.threads, ranks_);
      outcome.device = take_device();
    });
    build_s_ = ranks_.largest(outcome.build_s);
    reading_.emplace(shown_strands(run_->strands()), options_.threads);
    StoredFrames stored{options_.frame_bits, reading_->shown(), {}};
    for (const Reading& column : head_series(scene_)) {
      stored.columns.push_back(column.name);
    }
    if (ranks_.first()) {
      recording_.emplace(options_.stem, key_, scene_, *run_, std::move(stored),
                         options_.resume);
    }
    begin();
    made.resumed = frames_ > 0;
    advance(outcome);
    made.frames = frames_;
    made.simulated_s = scene_.duration;
    made.work = work();
    made.passed = passed();
    made.rejected = made.work.rejected;
    const std::size_t state = run_->hash();
    made.dissipation = run_->dissipation();
    made.excess = run_->excess();
    made.no_dissipation = run_->no_dissipation();
    set_outcome_of_ranks(outcome);
    if (!ranks_.first()) {
      if (losses_ > 0) made.end = SceneRun::End::failed;
      return;
    }
    options_.heartbeat->doing(scene_.name + ": writing its pictures");
    write_head_pictures(outline_, recording_->frames(), reading_->shown(), options_);
    const auto whole = interruption_.hold();
    recording_->close();
    outcome.pack =
        run_->lanes() ? options_.pack : HeadPack{models::HeadNumber::float64, 1};
    outcome.engine = run_->lanes() ? "lanes" : "replicated";
    outcome.strands = run_->strands();
    outcome.lost = recording_->progress().lost.size();
    outcome.shown_strands = reading_->shown().size();
    outcome.shown_frames = shown_frames(recording_->frames().size());
    outcome.bytes_per_strand = static_cast<double>(run_->head().bytes()) /
                               static_cast<double>(run_->head().strands());
    outcome.state = fmt::format("{:016x}", state);
    if (outcome.lost == 0) return;
    made.end = SceneRun::End::failed;
    made.reason = why_failed(recording_->progress().lost);
  }

  /// What holds strands at rest; of ranks none has all.
  void report(const SceneHead& head) {
    if (head.held.empty() || ranks_.size() > 1) return;
    Scene whole = scene_;
    whole.strands.clear();
    std::vector<HeldShape> held;
    for (const std::size_t place : head.division->by_number()) {
      whole.strands.push_back(outline_.series->strand(held.size()));
      held.push_back(head.held[place]);
    }
    report_held(whole, held, options_.stem + ".rest.csv");
  }

  std::string why_failed(const std::vector<FailedStrand>& lost) const {
    const FailedStrand& first = lost.front();
    const bool unsolved = first.reason.starts_with("no solution");
    return fmt::format(
        "{}{} of {} strand{} failed, the first at t = {:.9g} s, strand {}: {} "
        "({}.failed.csv): {}{}",
        unsolved ? "" : "unstable: ", lost.size(), run_->strands(),
        run_->strands() == 1 ? "" : "s", first.t, first.strand, first.reason,
        options_.stem,
        remedy(scene_.integrator, scene_.options, Limit::none, scene_.model->id),
        unsolved && run_->lanes()
            ? ", or --as strands, which has more ways to solve a step"
            : "");
  }

  /// Steps of the head, or with a tolerance those of its strands.
  Stats work() {
    Stats all;
    const bool together = run_->lanes() && scene_.options.tolerance == 0;
    if (together) all.steps = steps_;
    done_ += run_->work();
    for (const models::HeadWork& done : ranks_.of_each(done_)) {
      if (!together) all.steps += done.steps;
      all.rejected_by_error += done.rejected_by_error;
      all.rejected_by_newton += done.rejected_by_newton;
      all.replaced += done.replaced;
      all.newton_iterations += done.iterations + done.again_iterations;
      all.rejected += done.shortened;  // of systems, all
      if (run_->lanes()) {
        all.rejected += done.rejected_by_error + done.rejected_by_newton;
      }
    }
    return all;
  }

  /// The earliest of all ranks.
  std::optional<StrandPassage> passed() {
    StrandPassage none;
    none.contact.t = std::numeric_limits<double>::infinity();
    StrandPassage first = none;
    for (const StrandPassage& one : ranks_.of_each(passed_.value_or(none))) {
      if (one.contact.t < first.contact.t) first = one;
    }
    return std::isfinite(first.contact.t) ? std::optional(first) : std::nullopt;
  }

  /// What the rank with most has, or has taken.
  void set_outcome_of_ranks(HeadOutcome& outcome) {
    outcome.ranks = ranks_.size();
    outcome.rank_strands = static_cast<std::size_t>(
        ranks_.largest(static_cast<double>(run_->head().strands())));
    outcome.peak_memory_mb = ranks_.largest(spent_so_far().largest_mb);
    if (run_->halo() == nullptr) return;
    const Halo::Work& work = run_->halo()->work();
    const auto most = [&](double all) {
      return ranks_.largest(all / static_cast<double>(std::max(work.steps, 1L)));
    };
    outcome.ghosts_per_step = most(work.ghosts);
    outcome.sent_per_step = most(work.sent);
    outcome.claims_per_step = most(static_cast<double>(work.claims));
    outcome.claim_s = most(work.claim_s);
    outcome.exchange_s = most(work.exchange_s);
    outcome.meet_s = most(work.meet_s);
  }

  std::string take_device() {
    const ChosenDevice chosen = choose_device(*run_, options_.device, scene_.name);
    if (!chosen.why_not.empty()) {
      tell("simulate: {}: --device auto stays on the processor: {}\n", scene_.name,
           chosen.why_not);
    }
    if (!run_->on_device()) return chosen.name;
    // Other products are fused than here: other last bits.
    key_.add("device", "gpu");
    tell("simulate: {}: on {}\n", scene_.name, chosen.name);
    return chosen.name;
  }

  /// All ranks go on where the recording of the first does.
  void begin() {
    struct Known {
      std::size_t frames = 0, step = 0, losses = 0;  // step: since the last frame
    } known;
    if (recording_) {
      const HeadProgress& progress = recording_->progress();
      known = {recording_->frames().size(), progress.step, progress.lost.size()};
    }
    ranks_.as_first(std::span(&known, 1));
    frames_ = known.frames;
    step_ = known.step;
    losses_ = known.losses;
    if (frames_ > 0) {
      const auto saved = recording_ ? recording_->take_saved() : nullptr;
      std::vector<double> kept;
      reading_->by_chunks(*run_, [&](HeadRun::Numbers strands) {
        if (saved) kept = saved->take(strands.size());
        run_->recall(strands, kept);
      });
    }
  }

  /// To the last frame, unless a signal ends the program.
  void advance(HeadOutcome& outcome) {
    StopRequest stop;
    const Interruption::Save save(interruption_, [&] { stop.ask(ranks_.size() > 1); });
    // Before `save` waits for the thread of signals, which waits for an answer.
    const struct Answer {
      StopRequest& to;
      ~Answer() { to.answer(); }
    } at_the_end{stop};
    const auto between_saves =
        static_cast<std::size_t>(std::round(scene_.checkpoint * scene_.frame_rate));
    TimeBar bar(options_.progress, scene_, frames_ > 0 ? scene_.time_of(frames_ - 1) : 0,
                *options_.heartbeat);
    SaveClock clock(options_.save_every);
    if (frames_ == 0) {
      look_at_start();
      add_frame(0, outcome);
    }
    std::size_t step = step_;
    const std::size_t last = scene_.last_frame();
    while (frames_ <= last) {
      const std::size_t frame = frames_;
      outcome.step_s += seconds_of([&] { take_steps(frame, step, stop); });
      step = 0;
      add_frame(scene_.time_of(frame), outcome);
      bar.show(scene_.time_of(frame));
      if (frame == last) continue;
      // Of the ranks' clocks none is the others'.
      const bool by_clock = between_saves == 0 && ranks_.largest(clock.due() ? 1 : 0) > 0;
      if (!by_clock && (between_saves == 0 || frame % between_saves != 0)) continue;
      outcome.write_s += seconds_of([&] { save_state(0, !by_clock); });
      clock.saved();
      if (by_clock) continue;
      outcome.build_s += seconds_of([&] {
        auto anew = balanced(*run_, outline_, options_.pack, options_.threads, build_s_,
                             reading_->at_once());
        if (!anew) return;
        done_ += run_->work();
        run_ = std::move(anew);
      });
    }
  }

  /// Warns of strands that begin inside bodies.
  void look_at_start() {
    StartsInside inside(scene_);
    if (!inside.any()) return;
    std::vector<double> x;
    reading_->by_chunks(*run_, [&](HeadRun::Numbers strands) {
      run_->positions(0, strands, x);
      if (!ranks_.first()) return;
      const std::size_t each = x.size() / strands.size();
      for (std::size_t k = 0; k < strands.size(); ++k) {
        inside.look(std::span(x).subspan(each * k, each));
      }
    });
    tell_starts_inside(scene_, inside);
  }

  /// Equal ones, as long as longest_step() at most, from `done` on.
  void take_steps(std::size_t frame, std::size_t done, StopRequest& stop) {
    const double begin = scene_.time_of(frame - 1), end = scene_.time_of(frame),
                 count = std::max(
                     1.0, std::ceil((end - begin) / longest_step(scene_, run_->lanes()) -
                                    1e-9)),
                 h = (end - begin) / count;
    for (std::size_t i = done; i < static_cast<std::size_t>(count); ++i) {
      if (ranks_.largest(stop.asked() ? 1 : 0) > 0) {
        fetch(h);
        end_here(i, stop);
      }
      const double t = begin + static_cast<double>(i) * h;
      where_a_device_fails([&] { run_->step(t, h); });
      ++steps_;
      if (run_->lanes()) {
        lose(run_->on_device() ? std::nullopt : std::optional(t + h), h);
      } else {
        lose({}, 0);
      }
    }
    fetch(h);
  }

  /// What a device has done in steps of h.
  void fetch(double h) {
    if (!run_->on_device()) return;
    where_a_device_fails([&] { run_->fetch(); });
    lose({}, h);
  }

  /// Does `work`; throws InputError where the device fails in it.
  template <class Work>
  void where_a_device_fails(Work work) {
    try {
      work();
    } catch (const DeviceFailure& no) {
      throw no_device(no, scene_.name);
    }
  }

  /// What the run has lost in steps of h, all at t, or each at the end of its step.
  void lose(std::optional<double> t, double h) {
    for (const auto& loss : run_->lost()) {
      lost_.lose({outline_.series->number(loss.strand), t.value_or(loss.time + h),
                  std::string(loss.reason)});
    }
  }

  /// `restart`: systems go on from it as a run that is resumed there does.
  void save_state(std::size_t step, bool restart) {
    const auto saved = recording_ ? recording_->saving(step) : nullptr;
    std::vector<double> kept;
    reading_->by_chunks(*run_, [&](HeadRun::Numbers strands) {
      run_->keep(strands, kept);
      if (saved) saved->put(kept);
      if (restart && !run_->lanes()) run_->recall(strands, kept);
    });
    if (saved) saved->finish();
  }

  void gather_lost() {
    for (const FailedStrand& lost : lost_.gathered()) {
      ++losses_;
      if (recording_) recording_->lose(lost);
    }
  }

  /// A signal has come: the thread that handles it ends the program.
  [[noreturn]] void end_here(std::size_t step, StopRequest& stop) {
    try {
      // Systems restart at saved states of checkpoint_s only.
      if (run_->lanes() || scene_.checkpoint == 0) {
        gather_lost();
        save_state(step, false);
      }
      ranks_.largest(0);  // none ends before the first has saved
      stop.answer();
    } catch (const std::exception& error) {
      stop.answer(error.what());
    }
    const auto never_given_back = interruption_.hold();
    std::abort();
  }

  void add_frame(double t, HeadOutcome& outcome) {
    ++frames_;
    std::vector<double> series;
    outcome.read_s += seconds_of([&] {
      run_->judge(t);
      if (!passed_) passed_ = run_->passed();
      lose(t, 0);
      gather_lost();
      series = reading_->series(*run_, t);
      reading_->frame(*run_, t, options_.frame_bits > 0,
                      recording_ ? &recording_->frame() : nullptr);
    });
    if (recording_) outcome.write_s += seconds_of([&] { recording_->add(series); });
  }

  const SceneOutline& outline_;
  const Scene& scene_;
  const SceneRunOptions& options_;
  Interruption& interruption_;
  Ranks& ranks_;
  RunKey key_;
  std::unique_ptr<HeadRun> run_;
  double build_s_ = 0;  // of the rank that took longest
  std::optional<HeadReading> reading_;
  std::optional<HeadRecording> recording_;  // of the first rank
  FailuresOfRanks lost_;                    // not yet known to the first rank
  std::size_t frames_ = 0, step_ = 0;       // written; taken before this process began
  std::size_t losses_ = 0;                  // of all ranks
  std::optional<StrandPassage> passed_;     // of this rank
  long steps_ = 0;
  models::HeadWork done_;  // by heads that others have taken the place of
};

}  // namespace

SceneRun run_head(const SceneOutline& outline, const RunKey& key,
                  const SceneRunOptions& options, Interruption& interruption) {
  return HeadSceneRun(outline, key, options, interruption).run();
}

}  // namespace tress::experiments::scene_runs
