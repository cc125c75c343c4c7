#include "simulation/scene/support_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "models/strand/arc_lengths.h"
#include "models/strand/geometry.h"
#include "models/supports/supported_system.h"
#include "simulation/driven/strand_drives.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/scene/scene_check.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_keys.h"
#include "simulation/scene/support_path.h"
#include "simulation/scene/support_reach.h"

namespace tress::simulation {

using models::HeldPart;
using models::StrandPlace;
using models::Support;
using models::SupportedSystem;

namespace {

/// Index of the material point that `at` names.
int point_of(const Table& table, const Strand& strand) {
  return point_at(table.values().word("at"), strand,
                  fmt::format("strand {}", table.values().whole("strand")),
                  table.place("at"));
}

NamedSupport name_of(const Table& table) {
  const std::string_view kind = table.values().word("kind");
  const std::string name = fmt::format("strand_{}_at_{}", table.values().whole("strand"),
                                       table.values().word("at"));
  return {name, kind != "direction", kind != "ball",
          "the support " + name + " on the strand"};
}

/// The edge at an end of a strand.
const models::Segment& edge_at(const Strand& strand, int point) {
  return point == 0 ? strand.segments.front() : strand.segments.back();
}

/// The section of the rod at an end of a strand in its shape at the start. `section`:
/// that of the model, whose half edge is natural.
Frame end_at_start(System& system, const Strand& strand, int point,
                   const Frame& section) {
  const Sections::Kind kind = sections(system)->section_kind(point);
  if (!kind.half_edge) return section;
  if (kind.natural_half) {
    return section * models::strain_of_half(edge_at(strand, point), point > 0);
  }
  return joints(strand, models::ShapeOf::initial,
                models::root_place(strand))[static_cast<std::size_t>(point)]
      .frame;
}

/// Prepares a support for the joint of half an edge, whose rest is the natural shape.
void strain_half_edge(const Strand& strand, const Sections::Kind& kind,
                      Support& support) {
  using models::ShapeOf;
  const models::Segment& edge = edge_at(strand, support.point);
  const bool tip = support.point > 0;
  support.half_edge = models::rod_joint(strand, nullptr, edge, {});
  if (kind.natural_half) {
    support.begin = models::inverse(models::strain_of_half(edge, tip));
    return;
  }
  // The wall turns to the direction in which it holds the middle of a natural edge.
  const Frame natural = models::chord_at_end(edge, ShapeOf::natural, tip);
  support.path.frame = support.path.frame * natural;
  support.begin =
      models::inverse(natural) * models::chord_at_end(edge, ShapeOf::initial, tip);
  const Vec across{0, support.hinge.y, support.hinge.z};
  if (norm(across) > 0) support.hinge = (1 / norm(across)) * across;
}

/// The axis of a hinge in the components of the section at the start.
Vec hinge_axis(const Table& table, const Frame& section) {
  const char* const remedy =
      "give [supports] axis, such as [0, 1, 0] for a strand along x that turns in a "
      "vertical plane";
  const Vec axis = section.back(table.values().vec("axis"));
  const double length = norm(axis);
  const std::string& place =
      table.given("axis") ? table.place("axis") : table.place("kind");
  refuse_if(length == 0, "a hinge without an axis", place, remedy);
  refuse_if(std::abs(axis.x) > 1e-6 * length,
            fmt::format("the axis of a hinge {:.3g} deg off the plane across the strand",
                        std::asin(std::min(1.0, std::abs(axis.x) / length)) * 180 /
                            std::numbers::pi),
            place, "give an axis perpendicular to the direction of the strand there");
  const Vec across{0, axis.y, axis.z};
  return (1 / norm(across)) * across;
}

}  // namespace

int point_at(std::string_view at, const Strand& strand, const std::string& name,
             const std::string& place) {
  constexpr const char* remedy = "give \"tip\", \"root\" or a number of 0 to 1";
  if (at == "tip") return static_cast<int>(strand.segments.size());
  if (at == "root") return 0;
  const auto share = decimal(at);
  refuse_if(!share, fmt::format("no point at {} of {}", at, name), place, remedy);
  return end_of_element(*share, strand, name, place, remedy);
}

SceneSupports::SceneSupports(const Scene& scene)
    : tables_(scene.tables),
      model_(scene.model),
      model_options_(scene.model_options),
      duration_(scene.duration) {
  // Motions are read from tables: only for the scenes that need them.
  const auto on_body = [](const Table& table) {
    return !table.values().word("on").empty();
  };
  if (std::ranges::none_of(tables(), on_body)) return;
  carriers_ = carriers(scene);
  for (const DrivenName& body : driven_body_names(scene)) driven_.push_back(body.name);
}

const std::vector<Table>& SceneSupports::tables() const {
  static const std::vector<Table> none;
  return tables_ == nullptr ? none : tables_->supports;
}

bool SceneSupports::drive() const { return tables_ != nullptr && tables_->driven.any(); }

bool SceneSupports::constrain() const {
  return !std::ranges::all_of(tables(), compliant);
}

std::string SceneSupports::table_name() const {
  return tables().empty() ? tables_->driven.first().name() : tables().front().name();
}

const std::string& SceneSupports::first_place() const {
  return tables().empty() ? tables_->driven.first().place() : tables().front().place();
}

std::vector<const Table*> SceneSupports::of(std::size_t strand) const {
  std::vector<const Table*> own;
  for (const Table& table : tables()) {
    if (std::ranges::count(driven_, table.values().word("on")) > 0) continue;
    if (table.values().whole("strand") == static_cast<int>(strand)) own.push_back(&table);
  }
  return own;
}

std::vector<BodySupport> SceneSupports::on_bodies() const {
  std::vector<BodySupport> all;
  for (const Table& table : tables()) {
    const auto body = std::ranges::find(driven_, table.values().word("on"));
    if (body == driven_.end()) continue;
    all.push_back({&table, static_cast<std::size_t>(body - driven_.begin())});
  }
  return all;
}

std::vector<NamedSupport> SceneSupports::named_on_bodies() const {
  std::vector<NamedSupport> all;
  for (const BodySupport& support : on_bodies()) all.push_back(name_of(*support.table));
  return all;
}

std::vector<NamedSupport> SceneSupports::named() const {
  std::vector<std::pair<int, NamedSupport>> all;
  for (const Table& table : tables()) {
    if (std::ranges::count(driven_, table.values().word("on")) > 0) continue;
    all.emplace_back(table.values().whole("strand"), name_of(table));
  }
  std::ranges::stable_sort(all, {}, &std::pair<int, NamedSupport>::first);
  std::vector<NamedSupport> named;
  for (auto& [strand, support] : all) named.push_back(std::move(support));
  return named;
}

Support SceneSupports::support(System& system, const Strand& strand, const Table& table,
                               const StrandPlace& start, int point) const {
  Support support;
  support.point = point;
  support.path = support_path(table, start, carriers_);
  const Parameters& values = table.values();
  support.compliance = {values.number("stiffness_n_per_m"),
                        values.number("damping_n_s_per_m"),
                        values.number("turn_stiffness_n_m_per_rad"),
                        values.number("turn_damping_n_m_s_per_rad")};
  const std::string_view kind = table.values().word("kind");
  if (kind == "direction") support.axes.clear();
  if (kind != "ball") {
    const auto held = models::section_to_hold(system, point, table.place("kind"));
    support.section = kind == "direction" ? HeldPart::tangent : HeldPart::frame;
    if (kind == "hinge") support.hinge = hinge_axis(table, start.frame);
    refuse_if(table.given("twist_rad") && held.turning != Sections::Turning::frame,
              "a twist of a model without frames of its sections",
              table.place("twist_rad"),
              "leave it out, or use a model with twist, such as \"der\" or, with modes = "
              "\"bend_twist\", \"super_helix\"");
    if (held.half_edge) strain_half_edge(strand, held, support);
  }
  stay_in_plane(model_options_, duration_, strand, table, support);
  let_slide(table, support);
  return support;
}

std::unique_ptr<System> SceneSupports::on(std::unique_ptr<System> system,
                                          const Strand& strand,
                                          std::size_t number) const {
  if (!change(number)) return system;
  const std::vector<const Table*> tables = of(number);
  const std::string& place = tables.empty() ? first_place() : tables.front()->place();
  models::check_unbranched(strand, place);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n), zero(n), x(3 * (strand.segments.size() + 1));
  system->initial_state(q, v);
  MaterialPoints* const points = system->material_points();
  refuse_if(points == nullptr ||
                points->count() != static_cast<int>(strand.segments.size()) + 1,
            "supports of a model without points at the ends of its elements", place,
            "use another model");
  points->positions(0, q, x);
  const bool inextensible =
      system->sparse_form() == nullptr || system->layout().constraints > 0;
  const std::vector<double> s = models::arc_lengths(strand);
  std::vector<Support> supports;
  std::vector<SupportedEnd> ends;
  supports.reserve(tables.size());
  if (!strand.free_root) ends.push_back({"root", 0, &strand.root});
  for (const Table* table : tables) {
    const int at = point_of(*table, strand);
    const auto point = static_cast<std::size_t>(at);
    refuse_if(point == 0 && !strand.free_root, "a support of the root, which is clamped",
              table->place("at"), "leave it out, or give [root] motion = \"free\"");
    refuse_if(std::ranges::any_of(supports,
                                  [&](const Support& one) { return one.point == at; }),
              "a second support of the same point", table->place(),
              "leave out one of them");
    StrandPlace start{load3(&x[3 * point]), {}};
    if (table->values().word("kind") != "ball") {
      models::section_to_hold(*system, at, table->place("kind"));
      start.frame = end_at_start(*system, strand, at,
                                 sections(*system)->section(0, q, v, zero, at).frame);
    }
    supports.push_back(support(*system, strand, *table, start, at));
    if (supports.back().rigid_axes().empty() || norm(table->values().vec("slide")) > 0) {
      continue;
    }
    const SupportedEnd end{fmt::format("support at {}", table->values().word("at")),
                           s[point], &supports.back().path};
    for (const SupportedEnd& other : ends) {
      check_reach(other, end, inextensible, duration_, *table);
    }
    ends.push_back(end);
  }
  models::StrandDrives drives =
      drives_of(tables_->driven, *system, strand, number, *model_, model_options_);
  for (std::size_t k = 0; k < drives.moments.size(); ++k) {
    for (const Support& one : supports) {
      models::refuse_on_support(*system, drives.moments[k], one,
                                tables_->driven.moments[k].place());
    }
  }
  try {
    return std::make_unique<SupportedSystem>(std::move(system), std::move(supports),
                                             std::move(drives));
  } catch (const InputError& error) {
    refuse_at(place, error);
  }
}

Formulation formulation_of_supports(const IntegratorEntry& entry, bool by_tolerance) {
  using enum Formulation;
  const bool projected = by_tolerance || entry.order(index3).value_or(0) < entry.order();
  const std::array preferred =
      entry.adaptive ? std::array{index2_ggl, projection, index3, baumgarte, rattle}
      : projected    ? std::array{projection, index3, index2_ggl, baumgarte, rattle}
                     : std::array{index3, projection, index2_ggl, baumgarte, rattle};
  for (const Formulation one : preferred) {
    if (entry.order(one)) return one;
  }
  return projection;
}

Options options_beside_supports(const System& system, Options options) {
  if (system.layout().constraints == 0) options.formulation = Formulation::parametric;
  return options;
}

void SceneSupports::check_strands(std::size_t strands) const {
  for (const Table& table : tables()) {
    const int strand = table.values().whole("strand");
    if (static_cast<std::size_t>(strand) < strands) continue;
    throw InputError(fmt::format("a support of strand {}", strand), table.place("strand"),
                     fmt::format("the scene has {} strand{}, the first is 0", strands,
                                 strands == 1 ? "" : "s"));
  }
}

void SceneSupports::check(const Scene& scene) const {
  if (!any()) return;
  const std::string& place = first_place();
  refuse_if(scene.rest == RestStrains::inverse,
            fmt::format("{} with rest = \"inverse\", which balances strands without its "
                        "forces",
                        table_name()),
            place, "leave out rest, or this table");
  const Parameters* interaction = scene.interaction();
  refuse_if(interaction != nullptr && interaction->word("coupling") == "monolithic",
            fmt::format("{} of strands that are one system", table_name()), place,
            "use [effects.strand_interaction] coupling = \"lagged\"");
  refuse_if(scene.friction() != nullptr,
            fmt::format("{} of strands that rub, whose impulses leave its forces out",
                        table_name()),
            place, "leave out [effects.strand_friction], or this table");
}

}  // namespace tress::simulation
