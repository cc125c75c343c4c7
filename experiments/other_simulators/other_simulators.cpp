// How much time do other simulators need for a strand? Debian's Simbody, Bullet, MuJoCo
// and ODE, and npm's MuJoCo 3 and Jolt, on scene `swing`: tip error against each one's
// own finest run, over a ladder of steps.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/other_simulators/continuous_rod.h"
#include "experiments/other_simulators/simulator.h"
#include "experiments/run/experiment.h"
#include "experiments/run/message.h"
#include "experiments/run/settings.h"
#include "simulation/run/timing.h"

namespace tress::experiments::other_simulators {
namespace {

using other_simulators::Engine;
using other_simulators::Method;
using other_simulators::Motion;
using other_simulators::Simulator;
using other_simulators::Swing;

constexpr Column columns[] = {
    {"simulator", "library"},
    {"version", "version of the linked library"},
    {"method", "joints and integrator or solver"},
    {"precision", "floating-point precision of the library: double or single"},
    {"elements", "links of the strand"},
    {"dt_s", "fixed step"},
    {"steps", "steps of the run of 2 s"},
    {"wall_s", "median wall time of the run, setup excluded", true},
    {"us_per_step", "median wall time per step", true},
    {"tip_error_rel",
     "rms over the run of the tip's distance from the same simulator's finest run, over "
     "L. Errors of first order are understated by the ratio of the finest step to dt_s"},
    {"total_error_rel",
     "rms over the run of the tip's distance from the continuous rod, over L: "
     "error of links, joints and steps together"},
    {"largest_stable", "the largest step with none unstable below it"},
    {"cheapest_1pct", "fastest run with a tip error of at most 1 %", true},
    {"cheapest_0p1pct", "fastest run with a tip error of at most 0.1 %", true},
    {"apart_mm",
     "finest runs: largest distance of the tip from the first simulator's up to 0.5 s"},
    {"tip_um", "finest runs: x y z of the tip seen from the clamp, every 20 ms"},
};

constexpr Parameter settings[] = {
    {.name = "simulator",
     .help = "the one library to run",
     .choices = "all|simbody|bullet|mujoco|ode|mujoco_3|jolt"},
};

constexpr double same_scene_until = 0.5;  // s; later, small differences have grown

struct Run {
  Track track;
  double wall_s = 0;
  double gave_up_at = 0;  // s; 0: it did not
};

/// Finite; no more energy than gravity and the clamp can have given (falling by 2 L); the
/// tip at most 5 % farther than the strand is long.
bool sane(const Motion& motion, const Swing& swing) {
  const double most = 2 * swing.mass() * swing.links * -Swing::gravity_z * Swing::length;
  const double reach = 1.05 * Swing::length;
  return motion.kinetic_energy <= most && dot(motion.tip, motion.tip) <= reach * reach;
}

Run simulate(const Method& method, const Swing& swing, int steps_per_sample) {
  const double dt = sample / steps_per_sample;
  const std::unique_ptr<Simulator> simulator = method.make(swing, dt);
  Run run;
  for (int i = 0; i < samples; ++i) {
    run.wall_s += simulator->advance(i * sample, dt, steps_per_sample);
    const Motion motion = simulator->motion();
    if (!sane(motion, swing)) {
      run.gave_up_at = (i + 1) * sample;
      return run;
    }
    run.track.push_back(motion.tip);
  }
  return run;
}

/// Whole micrometres: 2.5e-6 of the strand's length, below every error of the table.
std::string text(const Track& track) {
  std::string all;
  for (const Vec& tip : track) {
    if (!all.empty()) all += ' ';
    all += fmt::format("{:.0f} {:.0f} {:.0f}", 1e3 * tip.x, 1e3 * tip.y, 1e3 * tip.z);
  }
  return all;
}

Track read_track(std::string_view text) {
  std::vector<double> um;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    at = std::from_chars(at, end, um.emplace_back()).ptr;
    if (at != end) ++at;  // the blank
  }
  Track track;
  for (std::size_t i = 0; i + 2 < um.size(); i += 3)
    track.push_back(1e-3 * load3(&um[i]));
  return track;
}

void measure(const Method& method, const Swing& swing, int steps_per_sample, int repeat,
             const ContinuousRod& rod, Row& row) {
  constexpr double long_run = 0.2;  // s; beyond it one interruption is a small part
  const int steps = samples * steps_per_sample;
  Run run = simulate(method, swing, steps_per_sample);
  std::vector<double> walls = {run.wall_s};
  if (run.wall_s < long_run) {
    walls.clear();  // that one warmed the caches
    for (int i = 0; i < repeat; ++i) {
      walls.push_back(simulate(method, swing, steps_per_sample).wall_s);
    }
  }
  row.set("steps", steps);
  if (run.gave_up_at > 0) {
    row.failed("unstable",
               fmt::format("not finite, energy beyond bound or too long at {} s",
                           run.gave_up_at));
    return;
  }
  row.set("wall_s", median(walls)).set("us_per_step", 1e6 * median(walls) / steps);
  row.set("total_error_rel", rod.distance(run.track));
  row.set("tip_um", text(run.track));
}

/// Steps per sample of the finest run: errors fall as dt^order, so that one of first
/// order needs more of them for a reference of use at 0.1 %. In single precision shorter
/// steps lose to rounding what they gain: the velocity is that of a difference of
/// positions.
int finest_level(const Method& method, bool full) {
  if (method.precision == Precision::single) return 8;
  return (method.order == 1 ? 11 : 9) + (full ? 2 : 0);
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings given(line, settings);
  const std::string_view chosen = given.experiment().word("simulator");
  for (const std::string_view package : other_simulators::missing()) {
    tell("other_simulators: not in this build: {} was not found\n", package);
  }
  std::vector<int> elements = line.elements;
  if (elements.empty()) elements = line.full ? std::vector{5, 20, 80} : std::vector{20};
  std::shared_ptr<const ContinuousRod> continuous;
  if (!line.dry_run) {
    tell("other_simulators: the continuous rod\n");
    continuous = std::make_shared<const ContinuousRod>();
  }
  std::vector<Case> all;
  for (const Engine& engine : other_simulators::engines()) {
    if (chosen != "all" && chosen != engine.id) continue;
    for (const Method& method : engine.methods) {
      for (const int links : elements) {
        for (int level = 0; level <= finest_level(method, line.full); ++level) {
          const int steps_per_sample = 1 << level;
          Row identity;
          identity.set("simulator", engine.id).set("version", engine.version);
          identity.set("method", method.name).set("elements", links);
          identity.set("precision",
                       method.precision == Precision::single ? "single" : "double");
          identity.set("dt_s", sample / steps_per_sample);
          all.push_back({identity, [&method, links, steps_per_sample, continuous,
                                    repeat = line.repeat](Row& row, const Deadline&) {
                           measure(method, Swing{links}, steps_per_sample, repeat,
                                   *continuous, row);
                         }});
        }
      }
    }
  }
  return all;
}

using Series = std::vector<Row*>;  // one simulator, method and N; from coarse to fine

std::vector<Series> series(std::vector<Row>& rows) {
  const auto same = [](const Row& a, const Row& b) {
    return std::ranges::all_of(
        std::initializer_list<std::string_view>{"simulator", "method", "elements"},
        [&](std::string_view column) { return a.text(column) == b.text(column); });
  };
  std::vector<Series> all;
  for (Row& row : rows) {
    const auto place =
        std::ranges::find_if(all, [&](const Series& s) { return same(*s.front(), row); });
    if (place == all.end()) {
      all.push_back({&row});
    } else {
      place->push_back(&row);
    }
  }
  for (Series& one : all) {
    std::ranges::sort(one, std::greater(),
                      [](const Row* r) { return r->number("dt_s"); });
  }
  return all;
}

double rms_distance(const Track& a, const Track& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

void mark_cheapest(const Series& runs, std::string_view column, double bound) {
  Row* best = nullptr;
  for (Row* row : runs) {
    row->set(column, false);
    const bool within = row->ok() && row->number("tip_error_rel") <= bound;
    if (within && (best == nullptr || row->number("wall_s") < best->number("wall_s"))) {
      best = row;
    }
  }
  if (best != nullptr) best->set(column, true);
}

/// Errors against the finest run, whose track alone stays in the table; a resumed table
/// is completed by it again.
void add_errors(const Series& runs) {
  const Row& finest = *runs.back();
  const Track reference = read_track(finest.text("tip_um"));
  for (Row* row : runs) {
    if (row == &finest || !finest.ok() || row->text("tip_um").empty()) continue;
    const double error = rms_distance(read_track(row->text("tip_um")), reference);
    row->set("tip_error_rel", error / Swing::length).set("tip_um", "");
  }
  const auto unstable =
      std::find_if(runs.rbegin(), runs.rend(), [](const Row* r) { return !r->ok(); });
  for (Row* row : runs) row->set("largest_stable", false);
  if (unstable != runs.rbegin()) (*std::prev(unstable))->set("largest_stable", true);
  mark_cheapest(runs, "cheapest_1pct", 0.01);
  mark_cheapest(runs, "cheapest_0p1pct", 0.001);
}

/// How far each finest run is from the first one of the same N, while they must agree.
void add_distances(const std::vector<Series>& all) {
  const auto until = static_cast<std::ptrdiff_t>(std::lround(same_scene_until / sample));
  for (const Series& runs : all) {
    const auto first = std::ranges::find_if(all, [&](const Series& other) {
      return other.back()->ok() &&
             other.back()->text("elements") == runs.back()->text("elements");
    });
    if (!runs.back()->ok()) continue;
    const Track ours = read_track(runs.back()->text("tip_um"));
    const Track theirs = read_track((*first).back()->text("tip_um"));
    double largest = 0;
    for (auto i = 0; i < until; ++i) {
      const auto at = static_cast<std::size_t>(i);
      largest = std::max(largest, rms_distance({ours[at]}, {theirs[at]}));
    }
    runs.back()->set("apart_mm", largest);
  }
}

void derive(std::vector<Row>& rows) {
  const std::vector<Series> all = series(rows);
  for (const Series& runs : all) add_errors(runs);
  add_distances(all);
}

void check_other_simulators(const std::vector<Row>& rows, Verdicts& verdicts) {
  double apart = 0;
  int compared = 0;
  for (const Row& row : rows) {
    if (!row.has("apart_mm") || row.text("precision") == "single") continue;
    ++compared;
    apart = std::max(apart, row.number("apart_mm"));
  }
  const std::string claim =
      "in double precision the tips of the other simulators agree within 2 mm (1 % of "
      "the length) up to 0.5 s";
  if (compared < 2) {
    verdicts.not_judged(claim);
  } else {
    verdicts.check(claim, apart <= 2, apart);
  }
}

/// A step too large for a simulator is where its curve ends, not a mistake.
bool finding(const Row& row) { return row.status() == "unstable"; }

constexpr Unused unused[] = {
    {"models", "the other_simulators have their own; --set simulator=mujoco chooses one"},
    {"integrators", "the other_simulators have their own"},
    not_random};

}  // namespace
}  // namespace tress::experiments::other_simulators

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::other_simulators;
  const Experiment experiment{
      .name = "other_simulators",
      .question = "how much time do other simulators need for the same strand?",
      .example = "--elements 5,20 --set simulator=mujoco",
      .columns = columns,
      .settings = settings,
      .unused = unused,
      .cases = cases,
      .derive = derive,
      .checks = check_other_simulators,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
