#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/parameters.h"
#include "integrators/gradient/known_forces.h"
#include "simulation/scene/scene.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// A number of a table, or a component of one, by which [gradient] differentiates.
struct GradientNumber {
  std::string key;                            // key of the number in its table
  std::optional<std::size_t> component = {};  // of three
  double value = 0;                           // value in the scene, in the unit
  double measure = 1;                         // a change by s is one by s times this
  std::string unit = {};                      // unit of the value
  bool positive = false;                      // no value below 0 is allowed
  double min = -std::numeric_limits<double>::infinity();  // least value of the key
  double max = std::numeric_limits<double>::infinity();   // largest value of the key

  /// The text of the key for Parameters::set, changed by s.
  std::string text(const Parameters& values, double s) const;
};

/// The number `key`, "drag_kg_m_s" or "velocity_m_s.x", among `declared`. Throws
/// InputError with `place` and the whole `name` unless it is a number that can change a
/// little to both sides.
GradientNumber gradient_number(std::string_view name, std::string_view key,
                               std::span<const Parameter> declared,
                               const Parameters& values, const std::string& place);

/// Returns why a number of an effect does nothing: `profile = "constant" does not use
/// it`. Empty: it acts.
std::string unused_number(const models::EffectEntry& effect, std::string_view key,
                          const Parameters& values);

/// Returns why runs have no derivative by a number of a table or an effect. Empty: they
/// have one.
std::string_view no_derivative(std::string_view table, std::string_view key);

/// Returns the law of an effect's force in one of its numbers: smooth under gravity and
/// viscous drag, affine where models/affine_numbers.h declares it, unknown
/// otherwise.
integrators::ParameterLaw law_of_number(const EffectChoice& effect, std::string_view key);

/// "name.x" becomes "name", 0; empty without such an end.
std::optional<std::size_t> take_component(std::string_view& name);
/// Unit vector of the world's axis k.
Vec axis_of(std::size_t k);

/// Throws InputError: the motion has no derivative by `name`, with reason and remedy.
[[noreturn]] void refuse_gradient(std::string_view name, std::string_view reason,
                                  const std::string& place, std::string_view remedy);

/// [gradient]: by which numbers of a scene its motion is differentiated.
std::span<const Parameter> gradient_table_parameters();

/// One such number. Where strands have several values, all change in the same proportion.
struct SceneParameter {
  std::string name, unit;  // name as in [gradient], and unit of the value
  double value = 0;        // of the first strand, in the unit
  double measure = 1;      // s = 1 changes the value by so much
  /// Whether it moves the shape at rest, the start or the roots: the run then needs a
  /// damped start.
  bool moves_rest = false;
  /// Changes the value in a scene by s times the measure.
  std::function<void(Scene& scene, double s)> change;
  bool positive = false;  // a number above 0, which a fit changes in proportion
  double min = -std::numeric_limits<double>::infinity();  // least value of its key
  double max = std::numeric_limits<double>::infinity();   // largest value of its key
  /// Whether it places points, bodies or targets: lengths and angles of [root] and of
  /// effects.
  bool places = false;
  bool starts = false;  // whether it is the shape at t = 0
  /// Law of the forces in this number.
  integrators::ParameterLaw law = integrators::ParameterLaw::unknown;
};

/// Adds the number of [[supports]] or [[effects.point_moment]] with this name, such as
/// `supports_2.stiffness_n_per_m`. Returns false if the name is of no such table. Throws
/// InputError with `place` on a key by which nothing can be differentiated.
bool add_table_parameter(const Scene& scene, std::string_view name,
                         const std::string& place, std::vector<SceneParameter>& to);
/// Returns the names of all such numbers.
std::vector<std::string> table_parameter_names(const Scene& scene);

/// Returns the parameters that the scene's [gradient] names. Throws InputError with its
/// location on a name that is no number of the scene, or by which nothing can be
/// differentiated.
std::vector<SceneParameter> gradient_parameters(const Scene& scene);
/// Returns the parameters with these names; messages name `place`.
std::vector<SceneParameter> gradient_parameters(const Scene& scene,
                                                std::span<const std::string> names,
                                                const std::string& place);

}  // namespace tress::simulation
