#include "simulation/driven/driven_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contract/input_error.h"
#include "models/motion/factor_over_time.h"
#include "models/strand/arc_lengths.h"
#include "models/strand/geometry.h"
#include "simulation/driven/strand_drives.h"
#include "simulation/table/read_table.h"

namespace tress::simulation {

using models::FactorOverTime;
using models::NaturalMotion;
using models::PointMoment;
using models::StrandDrives;

namespace {

constexpr double most_moment = 1e9, most_curvature = 1e9, latest = 1e9;

constexpr Parameter moment_parameters[] = {
    {.name = "at",
     .help = "place along the strand, 0: root, 1: tip. The place must be the end of an "
             "element",
     .number = 1,
     .min = 0,
     .max = 1},
    {.name = "moment_n_m",
     .help = "moment about the axes x, y, z, which keeps its direction (N m)",
     .min = -most_moment,
     .max = most_moment,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "follower_n_m",
     .help = "moment that follows the material, about the tangent and about the axes e1 "
             "and e2 of the section (N m)",
     .min = -most_moment,
     .max = most_moment,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "factor_over_time",
     .help = "factor of both moments: rows of [time in s, factor], linear between rows "
             "and constant beyond them. Without rows it is 1",
     .min = -latest,
     .max = latest,
     .components = 2,
     .rows = true}};

/// Rows of a time and a number.
constexpr Parameter over_time(std::string_view name, std::string_view help) {
  return {.name = name,
          .help = help,
          .min = -most_curvature,
          .max = most_curvature,
          .components = 2,
          .rows = true};
}

constexpr Parameter shape_parameters[] = {
    {.name = "from",
     .help = "start of the part that changes, over the length",
     .number = 0,
     .min = 0,
     .max = 1},
    {.name = "to",
     .help = "end of the part that changes, over the length",
     .number = 1,
     .min = 0,
     .max = 1},
    over_time("scale_over_time",
              "factor of the natural curvatures and twist of the strand: rows of [time "
              "in s, factor], linear between rows and constant beyond them. Without rows "
              "it is 1"),
    over_time("curvature_per_m",
              "added natural curvature about e1: rows of [time in s, 1/m], as above. "
              "Without rows it is 0"),
    over_time("curvature2_per_m",
              "added natural curvature about e2: rows of [time in s, 1/m]"),
    over_time("twist_per_m", "added natural twist: rows of [time in s, 1/m]")};

constexpr DrivenKind kinds[] = {
    {"point_moment",
     "moment on the section at one place of a strand, dead or following the material, "
     "constant or over time. Refused with bodies in exact contact",
     "Euler", moment_parameters},
    {"natural_shape",
     "natural curvature and twist over time, of a whole strand or a part: muscles, curls "
     "that dry",
     "Kirchhoff", shape_parameters}};

/// Rows of a key; `otherwise` without rows.
class Rows {
 public:
  Rows(const Table& table, const std::string& key, double otherwise)
      : rows_(table.values().numbers(key), table.place(key), key),
        otherwise_(otherwise) {}

  double operator()(double t) const { return rows_.constant() ? otherwise_ : rows_(t); }
  std::vector<double> times() const { return rows_.times(); }

 private:
  FactorOverTime rows_;
  double otherwise_;
};

/// The change of the natural shape that one table describes.
struct ShapeChange {
  explicit ShapeChange(const Table& table)
      : from(table.values().number("from")),
        to(table.values().number("to")),
        scale(table, "scale_over_time", 1),
        curvature(table, "curvature_per_m", 0),
        curvature2(table, "curvature2_per_m", 0),
        twist(table, "twist_per_m", 0) {
    refuse_if(!(from < to), "a part of the strand that ends before it starts",
              table.place(table.given("to") ? "to" : "from"), "give from < to");
  }

  std::vector<double> times() const {
    std::vector<double> all;
    for (const Rows* rows : {&scale, &curvature, &curvature2, &twist}) {
      const std::vector<double> own = rows->times();
      all.insert(all.end(), own.begin(), own.end());
    }
    return all;
  }

  /// Changes a strand to its natural shape at time t. An element that is changed in part
  /// gets the mean.
  void apply(double t, Strand& strand) const {
    const std::vector<double> s = models::arc_lengths(strand);
    const double length = s.back();
    const Vec added{twist(t), curvature(t), curvature2(t)};
    for (std::size_t i = 0; i < strand.segments.size(); ++i) {
      const double begin = std::max(s[i], from * length),
                   end = std::min(s[i + 1], to * length);
      const double share = std::max(0.0, end - begin) / (s[i + 1] - s[i]);
      const double factor = 1 + share * (scale(t) - 1);
      models::Segment& segment = strand.segments[i];
      segment.natural = factor * segment.natural + share * added;
      segment.natural_half = factor * segment.natural_half;
    }
  }

  double from, to;
  Rows scale, curvature, curvature2, twist;
};

NaturalMotion natural_motion(std::span<const Table> tables, System& system,
                             const Strand& strand, const ModelEntry& model,
                             const Parameters& model_options) {
  if (tables.empty()) return {};
  const std::string& where = tables.front().place();
  models::check_unbranched(strand, where);
  refuse_if(natural_strains(system) == nullptr,
            fmt::format("a natural shape over time for {}, which lacks a natural strain "
                        "for each direction in which it bends",
                        model.id),
            where,
            "use super_helix, super_clothoid, articulated_chain, der, corde, "
            "xpbd_cosserat or dynamic_spline");
  std::vector<ShapeChange> changes;
  std::vector<double> times;
  for (const Table& table : tables) {
    changes.emplace_back(table);
    const std::vector<double> own = changes.back().times();
    times.insert(times.end(), own.begin(), own.end());
  }
  if (times.empty()) return {};
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<NaturalMotion::Row> rows;
  for (const double t : times) {
    Strand changed = strand;
    for (const ShapeChange& change : changes) change.apply(t, changed);
    const auto made = [&] {
      try {
        return model.on_strand(changed, model_options, {});
      } catch (const InputError& error) {
        throw InputError(
            fmt::format("the natural shape at t = {:g} s: {}", t, error.what()), where,
            "give less curvature and twist, or more elements");
      }
    }();
    rows.push_back(
        {t, natural_strains(*made)->natural(), NaturalMotion::halves(changed)});
  }
  return NaturalMotion(std::move(rows), NaturalMotion::halves(strand));
}

PointMoment moment_of(const Table& table, const Strand& strand, std::size_t number) {
  const Parameters& values = table.values();
  PointMoment moment{end_of_element(values.number("at"), strand,
                                    fmt::format("strand {}", number), table.place("at")),
                     values.vec("moment_n_m"), values.vec("follower_n_m"),
                     FactorOverTime(values.numbers("factor_over_time"),
                                    table.place("factor_over_time"))};
  return moment;
}

}  // namespace

std::span<const DrivenKind> driven_kinds() { return kinds; }

bool is_driven(std::string_view id) {
  return std::ranges::count(kinds, id, &DrivenKind::id) > 0;
}

DrivenTables read_driven(const toml::table& effects, const std::string& file) {
  DrivenTables all;
  const std::array lists{&all.moments, &all.shapes};
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const toml::node* node = effects.get(kinds[i].id);
    if (node == nullptr) continue;
    const std::string name = fmt::format("effects.{}", kinds[i].id);
    for (const toml::table* one : tables_of(*node, name, true, file)) {
      lists[i]->push_back(
          read_table(*one, kinds[i].parameters, fmt::format("[{}]", name), file));
    }
  }
  for (const Table& shape : all.shapes) {
    refuse_if(ShapeChange(shape).times().empty(),
              "[[effects.natural_shape]] without rows does nothing", shape.place(),
              "give rows of scale_over_time, curvature_per_m, curvature2_per_m or "
              "twist_per_m, or leave it out");
  }
  return all;
}

int end_of_element(double share, const Strand& strand, const std::string& name,
                   const std::string& place, const char* remedy) {
  const std::vector<double> s = models::arc_lengths(strand);
  const double arc = share * s.back();
  const auto nearest = std::ranges::min_element(
      s, {}, [arc](double other) { return std::abs(other - arc); });
  if (share >= 0 && share <= 1 && std::abs(*nearest - arc) <= 1e-9 * s.back()) {
    return static_cast<int>(nearest - s.begin());
  }
  throw InputError(
      fmt::format("no point at {:.9g} of {}", share, name), place,
      share >= 0 && share <= 1
          ? fmt::format("give at = {:.9g}, the nearest end of an element, or other "
                        "elements",
                        *nearest / s.back())
          : remedy);
}

StrandDrives drives_of(const DrivenTables& tables, System& system, const Strand& strand,
                       std::size_t number, const ModelEntry& model,
                       const Parameters& model_options) {
  StrandDrives drives;
  drives.natural = natural_motion(tables.shapes, system, strand, model, model_options);
  for (const Table& table : tables.moments) {
    models::check_unbranched(strand, table.place());
    refuse_if(system.material_points() == nullptr ||
                  system.material_points()->count() !=
                      static_cast<int>(strand.segments.size()) + 1,
              "a moment on a model without points at the ends of its elements",
              table.place(), "use another model");
    drives.moments.push_back(moment_of(table, strand, number));
    // Refused with the location of its table.
    models::MomentOnSection(system, drives.moments.back(), system.sparse_form(),
                            table.place());
  }
  return drives;
}

}  // namespace tress::simulation
