#pragma once

#include <toml++/toml.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::scene_runs {

/// A scene that runs step by step under commands. Every change makes a new World from the
/// changed scene, which continues from the present state; multistep methods restart
/// there.
class LiveRun {
 public:
  /// Throws InputError as read_scene() and World do.
  LiveRun(const std::string& file, int threads, bool guard);

  /// Executes a command, a JSON object {"do": ...}:
  ///
  ///     step     takes `steps` steps, or fewer if they last longer than `within_s`
  ///     restart  returns to t = 0 with the present values and no pull
  ///     set      sets `key` of the scene to `value`
  ///     pull     pulls the point at the fraction `at` of the strand number `strand`
  ///              (0 if left out) to `target` (m) with a spring of `stiffness_n_m`
  ///     release  ends the pull
  ///
  /// Throws InputError if it is refused; the run is then unchanged.
  void execute(const nlohmann::json& command);

  /// Returns the present picture in the player's format, with the state of the run.
  nlohmann::json frame();
  /// Returns the numbers of the scene that `set` may change, by key.
  nlohmann::json keys() const;
  /// Returns the scene's file, as in messages.
  const std::string& file() const { return file_; }
  /// Returns the default stiffness of a pull: ten times the larger of the strand's weight
  /// over its length and its bending stiffness 3 EI/L^3, N/m.
  double usual_stiffness() const;

 private:
  struct Made {
    std::unique_ptr<Scene> scene;  // Readout refers to it
    std::unique_ptr<World> world;
    std::unique_ptr<Readout> readout;
  };
  Made make(const toml::table& text, const std::optional<EffectChoice>& pull,
            const Snapshot* state) const;
  void take(Made made);
  void step(long steps, double within_s);
  void restart();
  void set(const std::string& key, const nlohmann::json& value);
  void pull(const nlohmann::json& command);
  void release();
  Snapshot state();

  std::string file_;
  int threads_;
  bool guard_;
  toml::table text_;
  std::optional<EffectChoice> pull_;
  Made now_;
  nlohmann::json shown_;  // the last picture of a possible state
  Snapshot good_;         // its state
  std::string failure_;
  double begin_ = 0;  // s, time from which steps are counted
  long counted_ = 0, steps_ = 0;
  double wall_s_ = 0, simulated_s_ = 0;
};

/// Executes commands from standard input, one a line, until it ends. Answers each with a
/// line on standard output: frame(), or {"refused": reason}.
int run_live(const std::string& file, int threads, bool guard);

}  // namespace tress::experiments::scene_runs
