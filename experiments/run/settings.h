#pragma once

#include <span>
#include <string>
#include <string_view>

#include "contract/integrator.h"
#include "contract/parameters.h"
#include "experiments/run/command_line.h"
#include "models/catalogue.h"

namespace tress::experiments {

/// Assigns each `--set key=value` to its owner, the first that has the key. Owners are
/// the experiment's own settings, the integrators' options, and the parameters of the
/// selected models (all models when none is selected). The constructor checks everything.
class Settings {
 public:
  /// Throws InputError on an unknown model, integrator or key (naming the nearest valid
  /// one) and on a value that the owner rejects.
  Settings(const CommandLine& line, std::span<const Parameter> experiment);

  /// The experiment's own settings: defaults overridden by the user's values.
  const Parameters& experiment() const { return experiment_; }

  /// `start` overridden by the user's values.
  Options options(Options start = {}) const;

  /// Defaults of `model` overridden by the user's values; keys unknown to it are ignored.
  Parameters parameters(const ModelEntry& model) const;

  /// Throws InputError on a model key: a scene defines these itself.
  void leave_models_to_the_scene() const;

  /// Whether the user set this key, whoever owns it.
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

/// Throws InputError on --models and --elements: a scene defines its own models and
/// discretisation.
void leave_strands_to_the_scene(const CommandLine& line);

}  // namespace tress::experiments
