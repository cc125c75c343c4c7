// Why a scene does not run as one batch: physics, or a request of the scene.
#include <fmt/format.h>

#include "contract/read_file.h"
#include "contract/shipped_file.h"
#include "simulation/files/toml_text.h"
#include "simulation/head/no_head.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {
namespace {

/// Strands that are no systems of their own, or that are not all simulated.
std::optional<NoHead> no_strand_alone(const Scene& scene) {
  const std::span<const StrandSource> sources =
      scene.tables == nullptr ? std::span<const StrandSource>() : scene.tables->sources;
  for (const StrandSource& source : sources) {
    if (source.groom && source.table.values().whole("guides") > 0) {
      return NoHead{"all strands of a batch are simulated", "leave out guides", "",
                    source.table.place("guides")};
    }
  }
  if (SceneJoints(scene).any()) {
    return NoHead{"[joints] make one system of several strands",
                  "leave them out, or give --as strands", "joints"};
  }
  if (has_driven_bodies(scene)) {
    return NoHead{
        "[effects.body] with moves = \"turns\" or \"free\" makes one system of strand "
        "and body",
        "use another motion, or give --as strands", "effects.body"};
  }
  if (scene.friction() != nullptr) {
    return NoHead{"[effects.strand_friction] solves the contacts of all strands together",
                  "leave it out, or give --as strands", "effects.strand_friction"};
  }
  if (scene.mesh() != nullptr) {
    return NoHead{"[effects.control_mesh] ties all strands into one mesh",
                  "leave it out, or give --as strands", "effects.control_mesh"};
  }
  if (scene.rest == RestStrains::inverse && scene.unstable == Unstable::drop) {
    return NoHead{"unstable = \"drop\" leaves strands out before the run",
                  "use unstable = \"stiffen\" or \"keep\", or give --as strands",
                  "unstable"};
  }
  const Parameters* interaction = scene.interaction();
  if (interaction == nullptr) return {};
  if (!scene.strands.front().root.teleports.empty()) {
    return NoHead{
        "strands that touch exchange their places once a step, and a teleport "
        "is within a step",
        "give --as strands, or leave out rows with the same time", "root.motion"};
  }
  if (interaction->word("coupling") == "monolithic") {
    return NoHead{"strands with monolithic coupling are one system",
                  "give [effects.strand_interaction] coupling = \"lagged\"",
                  "effects.strand_interaction.coupling"};
  }
  if (scene.options.tolerance > 0) {
    return NoHead{"strands that touch and choose their steps share their intervals",
                  "give dt_s instead of position_tol_rel, or --as strands",
                  "integrator.position_tol_rel"};
  }
  return {};
}

}  // namespace

std::string place_of(const NoHead& no, const std::string& file) {
  if (!no.place.empty() || no.key.empty()) return no.place.empty() ? file : no.place;
  const std::string there = shipped_file(file);
  return place_of_key(parse_toml(read_file(there, most_toml_bytes), there), no.key,
                      there);
}

std::optional<NoHead> no_head(const SceneOutline& outline, models::HeadNumber number) {
  const Scene& scene = outline.scene;
  if (scene.strands.empty()) {
    return NoHead{fmt::format("{} brings its own geometry and is one system: there are "
                              "no strands to batch",
                              scene.model->id),
                  "give --as strands", "model.id"};
  }
  if (auto no = no_strand_alone(scene)) return no;
  const auto without = no_lanes(scene, number);
  if (without && number != models::HeadNumber::float64) {
    const bool named = without->remedy.find("--precision 64") != std::string::npos;
    return NoHead{"no SIMD lanes for " + without->reason,
                  without->remedy + (named ? "" : ", or --precision 64"), without->key,
                  without->place};
  }
  const Options& options = scene.options;
  if (!scene.chooses_steps() &&
      1 / scene.frame_rate / options.step > static_cast<double>(options.max_steps)) {
    return NoHead{"more than max_steps steps of dt_s from frame to frame",
                  "give a longer dt_s, or more frames_per_s", "integrator.dt_s"};
  }
  return {};
}

}  // namespace tress::simulation
