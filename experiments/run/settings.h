#pragma once

#include <span>
#include <string>
#include <string_view>

#include "contract/integrator.h"
#include "contract/parameters.h"
#include "experiments/run/command_line.h"
#include "models/catalogue.h"

namespace tress::experiments {

/// Who takes each `--set key=value`: the first of the experiment's own settings, the
/// integrators' options and the parameters of the selected models (all models when none
/// is selected) that knows the key. Everything is checked when this is built.
class Settings {
 public:
  /// Throws InputError on an unknown model, integrator or key (naming the nearest of all
  /// that could have been meant) and on a value that its owner refuses.
  Settings(const CommandLine& line, std::span<const Parameter> experiment);

  /// The experiment's own settings: defaults, then what the user set.
  const Parameters& experiment() const { return experiment_; }

  /// `start` with what the user set on top.
  Options options(Options start = {}) const;

  /// Defaults of `model`, then what the user set; keys it does not know are for others.
  Parameters parameters(const ModelEntry& model) const;

  /// Throws InputError on a key of models, which a scene says itself.
  void leave_models_to_the_scene() const;

  /// Whether the user set this key, wherever it went.
  bool chosen(std::string_view key) const;

 private:
  enum class Owner { experiment, integrators, models };
  Owner owner(std::string_view key, const std::string& where) const;
  /// Throws InputError on an option that none of the chosen integrators reads.
  void refuse_foreign(std::string_view key, const std::string& where) const;
  bool some_model_knows(std::string_view key) const;

  const CommandLine line_;
  const std::span<const Parameter> declared_;
  Parameters experiment_;
};

/// Throws InputError on --models and --elements where a scene says itself which model it
/// has and how its strands are cut.
void leave_strands_to_the_scene(const CommandLine& line);

}  // namespace tress::experiments
