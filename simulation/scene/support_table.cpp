#include "simulation/scene/support_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "models/motion/signals.h"
#include "models/strand/arc_lengths.h"
#include "models/strand/geometry.h"
#include "models/supports/supported_system.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_reach.h"
#include "simulation/table/read_table.h"

namespace tress::simulation {

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
     .help = "kind of support: ball holds the position; clamp, position and frame; "
             "direction, position and tangent. Only ball is available",
     .choices = "ball|clamp|direction"},
    {.name = "keyframes",
     .help =
         "rows of t, x, y, z (s, m): places of the support in the world, t ascending. "
         "It moves in straight lines, quintic in time, and rests at each. One row: a "
         "fixed place. None: the place of the point at the start",
     .min = -farthest_place,
     .max = farthest_place,
     .components = 4,
     .rows = true},
};

/// Index of the material point that `at` names.
int point_of(const Table& table, const Strand& strand) {
  const std::string_view at = table.values().word("at");
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
      fmt::format("no point at {} of strand {}", at, table.values().whole("strand")),
      table.place("at"),
      share >= 0 && share <= 1
          ? fmt::format("give at = {:.9g}, the nearest end of an element, or other "
                        "elements",
                        *nearest / s.back())
          : "give \"tip\", \"root\" or a number of 0 to 1");
}

RootMotion path_of(const Table& table, const Vec& start) {
  const auto [t, x, y, z] = columns<4>(table.values().numbers("keyframes"));
  RootMotion path;
  path.position = t.empty() ? start : Vec{x[0], y[0], z[0]};
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (t[i] > t[i - 1]) continue;
    throw InputError(fmt::format("keyframes not ascending in time: {:g} s after {:g} s",
                                 t[i], t[i - 1]),
                     table.place("keyframes"),
                     "give each a later time than the one before");
  }
  const auto move = [&](const Vec& axis, const std::vector<double>& values) {
    if (t.size() < 2) return;
    std::vector<double> ways;
    for (const double value : values) ways.push_back(value - values.front());
    path.translations.push_back({axis, models::rests(t, ways)});
  };
  move({1, 0, 0}, x);
  move({0, 1, 0}, y);
  move({0, 0, 1}, z);
  return path;
}

void refuse_kind(const Table& table) {
  const std::string_view kind = table.values().word("kind");
  if (kind == "ball") return;
  throw InputError(
      fmt::format("kind = \"{}\": rows for frames are not available", kind),
      table.place("kind"),
      "use kind = \"ball\", with a second support of a neighbouring point to "
      "hold a direction");
}

}  // namespace

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
  refuse_kind(read);
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

std::vector<std::string> SceneSupports::names() const {
  std::vector<std::pair<int, std::string>> all;
  for (const Table& table : tables()) {
    const int strand = table.values().whole("strand");
    all.emplace_back(strand,
                     fmt::format("strand_{}_at_{}", strand, table.values().word("at")));
  }
  std::ranges::stable_sort(all, {}, &std::pair<int, std::string>::first);
  std::vector<std::string> names;
  for (auto& [strand, name] : all) names.push_back(std::move(name));
  return names;
}

std::unique_ptr<System> SceneSupports::on(std::unique_ptr<System> system,
                                          const Strand& strand,
                                          std::size_t number) const {
  const std::vector<const Table*> tables = of(number);
  if (tables.empty()) return system;
  const std::string& place = tables.front()->place();
  models::check_unbranched(strand, place);
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  std::vector<double> q(n), v(n), x(3 * (strand.segments.size() + 1));
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
    Support support;
    support.point = point_of(*table, strand);
    const auto point = static_cast<std::size_t>(support.point);
    refuse_if(point == 0 && !strand.free_root, "a support of the root, which is clamped",
              table->place("at"), "leave it out, or give [root] motion = \"free\"");
    refuse_if(
        std::ranges::any_of(
            supports, [&](const Support& one) { return one.point == support.point; }),
        "a second support of the same point", table->place(), "leave out one of them");
    support.path = path_of(*table, load3(&x[3 * point]));
    stay_in_plane(model_options_, duration_, strand, *table, support);
    supports.push_back(std::move(support));
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

void SceneSupports::check(const Scene& scene) const {
  if (!any()) return;
  for (const Table& table : tables()) {
    const int strand = table.values().whole("strand");
    if (static_cast<std::size_t>(strand) < scene.strands.size()) continue;
    throw InputError(
        fmt::format("a support of strand {}", strand), table.place("strand"),
        fmt::format("the scene has {} strand{}, the first is 0", scene.strands.size(),
                    scene.strands.size() == 1 ? "" : "s"));
  }
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
