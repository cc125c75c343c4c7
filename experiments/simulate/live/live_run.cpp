#include "experiments/simulate/live/live_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <utility>

#include "contract/input_error.h"
#include "contract/read_file.h"
#include "contract/shipped_file.h"
#include "experiments/simulate/live/scene_keys.h"
#include "models/effects/tether.h"
#include "simulation/errors/pilot.h"
#include "simulation/export/export.h"
#include "simulation/files/toml_text.h"

namespace tress::experiments::scene_runs {
namespace {

using nlohmann::json;

/// Of an effect that no scene file can name: it may stand next to its own tether.
const EffectEntry& pull_entry() {
  static const EffectEntry entry{.id = "pull",
                                 .summary = "the pull of a live run",
                                 .source = "",
                                 .parameters = tether_parameters(),
                                 .make = make_tether};
  return entry;
}

double number_of(const json& command, const char* key) {
  const auto found = command.find(key);
  if (found == command.end() || !found->is_number()) {
    throw InputError(fmt::format("'{}' is not a number", key), "live command",
                     "give a number");
  }
  return found->get<double>();
}

std::vector<std::array<std::size_t, 3>> sizes(const Snapshot& snapshot) {
  std::vector<std::array<std::size_t, 3>> all;
  for (const auto& one : snapshot.strands) {
    all.push_back({one.q.size(), one.v.size(), one.memory.size()});
  }
  return all;
}

}  // namespace

LiveRun::LiveRun(const std::string& file, int threads, bool guard)
    : file_(shipped_file(file)),
      threads_(threads),
      guard_(guard),
      text_(parse_toml(read_file(file_, most_toml_bytes), file_)) {
  // Read once as it is, for places in messages.
  static_cast<void>(read_scene(file));
  take(make(text_, {}, nullptr));
}

LiveRun::Made LiveRun::make(const toml::table& text,
                            const std::optional<EffectChoice>& pull,
                            const Snapshot* state) const {
  std::ostringstream out;
  out << text;
  Made made;
  made.scene = std::make_unique<Scene>(parse_scene(out.str(), file_));
  if (wants_pilot(*made.scene))
    *made.scene = simulation::pilot(*made.scene, threads_).scene;
  if (!guard_) made.scene->guard = false;
  // Held shapes are those without the pull.
  std::vector<HeldShape> held;
  if (pull) {
    if (made.scene->rest == RestStrains::inverse)
      held = World(*made.scene, threads_).held();
    made.scene->effects.push_back(*pull);
  }
  made.world = std::make_unique<World>(*made.scene, threads_, std::move(held));
  if (state != nullptr) {
    if (sizes(*state) != sizes(made.world->snapshot())) {
      throw InputError(
          "the change is not for a run under way: it changes the number of "
          "coordinates",
          "t > 0", "restart the run, then change it");
    }
    made.world->restore(*state);
  }
  made.readout = std::make_unique<Readout>(*made.scene, *made.world);
  return made;
}

/// From here on failures, guards and the count of steps begin again.
void LiveRun::take(Made made) {
  now_ = std::move(made);
  failure_.clear();
  begin_ = now_.world->time();
  counted_ = 0;
  shown_ = nullptr;
  good_ = state();
}

Snapshot LiveRun::state() {
  Snapshot snapshot = now_.world->snapshot();
  // The account of energy would count a change of the scene as an error.
  snapshot.guards.clear();
  return snapshot;
}

void LiveRun::step(long steps, double within_s) {
  using Clock = std::chrono::steady_clock;
  if (!failure_.empty()) return;
  static_cast<void>(frame());
  World& world = *now_.world;
  const double h =
      now_.scene->chooses_steps() ? 1 / now_.scene->frame_rate : now_.scene->options.step;
  const auto start = Clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const double t = world.time();
  for (long i = 0; i < steps && (i == 0 || elapsed() < within_s); ++i) {
    const Status s = world.advance(begin_ + static_cast<double>(++counted_) * h);
    ++steps_;
    if (s == Status::ok) continue;
    failure_ = world.failure();
    return;
  }
  wall_s_ = elapsed();
  simulated_s_ = world.time() - t;
  shown_ = nullptr;
  good_ = state();
}

json LiveRun::frame() {
  if (shown_.is_null()) {
    const std::vector<Frame3d> frames{now_.readout->read(*now_.world)};
    const std::vector<DrawnLine> lines =
        drawn_lines(*now_.scene, *now_.world, now_.readout->lines());
    const SmoothLines curves(now_.readout->lines(), frames);
    shown_ = json::parse(page_json({*now_.scene, now_.readout->series(),
                                    now_.readout->channels(), lines, frames, curves}));
  }
  return {{"picture", shown_},
          {"steps", steps_},
          {"pulled", pull_.has_value()},
          {"failed", failure_},
          {"wall_per_s", simulated_s_ > 0 ? json(wall_s_ / simulated_s_) : json()}};
}

void LiveRun::restart() {
  Made made = make(text_, {}, nullptr);
  pull_.reset();
  steps_ = 0;
  simulated_s_ = 0;
  take(std::move(made));
}

void LiveRun::set(const std::string& key, const json& value) {
  toml::table changed = text_;
  set_key(changed, key, value);
  const bool started = good_.t > 0;
  Made made = make(changed, pull_, started ? &good_ : nullptr);
  text_ = std::move(changed);
  take(std::move(made));
}

void LiveRun::pull(const json& command) {
  const std::vector<Strand>& strands = now_.scene->strands;
  refuse_if(strands.empty(),
            "a pull is for a strand, and this model has a geometry of its own",
            "live run", "take a scene with a [strand] to pull it");
  const json which = command.value("strand", json(0U));
  refuse_if(
      !which.is_number_unsigned() || which.get<std::size_t>() >= strands.size(),
      fmt::format("'strand' is no strand of the scene, which has {}", strands.size()),
      "live command", "give its number, from 0 on");
  const auto strand = which.get<std::size_t>();
  const auto target = command.find("target");
  if (target == command.end() || !target->is_array() || target->size() != 3 ||
      !std::ranges::all_of(*target, [](const json& x) { return x.is_number(); })) {
    throw InputError("'target' is no place", "live command", "give three numbers");
  }
  const double k = number_of(command, "stiffness_n_m");
  EffectChoice choice{&pull_entry(), Parameters(tether_parameters(), "the pull"), strand};
  const auto set = [&](const char* key, double x) {
    choice.parameters.set(key, number_text(x));
  };
  set("at", number_of(command, "at"));
  set("stiffness_n_m", k);
  set("damping_n_s_m", std::sqrt(std::max(0.0, k) * strands[strand].mass()));
  choice.parameters.set(
      "target_m", fmt::format("{},{},{}", (*target)[0].get<double>(),
                              (*target)[1].get<double>(), (*target)[2].get<double>()));
  set("t_on_s", -1);  // at its full strength at once
  Made made = make(text_, choice, &good_);
  pull_ = std::move(choice);
  take(std::move(made));
}

void LiveRun::release() {
  if (!pull_) return;
  Made made = make(text_, {}, &good_);
  pull_.reset();
  take(std::move(made));
}

void LiveRun::execute(const json& command) {
  const std::string what = command.value("do", "");
  if (what == "step") {
    step(std::clamp(command.value("steps", 1L), 1L, 1'000'000L),
         command.value("within_s", 1.0));
  } else if (what == "restart") {
    restart();
  } else if (what == "set") {
    set(command.value("key", ""), command.contains("value") ? command["value"] : json());
  } else if (what == "pull") {
    pull(command);
  } else if (what == "release") {
    release();
  } else {
    throw InputError(fmt::format("unknown command '{}'", what), "live command",
                     "give step, restart, set, pull or release");
  }
}

json LiveRun::keys() const { return scene_keys(text_); }

double LiveRun::usual_stiffness() const {
  if (now_.scene->strands.empty()) return 0;
  constexpr double g = 9.81;  // m/s^2
  const Strand& strand = now_.scene->strands.front();
  const double length = strand.length();
  const Vec stiff = stiffness(strand, strand.segments.front());
  return 10 * std::max(strand.mass() * g / length,
                       3 * std::max(stiff.y, stiff.z) / (length * length * length));
}

}  // namespace tress::experiments::scene_runs
