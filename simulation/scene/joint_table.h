#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "contract/system.h"
#include "models/joints/joint.h"
#include "simulation/files/toml_text.h"
#include "simulation/scene/scene.h"
#include "simulation/scene/support_table.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// Returns the keys of [joints].
std::span<const Parameter> joint_table_parameters();
/// Reads one [[joints]], whose ends are a strand and a point. Throws InputError with
/// file:line:column.
Table read_joint(const toml::table& table, const std::string& file);

/// The joints of a scene. Keeps no reference to it.
class SceneJoints {
 public:
  /// Reads the scene's tables. Throws InputError with the location of a joint of a strand
  /// that does not exist, and of strands with equal names.
  explicit SceneJoints(const Scene& scene);

  /// Strands first to first + count - 1, which their joints make one system. Bodies that
  /// strands drive make all strands of the scene one system.
  struct Group {
    std::size_t first = 0;              // number of the first strand
    std::size_t count = 1;              // number of strands
    std::vector<std::size_t> joints{};  // numbers of tables
  };
  /// Returns true if joints or supports on driven bodies hold a group.
  bool hold(const Group& group) const {
    return !group.joints.empty() || !on_bodies_.empty();
  }
  /// Returns true if the scene has joints.
  bool any() const { return !ends_.empty(); }
  /// Returns all groups, ascending.
  const std::vector<Group>& groups() const { return groups_; }
  /// Returns the group that begins with a strand; null if there is none.
  const Group* beginning_with(std::size_t strand) const;
  /// Returns the group of a strand; null if it is a system of its own.
  const Group* of(std::size_t strand) const;
  /// Returns the names of all joints, group after group.
  std::vector<NamedSupport> named() const;
  /// Returns the locations of the joints of a group, then of supports on driven bodies.
  std::vector<std::string> places(const Group& group) const;
  /// Returns the location of the first joint, which must exist.
  const std::string& place() const;

  /// Returns the strands of a group, as SceneSupports::on() makes them, with their
  /// joints and those of the driven bodies among `effects` that carry supports. Throws
  /// InputError with the location of a joint or a support that the strands do not admit.
  std::unique_ptr<System> join(const Group& group,
                               std::vector<std::unique_ptr<System>> systems,
                               std::span<const Strand* const> strands,
                               const models::Effects& effects) const;
  /// Throws InputError with its location if the rest of the scene does not admit joints.
  void check(const Scene& scene) const;

 private:
  /// A joint with the strands of its ends.
  struct Ends {
    std::size_t a, b;
  };
  const std::vector<Table>& tables() const;
  void read_ends(std::size_t strands);
  void find_groups(std::size_t strands);

  std::shared_ptr<const StrandTables> tables_;
  std::vector<Ends> ends_;  // of each table
  std::vector<BodySupport> on_bodies_;
  std::vector<Group> groups_;
};

/// Whether supports or joints hold strands, so that a run may need a formulation of
/// constraints.
bool has_constraints(const Scene& scene);

}  // namespace tress::simulation
