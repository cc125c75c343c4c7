#include "experiments/simulate/head_scene_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "contract/input_error.h"
#include "experiments/simulate/head_pictures.h"
#include "experiments/simulate/head_recording.h"
#include "experiments/simulate/head_series.h"
#include "experiments/simulate/time_bar.h"
#include "simulation/run/head_guard.h"
#include "simulation/run/memory.h"
#include "simulation/run/ranks.h"
#include "simulation/run/scene_head.h"
#include "simulation/run/timing.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::scene_runs {
namespace {

/// Lets the thread that handles signals ask the run to save itself between two steps: a
/// copy of the state for whenever a signal comes would take as much memory again.
class StopRequest {
 public:
  bool asked() const { return asked_; }
  /// By the thread of signals: returns when the run has answered. A run of several ranks
  /// may wait in vain for one that was killed, and mpirun ends it a second later.
  void ask(bool ranks) {
    constexpr std::chrono::milliseconds before_mpirun_kills(800);
    asked_ = true;
    std::unique_lock lock(mutex_);
    const auto answered = [this] { return answered_; };
    if (!ranks) changed_.wait(lock, answered);
    if (ranks && !changed_.wait_for(lock, before_mpirun_kills, answered)) {
      throw std::runtime_error(
          "its ranks do not answer (mpirun says if one was killed): the same command "
          "with "
          "--resume goes on from the last checkpoint_s");
    }
    if (!problem_.empty()) throw std::runtime_error(problem_);
  }
  /// By the run, when it has saved itself or is over.
  void answer(std::string problem = {}) {
    const std::lock_guard lock(mutex_);
    answered_ = true;
    problem_ = std::move(problem);
    changed_.notify_all();
  }

 private:
  std::atomic<bool> asked_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool answered_ = false;
  std::string problem_;
};

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
                                       bits_of(options.pack), options.frame_bits)))) {}

  SceneRun run() {
    SceneRun made{SceneRun::End::complete, {}, 0, 0, 0, 0};
    made.wall_s = seconds_of([&] { run(made); });
    return made;
  }

  static int bits_of(const models::HeadPack& pack) {
    return pack.number == models::HeadNumber::float64 ? 64 : 32;
  }

 private:
  void run(SceneRun& made) {
    HeadOutcome& outcome = made.head.emplace();
    std::optional<HeadReach> reach;
    outcome.build_s = seconds_of([&] {
      SceneHead made_head = make_head(outline_, options_.pack, options_.threads, ranks_);
      reach = std::move(made_head.reach);
      run_ = std::make_unique<HeadRun>(std::move(made_head), options_.threads, ranks_);
      if (options_.device != DeviceChoice::cpu) choose_device(outcome);
    });
    build_s_ = ranks_.largest(outcome.build_s);
    shown_ = shown_strands(run_->strands());
    StoredFrames stored{options_.frame_bits, shown_, {}};
    for (const Reading& column : head_series()) stored.columns.push_back(column.name);
    if (ranks_.first()) {
      recording_.emplace(options_.stem, key_, scene_, *run_, std::move(stored),
                         options_.resume);
    }
    const double speed = begin();
    if (reach) guard_.emplace(std::move(*reach), speed);
    advance(outcome);
    made.frames = frames_;
    made.simulated_s = scene_.duration;
    made.work.steps = steps_;
    const std::size_t state = run_->hash();
    set_outcome_of_ranks(outcome);
    if (!ranks_.first()) {
      if (lost_ > 0) made.end = SceneRun::End::failed;
      return;
    }
    write_head_pictures(outline_, recording_->frames(), shown_, options_);
    const auto whole = interruption_.hold();
    recording_->close();
    outcome.pack = options_.pack;
    outcome.strands = run_->strands();
    outcome.lost = recording_->progress().lost.size();
    outcome.bytes_per_strand = static_cast<double>(run_->head().bytes()) /
                               static_cast<double>(run_->head().strands());
    outcome.state = fmt::format("{:016x}", state);
    if (outcome.lost == 0) return;
    made.end = SceneRun::End::failed;
    made.reason = fmt::format("{} of {} strands were lost: {}.lost.csv", outcome.lost,
                              outcome.strands, options_.stem);
  }

  /// What the rank with most has, or has taken.
  void set_outcome_of_ranks(HeadOutcome& outcome) {
    outcome.ranks = ranks_.size();
    outcome.rank_strands = static_cast<std::size_t>(
        ranks_.largest(static_cast<double>(run_->head().strands())));
    outcome.peak_memory_mb = ranks_.largest(peak_memory() / 1e6);
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
  }

  /// The device, if there is one; else, unless it is asked for, the processor.
  void choose_device(HeadOutcome& outcome) {
    try {
      if (ranks_.size() > 1) {
        throw InputError("ranks share a head on processors only", scene_.name,
                         "leave out mpirun, or give --device cpu");
      }
      outcome.device = run_->move_to_device();
    } catch (const InputError& no) {
      if (options_.device == DeviceChoice::gpu) throw;
      stay(no.what());
    } catch (const DeviceFailure& no) {
      if (options_.device == DeviceChoice::gpu) throw no_device(no);
      stay(no.what());
    }
    if (outcome.device == "cpu") return;
    // Other products are fused than here: other last bits.
    key_.add("device", "gpu");
    tell("simulate: {}: on {}\n", scene_.name, outcome.device);
  }
  void stay(const std::string& reason) const {
    tell("simulate: {}: --device auto stays on the processor: {}\n", scene_.name, reason);
  }
  InputError no_device(const DeviceFailure& no) const {
    return InputError(no.what(), "--device gpu of " + scene_.name,
                      "give --device cpu, or auto to go on without a device");
  }

  /// All ranks go on where the recording of the first does; speed: of its guard.
  double begin() {
    // The frames that are written, steps since, speed, lost strands.
    std::vector<double> known(4);
    if (recording_) {
      known = {static_cast<double>(recording_->frames().size()),
               static_cast<double>(recording_->progress().step),
               recording_->progress().speed,
               static_cast<double>(recording_->progress().lost.size())};
    }
    std::vector<std::size_t> sizes(static_cast<std::size_t>(ranks_.size()), 0);
    sizes.front() = known.size();
    ranks_.share(std::span(known), sizes);
    frames_ = static_cast<std::size_t>(known[0]);
    step_ = static_cast<std::size_t>(known[1]);
    lost_ = static_cast<std::size_t>(known[3]);
    if (frames_ > 0) {
      const auto saved = recording_ ? recording_->take_saved() : nullptr;
      std::vector<double> kept;
      by_chunks([&](HeadRun::Numbers strands) {
        if (saved) kept = saved->take(strands.size());
        run_->recall(strands, kept);
      });
    }
    return known[2];
  }

  void by_chunks(const std::function<void(HeadRun::Numbers)>& use) const {
    run_->by_chunks(HeadFrames::at_once(static_cast<std::size_t>(options_.threads)), use);
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
    TimeBar bar(options_.progress, scene_);
    if (frames_ == 0) add_frame(0, outcome);
    std::size_t step = step_;
    const std::size_t last = scene_.last_frame();
    while (frames_ <= last) {
      const std::size_t frame = frames_;
      outcome.step_s += seconds_of([&] { take_steps(frame, step, stop); });
      step = 0;
      add_frame(scene_.time_of(frame), outcome);
      bar.show(scene_.time_of(frame));
      if (between_saves == 0 || frame % between_saves != 0 || frame == last) continue;
      outcome.write_s += seconds_of([&] { save_state(0); });
      outcome.build_s += seconds_of([&] { divide_anew(); });
    }
  }

  /// If what the slowest rank takes longer than the mean, from one saved state to the
  /// next, is more than a new division takes.
  void divide_anew() {
    if (ranks_.size() == 1) return;
    std::vector<double> seconds(static_cast<std::size_t>(ranks_.size()));
    seconds[static_cast<std::size_t>(ranks_.rank())] = run_->stepping_s();
    ranks_.share(std::span(seconds), std::vector<std::size_t>(seconds.size(), 1));
    const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0),
                 mean = all / static_cast<double>(seconds.size());
    if (!(std::ranges::max(seconds) - mean > build_s_)) return;
    const HeadDivision& division = run_->division();
    std::vector<double> counts(seconds.size()), cost(run_->strands());
    for (std::size_t k = 0; k < cost.size(); ++k) {
      counts[static_cast<std::size_t>(division.owner(k))] += 1;
    }
    for (std::size_t k = 0; k < cost.size(); ++k) {
      const auto owner = static_cast<std::size_t>(division.owner(k));
      cost[k] = seconds[owner] / counts[owner];
    }
    auto next = std::make_unique<HeadRun>(
        make_head(outline_, options_.pack, options_.threads, ranks_, cost),
        options_.threads, ranks_);
    std::vector<double> kept;
    by_chunks([&](HeadRun::Numbers strands) {
      run_->keep(strands, kept);
      next->recall(strands, kept);
    });
    run_ = std::move(next);
  }

  /// Equal steps of dt_s at most, from `done` on.
  void take_steps(std::size_t frame, std::size_t done, StopRequest& stop) {
    const double begin = scene_.time_of(frame - 1), end = scene_.time_of(frame),
                 count =
                     std::max(1.0, std::ceil((end - begin) / scene_.options.step - 1e-9)),
                 h = (end - begin) / count;
    for (std::size_t i = done; i < static_cast<std::size_t>(count); ++i) {
      if (ranks_.largest(stop.asked() ? 1 : 0) > 0) {
        fetch(h);
        end_here(i, stop);
      }
      const double t = begin + static_cast<double>(i) * h;
      run_->step(t, h);
      ++steps_;
      if (guard_) guard_->step(t, h);
      for (const auto& loss : run_->lost()) new_lost_.push_back({loss.strand, t + h});
    }
    fetch(h);
  }

  /// What a device has done in steps of h.
  void fetch(double h) {
    if (!run_->on_device()) return;
    try {
      run_->fetch();
    } catch (const DeviceFailure& no) {
      throw no_device(no);
    }
    for (const auto& loss : run_->lost())
      new_lost_.push_back({loss.strand, loss.time + h});
  }

  void save_state(std::size_t step) {
    const auto saved =
        recording_ ? recording_->saving(step, guard_ ? guard_->speed() : 0) : nullptr;
    std::vector<double> kept;
    by_chunks([&](HeadRun::Numbers strands) {
      run_->keep(strands, kept);
      if (saved) saved->put(kept);
    });
    if (saved) saved->finish();
  }

  /// The first rank hears of strands that were lost, by the time and then by the strand.
  void gather_lost() {
    const auto size = static_cast<std::size_t>(ranks_.size()),
               own = static_cast<std::size_t>(ranks_.rank());
    std::vector<double> counts(size);
    counts[own] = static_cast<double>(new_lost_.size());
    ranks_.share(std::span(counts), std::vector<std::size_t>(size, 1));
    constexpr std::size_t numbers = 3;
    std::vector<std::size_t> sizes(size);
    std::size_t all = 0, before = 0;
    for (std::size_t r = 0; r < size; ++r) {
      if (r == own) before = all;
      sizes[r] = numbers * static_cast<std::size_t>(counts[r]);
      all += sizes[r];
    }
    if (all == 0) return;
    std::vector<double> entries(all);
    for (const LostStrand& lost : new_lost_) {
      entries[before++] = static_cast<double>(lost.strand);
      entries[before++] = lost.t;
      entries[before++] = lost.fast ? 1 : 0;
    }
    ranks_.share(std::span(entries), sizes);
    new_lost_.clear();
    for (std::size_t i = 0; i < all; i += numbers) {
      new_lost_.push_back(
          {static_cast<std::size_t>(entries[i]), entries[i + 1], entries[i + 2] != 0});
    }
    std::ranges::sort(new_lost_, {}, [](const LostStrand& lost) {
      return std::pair(lost.t, lost.strand);
    });
    lost_ += new_lost_.size();
    for (const LostStrand& lost : new_lost_) {
      if (recording_) recording_->lose(lost);
    }
    new_lost_.clear();
  }

  /// Strands that go on where physics does not are lost from this frame on.
  void check(double t) {
    if (!guard_) return;
    if (t == 0) guard_->start(ranks_.largest(fastest(energies_)));
    if (!scene_.guard) return;
    for (std::size_t k = 0; k < energies_.size(); ++k) {
      if (run_->head().lost(k) || !guard_->breached(t, energies_[k])) continue;
      run_->change().lose(k);
      new_lost_.push_back({run_->division().own()[k], t, true});
    }
    gather_lost();
  }

  /// A signal has come: the thread that handles it ends the program.
  [[noreturn]] void end_here(std::size_t step, StopRequest& stop) {
    try {
      gather_lost();
      save_state(step);
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
      gather_lost();
      run_->energies(t, energies_);
      check(t);
      series = read_series(t);
      read_frame(t);
    });
    if (recording_) outcome.write_s += seconds_of([&] { recording_->add(series); });
  }

  /// Of the energies of all strands.
  std::vector<double> read_series(double t) const {
    using models::HeadEnergy;
    constexpr std::size_t numbers = sizeof(HeadEnergy) / sizeof(double),
                          each = numbers + 1;
    using Numbers = std::array<double, numbers>;
    HeadSeriesRow row;
    std::vector<double> all;
    const Head& head = run_->head();
    by_chunks([&](HeadRun::Numbers strands) {
      run_->collect(
          strands, each,
          [&](std::size_t block, std::span<double> to) {
            for (std::size_t k = 0; k < head.strands_of(block); ++k) {
              const std::size_t place = block * head.strands_of(0) + k;
              std::ranges::copy(std::bit_cast<Numbers>(energies_[place]), &to[each * k]);
              to[each * k + numbers] = head.lost(place) ? 1 : 0;
            }
          },
          all);
      for (std::size_t i = 0; i < all.size(); i += each) {
        Numbers one;
        std::copy_n(&all[i], numbers, one.begin());
        row.add(std::bit_cast<HeadEnergy>(one), all[i + numbers] != 0);
      }
    });
    return row.at(t);
  }

  void read_frame(double t) {
    std::vector<double> x;
    if (options_.frame_bits > 0) {
      by_chunks([&](HeadRun::Numbers strands) {
        run_->positions(t, strands, x);
        if (recording_) recording_->frame().take(run_->crew(), strands.front(), x);
      });
    }
    run_->positions(t, shown_, x);
    if (recording_) recording_->frame().take_shown(x);
  }

  const SceneOutline& outline_;
  const Scene& scene_;
  const SceneRunOptions& options_;
  Interruption& interruption_;
  Ranks& ranks_;
  RunKey key_;
  std::unique_ptr<HeadRun> run_;
  std::vector<std::size_t> shown_;          // strands
  double build_s_ = 0;                      // of the rank that took longest
  std::optional<HeadRecording> recording_;  // of the first rank
  std::vector<LostStrand> new_lost_;        // not yet known to the first rank
  std::size_t frames_ = 0, step_ = 0;       // written; taken before this process began
  std::size_t lost_ = 0;
  std::optional<HeadGuard> guard_;
  std::vector<models::HeadEnergy> energies_;
  long steps_ = 0;
};

}  // namespace

void check_room(const SceneOutline& outline, const SceneRunOptions& options) {
  const Scene& scene = outline.scene;
  const Ranks& ranks = *options.ranks;
  const std::size_t strands = outline.series->size(),
                    elements = scene.strands.front().segments.size(),
                    size = static_cast<std::size_t>(ranks.size()),
                    of_rank = (strands + size - 1) / size;
  const double count = static_cast<double>(strands),
               frame =
                   count * 3 * static_cast<double>(elements + 1) * options.frame_bits / 8;
  // The first rank has a frame, and a number of six for each coordinate while a saved
  // state is read.
  const double first =
      frame + (options.resume ? count * 8.0 * 6 * static_cast<double>(elements) : 0);
  constexpr double scratch = 5e7;  // of threads, of this program
  // Roots and owners of all strands, energies of its own.
  const double each = static_cast<double>(head_bytes(outline, options.pack, of_rank)) +
                      static_cast<double>(of_rank * sizeof(models::HeadEnergy)) +
                      count * (sizeof(Vec) + sizeof(int)) + scratch,
               memory = each * ranks.on_this_machine() + first, free = free_memory(),
               frames = static_cast<double>(scene.last_frame() + 1);
  if (memory > free) {
    throw InputError(fmt::format("a head of {} strands of {} elements needs about {:.2g} "
                                 "GB of memory, {:.2g} GB are free",
                                 strands, elements, memory / 1e9, free / 1e9),
                     scene.name, "give fewer strands or elements, or --bits 32");
  }
  std::error_code unknown;
  const auto disk =
      std::filesystem::space(std::filesystem::path(options.stem).parent_path(), unknown);
  if (!unknown && frame * frames > static_cast<double>(disk.available)) {
    throw InputError(
        fmt::format(
            "{:.0f} frames of {:.3g} MB may take {:.2g} GB of the disk, {:.2g} GB "
            "are free",
            frames, frame / 1e6, frame * frames / 1e9,
            static_cast<double>(disk.available) / 1e9),
        scene.name, "give fewer frames_1_s, --frames 32 or none, or another --out");
  }
  tell(
      "simulate: {}: a head of {} strands of {} elements, {} bits, {} lanes: about "
      "{:.0f} "
      "MB of memory, {:.0f} frames of {:.3g} MB before compression\n",
      scene.name, strands, elements, HeadSceneRun::bits_of(options.pack),
      options.pack.lanes, memory / 1e6, frames, frame / 1e6);
}

SceneRun run_head(const SceneOutline& outline, const RunKey& key,
                  const SceneRunOptions& options, Interruption& interruption) {
  return HeadSceneRun(outline, key, options, interruption).run();
}

}  // namespace tress::experiments::scene_runs
