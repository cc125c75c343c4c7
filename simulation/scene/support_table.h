#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/system.h"
#include "integrators/entry.h"
#include "models/supports/support_rows.h"
#include "simulation/driven/body_joints.h"
#include "simulation/files/toml_text.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/support_path.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// Returns the keys of [supports].
std::span<const Parameter> support_table_parameters();
/// Reads one [[supports]], whose `at` is a word or a number. Throws InputError with
/// file:line:column.
Table read_support(const toml::table& table, const std::string& file);

/// A support by its name: strand_0_at_tip.
struct NamedSupport {
  std::string name;       // names strand and point
  bool place, direction;  // whether it holds them
  std::string acting;     // what acts on what, in words
};

/// Returns the material point of a strand at "tip", "root" or a share of the arc length.
/// Throws InputError with `place` if no element ends there; `name` is that of the strand.
int point_at(std::string_view at, const Strand& strand, const std::string& name,
             const std::string& place);

/// The supports of a scene, and the moments and natural shapes that drive its strands.
/// Keeps no reference to it.
class SceneSupports {
 public:
  /// Reads the scene's tables, model, model options, duration and motions.
  explicit SceneSupports(const Scene& scene);

  /// Returns true if the scene has supports, moments or natural shapes over time.
  bool any() const { return !tables().empty() || drive(); }
  /// Returns true if the scene has moments or natural shapes over time.
  bool drive() const;
  /// Returns true if some support is a constraint, not a spring.
  bool constrain() const;
  /// Returns the name of the first of these tables, such as "[supports]".
  std::string table_name() const;
  /// Returns the names of all supports that are not on driven bodies, strand after
  /// strand.
  std::vector<NamedSupport> named() const;
  /// Returns the supports on driven bodies in the order of their tables.
  std::vector<BodySupport> on_bodies() const;
  /// Returns their names.
  std::vector<NamedSupport> named_on_bodies() const;
  /// Returns true if a strand has supports that are not on driven bodies.
  bool hold(std::size_t strand) const { return !of(strand).empty(); }
  /// Returns true if on() changes a strand.
  bool change(std::size_t strand) const { return drive() || hold(strand); }
  /// Returns the location of the first support of a strand, which must have one.
  const std::string& place(std::size_t strand) const {
    return of(strand).front()->place();
  }
  /// Returns the strand with its supports, moments and natural shapes, as a system;
  /// `system` itself if it has none. A support without keyframes holds its point where
  /// `system` begins. Throws InputError with the location of a support that the strand or
  /// its model does not admit.
  std::unique_ptr<System> on(std::unique_ptr<System> system, const Strand& strand,
                             std::size_t number) const;
  /// Throws InputError with its location if a support refers to a strand beyond this
  /// number of strands.
  void check_strands(std::size_t strands) const;
  /// Throws InputError with its location if the rest of the scene does not admit
  /// supports.
  void check(const Scene& scene) const;

 private:
  models::Support support(System& system, const Strand& strand, const Table& table,
                          const models::StrandPlace& start, int point) const;
  const std::vector<Table>& tables() const;
  std::vector<const Table*> of(std::size_t strand) const;
  /// Returns the location of the first of all tables.
  const std::string& first_place() const;

  std::shared_ptr<const StrandTables> tables_;
  const ModelEntry* model_;
  Parameters model_options_;
  double duration_;
  std::vector<Carrier> carriers_;
  std::vector<std::string> driven_;  // names of the driven bodies
};

/// Returns the formulation of supports and joints that suits a method. It is index 3 for
/// a method of fixed step that keeps its order there, and index 2 for IDA. Others, and
/// runs with a tolerance, have projection.
Formulation formulation_of_supports(const integrators::IntegratorEntry& entry,
                                    bool by_tolerance);

/// Returns the options of one strand of a scene: a strand without constraints, next to
/// others on supports, has no formulation of them.
Options options_beside_supports(const System& system, Options options);

}  // namespace tress::simulation
