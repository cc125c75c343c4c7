#include "simulation/scene/support_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "models/strand/arc_lengths.h"
#include "models/strand/geometry.h"
#include "models/supports/supported_system.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_path.h"
#include "simulation/scene/support_reach.h"
#include "simulation/table/read_table.h"

namespace tress::simulation {

using models::HeldPart;
using models::StrandPlace;
using models::Support;
using models::SupportedSystem;

namespace {

constexpr double farthest_place = 1e6;

constexpr Parameter support_parameters[] = {
    {.name = "strand",
     .help = "number of the strand, the first is 0",
     .number = 0,
     .min = 0,
     .max = 1e6,
     .whole = true},
    {.name = "at",
     .help =
         "point that is held: \"tip\", \"root\" (motion = \"free\"), or a number such as "
         "0.5. The number is the arc length from the root over the length, 0 to 1, of "
         "an element's end",
     .text = true,
     .fallback = "tip"},
    {.name = "kind",
     .help =
         "held part. `ball`: the position. `clamp`: position, direction and twist (if "
         "the model has a frame there). `direction`: the direction alone. `hinge`: as "
         "`clamp`, but free to turn about `axis`",
     .choices = "ball|clamp|direction|hinge"},
    {.name = "axis",
     .help = "axis of a hinge in the world, across the direction of the strand at the "
             "start, of any length",
     .min = -farthest_place,
     .max = farthest_place,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "keyframes",
     .help =
         "rows of t, x, y, z (s, m): places of the support in the world, t ascending. "
         "It moves in straight lines, quintic in time, and rests at each. One row: a "
         "fixed place. None: the place of the point at the start",
     .min = -farthest_place,
     .max = farthest_place,
     .components = 4,
     .rows = true},
    {.name = "directions",
     .help = "rows of t, x, y, z: directions of the strand at the support in the world, "
             "of any length, t (s) ascending. It turns on the shortest way, quintic in "
             "time, and rests at each. None: the direction at the start",
     .min = -farthest_place,
     .max = farthest_place,
     .components = 4,
     .rows = true},
    {.name = "twist_rad",
     .help = "rows of t, angle (s, rad): twist of a clamp about its direction, relative "
             "to the section at the start, t ascending. Quintic in time, at rest at each",
     .min = -farthest_place,
     .max = farthest_place,
     .components = 2,
     .rows = true},
    {.name = "slide",
     .help =
         "direction in which the point slides freely, in the world, of any length; 0, "
         "0, 0: none",
     .min = -farthest_place,
     .max = farthest_place,
     .components = 3,
     .fallback = "0,0,0"},
};

/// Index of the material point that `at` names.
int point_of(const Table& table, const Strand& strand) {
  return point_at(table.values().word("at"), strand,
                  fmt::format("strand {}", table.values().whole("strand")),
                  table.place("at"));
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

/// Refuses keys that the kind of a support does not read.
void check_keys(const Table& table) {
  const std::string_view kind = table.values().word("kind");
  const auto refuse = [&](const char* key, const char* why, const char* remedy) {
    if (!table.given(key)) return;
    throw InputError(
        fmt::format("{} of a support with kind = \"{}\", {}", key, kind, why),
        table.place(key), remedy);
  };
  const char* const leave = "leave it out, or give kind = \"clamp\"";
  if (kind == "ball") refuse("directions", "which holds no direction", leave);
  if (kind == "hinge") refuse("directions", "which follows no directions", leave);
  if (kind != "hinge" && norm(table.values().vec("axis")) > 0) {
    refuse("axis", "which turns about no axis", "leave it out, or give kind = \"hinge\"");
  }
  if (kind != "clamp") refuse("twist_rad", "which holds no twist", leave);
  if (kind == "direction") {
    refuse("keyframes", "which holds no position", leave);
    refuse("slide", "which holds no position", leave);
  }
}

}  // namespace

int point_at(std::string_view at, const Strand& strand, const std::string& name,
             const std::string& place) {
  const std::vector<double> s = models::arc_lengths(strand);
  const auto last = static_cast<int>(s.size()) - 1;
  if (at == "tip") return last;
  if (at == "root") return 0;
  const double share = decimal(at).value_or(-1);
  const double arc = share * s.back();
  const auto nearest = std::ranges::min_element(
      s, {}, [arc](double other) { return std::abs(other - arc); });
  const auto point = static_cast<std::size_t>(nearest - s.begin());
  if (share >= 0 && share <= 1 && std::abs(*nearest - arc) <= 1e-9 * s.back()) {
    return static_cast<int>(point);
  }
  throw InputError(
      fmt::format("no point at {} of {}", at, name), place,
      share >= 0 && share <= 1
          ? fmt::format("give at = {:.9g}, the nearest end of an element, or other "
                        "elements",
                        *nearest / s.back())
          : "give \"tip\", \"root\" or a number of 0 to 1");
}

std::span<const Parameter> support_table_parameters() { return support_parameters; }

Table read_support(const toml::table& table, const std::string& file) {
  constexpr std::string_view own[] = {"at"};
  Table read = read_table(table, support_parameters, "[supports]", file, own);
  if (const toml::node* at = table.get("at")) {
    const std::string place = place_of(at->source(), file);
    if (!at->is_string() && !at->is_number()) {
      throw InputError("at: expected a string or a number", place,
                       "give \"tip\", \"root\" or a number of 0 to 1");
    }
    read.set("at", scalar_text(*at), place);
  }
  check_keys(read);
  return read;
}

SceneSupports::SceneSupports(const Scene& scene)
    : tables_(scene.tables),
      model_options_(scene.model_options),
      duration_(scene.duration) {}

const std::vector<Table>& SceneSupports::tables() const {
  static const std::vector<Table> none;
  return tables_ == nullptr ? none : tables_->supports;
}

std::vector<const Table*> SceneSupports::of(std::size_t strand) const {
  std::vector<const Table*> own;
  for (const Table& table : tables()) {
    if (table.values().whole("strand") == static_cast<int>(strand)) own.push_back(&table);
  }
  return own;
}

std::vector<NamedSupport> SceneSupports::named() const {
  std::vector<std::pair<int, NamedSupport>> all;
  for (const Table& table : tables()) {
    const int strand = table.values().whole("strand");
    const std::string_view kind = table.values().word("kind");
    const std::string name =
        fmt::format("strand_{}_at_{}", strand, table.values().word("at"));
    all.emplace_back(strand, NamedSupport{name, kind != "direction", kind != "ball",
                                          "the support " + name + " on the strand"});
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
  support.path = support_path(table, start);
  const std::string_view kind = table.values().word("kind");
  if (kind == "direction") support.axes.clear();
  if (kind != "ball") {
    const auto held = models::section_to_hold(system, point, table.place("kind"));
    support.section = kind == "direction" ? HeldPart::tangent : HeldPart::frame;
    if (kind == "hinge") support.hinge = hinge_axis(table, start.frame);
    refuse_if(table.given("twist_rad") && held.turning != Sections::Turning::frame,
              "a twist of a model without frames of its sections",
              table.place("twist_rad"),
              "leave it out, or use a model with twist, such as \"super_helix\"");
    const std::size_t last = strand.segments.size() - 1;
    support.half_edge =
        models::rod_joint(strand, nullptr, strand.segments[point == 0 ? 0 : last], {});
  }
  stay_in_plane(model_options_, duration_, strand, table, support);
  let_slide(table, support);
  return support;
}

std::unique_ptr<System> SceneSupports::on(std::unique_ptr<System> system,
                                          const Strand& strand,
                                          std::size_t number) const {
  const std::vector<const Table*> tables = of(number);
  if (tables.empty()) return system;
  const std::string& place = tables.front()->place();
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
      start.frame = sections(*system)->section(0, q, v, zero, at).frame;
    }
    supports.push_back(support(*system, strand, *table, start, at));
    if (supports.back().axes.empty() || norm(table->values().vec("slide")) > 0) {
      continue;
    }
    const SupportedEnd end{fmt::format("support at {}", table->values().word("at")),
                           s[point], &supports.back().path};
    for (const SupportedEnd& other : ends) {
      check_reach(other, end, inextensible, duration_, *table);
    }
    ends.push_back(end);
  }
  try {
    return std::make_unique<SupportedSystem>(std::move(system), std::move(supports));
  } catch (const InputError& error) {
    throw InputError(error.what(), place, "change the scene there");
  }
}

Formulation formulation_of_supports(const Scene& scene) {
  const IntegratorEntry& entry = find_integrator(scene.integrator);
  using enum Formulation;
  const bool projected =
      scene.options.tolerance > 0 || entry.order(index3).value_or(0) < entry.order();
  const std::array preferred =
      entry.adaptive ? std::array{index2_ggl, projection, index3, baumgarte}
      : projected    ? std::array{projection, index3, index2_ggl, baumgarte}
                     : std::array{index3, projection, index2_ggl, baumgarte};
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
  const std::string& place = tables().front().place();
  refuse_if(scene.rest == RestStrains::inverse,
            "supports with rest = \"inverse\", which balances strands without their "
            "forces",
            place, "leave out rest, or the supports");
  const Parameters* interaction = scene.interaction();
  refuse_if(interaction != nullptr && interaction->word("coupling") == "monolithic",
            "supports of strands that are one system", place,
            "use [effects.strand_interaction] coupling = \"lagged\"");
  refuse_if(scene.friction() != nullptr,
            "supports of strands that rub, whose impulses leave supports out", place,
            "leave out [effects.strand_friction], or the supports");
}

}  // namespace tress::simulation
