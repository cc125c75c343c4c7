#include "experiments/simulate/scene_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "contract/input_error.h"
#include "experiments/simulate/failed_strands.h"
#include "experiments/simulate/held_report.h"
#include "experiments/simulate/pictures.h"
#include "experiments/simulate/save_clock.h"
#include "experiments/simulate/starts_inside.h"
#include "experiments/simulate/time_bar.h"
#include "simulation/export/recording.h"
#include "simulation/files/files.h"
#include "simulation/run/remedy.h"

namespace tress::experiments::scene_runs {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Rejects a state that this program has not written, even if its key matches.
void restore(World& world, const Snapshot& saved) {
  const auto sizes = [](const Snapshot& snapshot) {
    std::vector<std::array<std::size_t, 3>> all;
    for (const auto& one : snapshot.strands) {
      all.push_back({one.q.size(), one.v.size(), one.memory.size()});
    }
    return all;
  };
  if (sizes(saved) != sizes(world.snapshot())) {
    throw InputError("the saved state is of other strands", "--resume",
                     "leave out --resume to begin again");
  }
  world.restore(saved);
}

}  // namespace

SceneRun run_scene(const Scene& scene, const RunKey& key, const SceneRunOptions& options,
                   Interruption& interruption) {
  const Clock::time_point begin = Clock::now();
  auto world = std::make_unique<World>(scene, options.threads);
  if (!world->held().empty() && scene.unstable != Unstable::drop) {
    report_held(scene, world->held(), options.stem + ".rest.csv");
  }
  for (const std::string& start : world->supported_starts()) {
    tell("simulate: {}: {}\n", scene.name, start);
  }
  Readout readout(scene, *world);
  const Pictures pictures(scene, *world, readout, options);
  Recording recording(options.stem, key, readout, options.resume);
  const auto between_saves =
      static_cast<std::size_t>(std::round(scene.checkpoint * scene.frame_rate));
  std::optional<Snapshot> latest;  // of the last frame, if no other state is saved
  const Interruption::Save save(interruption, [&] {
    if (latest) recording.save(*latest);
  });
  SaveClock clock(options.save_every);
  const auto add_frame = [&] {
    Frame3d frame = readout.read(*world);
    const auto whole = interruption.hold();
    recording.add(std::move(frame));
    if (between_saves > 0) return;
    latest = world->snapshot();
    if (!clock.due()) return;
    recording.save(*latest);
    clock.saved();
  };
  if (recording.saved()) {
    restore(*world, *recording.saved());
    if (between_saves == 0) latest = recording.saved();
    static_cast<void>(world->take_depth());  // watched from here on
  } else {
    StartsInside inside(scene);
    std::size_t first = 0;
    for (const int points : world->points()) {
      const auto numbers = 3 * static_cast<std::size_t>(points);
      if (inside.any()) inside.look(In(world->positions()).subspan(first, numbers));
      first += numbers;
    }
    tell_starts_inside(scene, inside);
    add_frame();
  }

  SceneRun run{SceneRun::End::complete, {}, 0, 0, 0, 0};
  run.resumed = recording.saved().has_value();
  const std::size_t last = scene.last_frame();
  TimeBar bar(options.progress, scene, world->time(), *options.heartbeat);
  while (recording.frames().size() <= last) {
    const std::size_t frame = recording.frames().size();
    if (world->advance(scene.time_of(frame)) != Status::ok) {
      run.end = SceneRun::End::failed;
      run.reason = world->failure();
      break;
    }
    if (world->lost().size() > run.lost) {
      run.lost = world->lost().size();
      replace_file(options.stem + ".failed.csv", failed_table(world->lost()));
    }
    add_frame();
    if (run.not_smooth.empty()) run.not_smooth = world->not_smooth();
    if (!run.passed) run.passed = world->passed();
    run.indicator = std::max(run.indicator, world->error_indicator());
    bar.show(world->time());
    if (between_saves == 0 || frame % between_saves != 0 || frame == last) continue;
    const Snapshot snapshot = world->snapshot();
    {
      const auto whole = interruption.hold();
      recording.save(snapshot);
    }
    add_work(world->stats(), run.work);
    add_exchanges(world->exchanges(), run.exchanges);
    world = std::make_unique<World>(scene, options.threads, world->held());
    world->restore(snapshot);
    static_cast<void>(world->take_depth());  // watched from here on
    readout.restart();
  }
  add_work(world->stats(), run.work);
  add_exchanges(world->exchanges(), run.exchanges);
  run.frames = recording.frames().size();
  for (const Frame3d& frame : recording.frames()) {
    run.rejected += static_cast<long>(frame.series.back());
  }
  for (const Frame3d& frame : recording.frames()) {
    run.supports = readout.support_loads(frame);
    for (const NamedLoad& support : run.supports) {
      if (!support.force) continue;
      run.support_force = std::max(run.support_force, norm(*support.force));
    }
  }
  if (run.lost > 0 && run.end != SceneRun::End::failed) {
    const FailedStrand& first = *std::ranges::min_element(
        world->lost(), {},
        [](const FailedStrand& one) { return std::pair(one.t, one.strand); });
    run.end = SceneRun::End::failed;
    run.reason = fmt::format(
        "{} of {} strand{} failed, the first at t = {:.9g} s, strand {}: {} "
        "({}.failed.csv): {}",
        run.lost, world->strands(), world->strands() == 1 ? "" : "s", first.t,
        first.strand, first.reason, options.stem,
        remedy(scene.integrator, scene.options, Limit::none, scene.model->id));
  }
  run.simulated_s = world->time();
  run.dissipation = world->dissipation();
  run.excess = world->excess();
  run.no_dissipation = world->no_dissipation();
  if (!run.passed) run.passed = world->passed();
  if (run.not_smooth.empty()) run.not_smooth = world->not_smooth();
  run.wall_s = seconds_since(begin);
  options.heartbeat->doing(scene.name + ": writing its pictures");
  pictures.write(recording.frames(), options.further && run.end == SceneRun::End::complete
                                         ? options.further()
                                         : std::vector<FurtherChannel>{});
  const auto whole = interruption.hold();
  latest.reset();
  recording.close();
  return run;
}

}  // namespace tress::experiments::scene_runs
