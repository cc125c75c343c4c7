#include "simulation/scene/gradient_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "contract/input_error.h"
#include "simulation/scene/root_table.h"
#include "simulation/scene/shared_parameter.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/table/along.h"

namespace tress::simulation {
namespace {

constexpr Parameter gradient_keys[] = {
    {.name = "by",
     .help =
         "parameters by name. Material: `youngs_modulus_pa` (with the shear modulus), "
         "`shear_modulus_pa`, `density_kg_m3`, `radius_m`, "
         "`internal_friction_kg_m3_s`. Shape at rest (the start is held): "
         "`natural_curvature_per_m`, "
         "`natural_curvature2_per_m`, `natural_twist_per_m`. Start: "
         "`initial_curvature_per_m`, `initial_curvature2_per_m`, `initial_twist_per_m`. "
         "Add `.each` for one value per element. Root: `root_angle_rad.x` (.y, "
         ".z: about that axis), `root_position_m.x`. Keys of [root] as "
         "`root.amplitude_m`, of effects as `linear_drag.drag_kg_m_s` or "
         "`wind.velocity_m_s.x`, of moments and compliant supports as "
         "`point_moment.moment_n_m.x` and `supports.stiffness_n_per_m`",
     .rows = true,
     .text = true,
     .fallback = "youngs_modulus_pa,radius_m,density_kg_m3"},
    {.name = "of",
     .help = "points to differentiate: the tip, all points, or the tip at the last frame",
     .choices = "tip|points|last_tip"},
    {.name = "way",
     .help = "direction of the derivatives in time. `forward` runs along with the motion "
             "and takes one more solution "
             "per parameter. `adjoint` runs backward after it and takes one "
             "solution per differentiated number, 3 for each point and frame. "
             "`auto` takes `adjoint` where there are more than 3 parameters per "
             "number",
     .choices = "auto|forward|adjoint"},
    {.name = "start",
     .help = "start of the run. `damped` takes two short steps of backward "
             "Euler, `as_run` none. `auto` takes `damped` where a parameter "
             "moves the shape at rest, the start or the root",
     .choices = "auto|damped|as_run"},
};

/// A number of every strand.
struct OfStrand {
  std::string_view name, unit;
  double (*value)(const Strand& strand);
  /// To (1 + part) times what it is.
  void (*scale)(Strand& strand, double part);
};

constexpr OfStrand of_strands[] = {
    {"youngs_modulus_pa", "Pa", [](const Strand& s) { return s.material.youngs_modulus; },
     [](Strand& s, double part) {
       s.material.youngs_modulus *= 1 + part;
       s.material.shear_modulus *= 1 + part;
     }},
    {"shear_modulus_pa", "Pa", [](const Strand& s) { return s.material.shear_modulus; },
     [](Strand& s, double part) { s.material.shear_modulus *= 1 + part; }},
    {"density_kg_m3", "kg/m^3", [](const Strand& s) { return s.material.density; },
     [](Strand& s, double part) { s.material.density *= 1 + part; }},
    {"internal_friction_kg_m3_s", "kg m^3/s",
     [](const Strand& s) { return s.material.internal_friction; },
     [](Strand& s, double part) { s.material.internal_friction *= 1 + part; }},
    {"radius_m", "m",
     [](const Strand& s) {
       const CrossSection& section = s.segments.front().section;
       return std::sqrt(section.a1 * section.a2);
     },
     [](Strand& s, double part) {
       for (Segment& segment : s.segments) {
         segment.section.a1 *= 1 + part;
         segment.section.a2 *= 1 + part;
       }
     }},
};

/// A component of the Darboux vector of every segment.
struct OfShape {
  std::string_view name;
  Vec Segment::*shape;
  double Vec::*component;
};
constexpr OfShape of_shapes[] = {
    {"natural_curvature_per_m", &Segment::natural, &Vec::y},
    {"natural_curvature2_per_m", &Segment::natural, &Vec::z},
    {"natural_twist_per_m", &Segment::natural, &Vec::x},
    {"initial_curvature_per_m", &Segment::initial, &Vec::y},
    {"initial_curvature2_per_m", &Segment::initial, &Vec::z},
    {"initial_twist_per_m", &Segment::initial, &Vec::x},
};

constexpr std::string_view of_roots[] = {"root_angle_rad", "root_position_m"};

/// Whether a number of a root or an effect in this unit is a length or an angle.
bool places(std::string_view unit) { return unit == "m" || unit == "rad"; }

/// Numbers of a scene that have no derivative here, and why.
struct Refused {
  std::string_view name, reason, remedy;
};
constexpr Refused refused[] = {
    {"poisson_ratio", "sets the shear modulus only", "give shear_modulus_pa"},
    {"ellipticity", "derivatives by it are not available", "give radius_m"},
    {"length_m", "coordinates of strands of two lengths are not those of the same points",
     "compare runs with two lengths"},
    {"elements", "elements are a whole number", "compare runs with other numbers"},
    {"root.skin_scale", "places on a skin do not change with its scale alone",
     "compare runs"},
    {"initial_velocity_m_s", "a clamped strand starts at rest",
     "give root.velocity_m_s.x of [root] motion = \"free\""},
};

class Finder {
 public:
  Finder(const Scene& scene, const std::string& place) : scene_(scene), place_(place) {}

  void find(const std::string& name, std::vector<SceneParameter>& to) const {
    for (const Refused& one : refused) {
      if (one.name == name) refuse(name, one.reason, one.remedy);
    }
    if (of_strand(name, to) || of_shape(name, to) || of_root(name, to) ||
        of_root_table(name, to) || of_effect(name, to) ||
        add_table_parameter(scene_, name, place_, to)) {
      return;
    }
    std::vector<std::string> known = names();
    std::vector<std::string_view> views(known.begin(), known.end());
    throw InputError(
        fmt::format("unknown parameter '{}'", name), place_,
        suggestion(name, views, fmt::format("use one of: {}", fmt::join(known, ", "))));
  }

 private:
  [[noreturn]] void refuse(std::string_view name, std::string_view reason,
                           std::string_view remedy) const {
    refuse_gradient(name, reason, place_, remedy);
  }

  const Strand& first() const { return scene_.strands.front(); }

  bool of_strand(std::string_view name, std::vector<SceneParameter>& to) const {
    const auto found = std::ranges::find(of_strands, name, &OfStrand::name);
    if (found == std::end(of_strands)) return false;
    for (const StrandSource& source : scene_.tables->sources) {
      if (name != "radius_m" || !varies_radius(source.table)) continue;
      refuse(name, "radius_along or the widths of a file vary the radius",
             "leave out one of them");
    }
    for (const Strand& strand : scene_.strands) {
      if (found->value(strand) > 0) continue;
      refuse(name, "it is 0, where a change has no two sides", "give it a small value");
    }
    const double value = found->value(first());
    const Parameter key = shared_parameter(name);
    to.push_back({std::string(name), std::string(found->unit), value, value, false,
                  [scale = found->scale](Scene& scene, double s) {
                    for (Strand& strand : scene.strands) scale(strand, s);
                  },
                  true, key.min, key.max});
    to.back().law = integrators::ParameterLaw::smooth;
    return true;
  }

  bool of_shape(std::string_view name, std::vector<SceneParameter>& to) const {
    const std::size_t dot = name.find('.');
    const auto found = std::ranges::find(of_shapes, name.substr(0, dot), &OfShape::name);
    if (found == std::end(of_shapes)) return false;
    const std::string_view which = dot == name.npos ? "" : name.substr(dot + 1);
    std::size_t count = 0;
    for (const Strand& strand : scene_.strands) {
      count = std::max(count, strand.segments.size());
    }
    if (dot == name.npos) {
      add_shape(*found, std::string(name), {}, to);
    } else if (which == "each") {
      for (std::size_t i = 0; i < count; ++i) {
        add_shape(*found, fmt::format("{}.{}", found->name, i), i, to);
      }
    } else {
      std::size_t i = 0;
      while (i < count && which != std::to_string(i)) ++i;
      if (i == count) {
        refuse(name,
               fmt::format("{} elements 0 to {}",
                           scene_.strands.size() > 1 ? "strands have" : "the strand has",
                           count - 1),
               "give .each, or one of these numbers");
      }
      add_shape(*found, std::string(name), i, to);
    }
    return true;
  }

  void add_shape(const OfShape& of, std::string name, std::optional<std::size_t> element,
                 std::vector<SceneParameter>& to) const {
    const double measure = 1 / first().length();
    const auto longer = std::ranges::find_if(scene_.strands, [&](const Strand& strand) {
      return strand.segments.size() > element.value_or(0);
    });
    const double value = longer->segments[element.value_or(0)].*of.shape.*of.component;
    to.push_back({std::move(name), "1/m", value, measure, true,
                  [of, element, measure](Scene& scene, double s) {
                    for (Strand& strand : scene.strands) {
                      for (std::size_t i = 0; i < strand.segments.size(); ++i) {
                        if (element && i != *element) continue;
                        strand.segments[i].*of.shape.*of.component += s * measure;
                      }
                    }
                  }});
    to.back().starts = of.shape == &Segment::initial;
    to.back().law = integrators::ParameterLaw::smooth;
  }

  bool of_root(std::string_view name, std::vector<SceneParameter>& to) const {
    const std::string_view base = name.substr(0, name.find('.'));
    if (std::ranges::count(of_roots, base) == 0) return false;
    std::string_view rest = name;
    const auto k = take_component(rest);
    if (!k || rest != base) {
      refuse(name, fmt::format("{} has the components x, y and z", base),
             fmt::format("give {}.x, .y or .z", base));
    }
    if (scene_.tables->skin != nullptr) {
      refuse(name, "a skin places and turns the root", "leave it out");
    }
    const bool turns = base == of_roots[0];
    const double measure = turns ? 1 : first().length();
    to.push_back({std::string(name), turns ? "rad" : "m",
                  turns ? 0 : dot(axis_of(*k), first().root.position), measure, true,
                  [k, turns, measure](Scene& scene, double s) {
                    for (Strand& strand : scene.strands) {
                      const auto move = [&](Vec& position, Frame& frame) {
                        if (turns) {
                          frame = rotation(axis_of(*k), s * measure) * frame;
                        } else {
                          position = position + (s * measure) * axis_of(*k);
                        }
                      };
                      move(strand.root.position, strand.root.frame);
                      if (!strand.free_root) continue;
                      move(strand.free_root->position, strand.free_root->frame);
                    }
                  }});
    to.back().places = true;
    return true;
  }

  bool of_root_table(std::string_view name, std::vector<SceneParameter>& to) const {
    constexpr std::string_view prefix = "root.";
    if (!name.starts_with(prefix)) return false;
    const Table& root = scene_.tables->root;
    const GradientNumber of = gradient_number(name, name.substr(prefix.size()),
                                              root.declared(), root.values(), place_);
    const std::string_view motion = root.values().word("motion");
    if (!used(root_uses(), motion, of.key)) {
      refuse(name, fmt::format("motion = \"{}\" does not use it", motion),
             "leave it out");
    }
    to.push_back({std::string(name), of.unit, of.value, of.measure, true,
                  [of](Scene& scene, double s) {
                    auto tables = std::make_shared<StrandTables>(*scene.tables);
                    Table& table = tables->root;
                    table.set(of.key, of.text(table.values(), s), table.place());
                    scene.head = head_motion(table);
                    const auto free_root = free_motion(table);
                    const std::optional own{FreeRoot{}};
                    for (Strand& strand : scene.strands) {
                      // [[strand]] root = "free"
                      const bool only_it = strand.free_root && !free_root;
                      set_root(strand,
                               {scene.head, only_it ? own : free_root, tables->skin.get(),
                                only_it},
                               strand.root.position, strand.root.frame);
                    }
                    scene.tables = std::move(tables);
                  },
                  of.positive, of.min, of.max, places(of.unit)});
    // The velocities of a free root are of the start alone.
    if (motion == "free") to.back().law = integrators::ParameterLaw::affine;
    return true;
  }

  bool of_effect(std::string_view name, std::vector<SceneParameter>& to) const {
    const std::size_t dot = name.find('.');
    if (dot == name.npos) return false;
    const std::vector<std::string> effects = effect_names(scene_);
    const auto found = std::ranges::find(effects, name.substr(0, dot));
    if (found == effects.end()) return false;
    const auto i = static_cast<std::size_t>(found - effects.begin());
    const EffectChoice& effect = scene_.effects[i];
    const std::string_view reason = no_derivative(effect.entry->id, name.substr(dot + 1));
    if (!reason.empty()) refuse(name, reason, "compare runs");
    const GradientNumber of = gradient_number(
        name, name.substr(dot + 1), effect.entry->parameters, effect.parameters, place_);
    const std::string unused = unused_number(*effect.entry, of.key, effect.parameters);
    if (!unused.empty()) refuse(name, unused, "leave it out");
    to.push_back({std::string(name), of.unit, of.value, of.measure, false,
                  [of, i](Scene& scene, double s) {
                    EffectChoice& changed = scene.effects[i];
                    changed.parameters.set(of.key, of.text(changed.parameters, s));
                  },
                  of.positive, of.min, of.max, places(of.unit)});
    to.back().law = law_of_number(effect, of.key);
    return true;
  }

  /// For suggestions.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const OfStrand& one : of_strands) all.emplace_back(one.name);
    for (const OfShape& one : of_shapes) all.emplace_back(one.name);
    for (const std::string_view one : of_roots) all.push_back(std::string(one) + ".x");
    const auto add = [&all](std::string_view table, const Parameter& p) {
      if (p.text || p.rows || p.whole || !p.choices.empty()) return;
      all.push_back(fmt::format("{}.{}{}", table, p.name, p.components == 3 ? ".x" : ""));
    };
    const Table& root = scene_.tables->root;
    for (const Parameter& p : root.declared()) {
      if (used(root_uses(), root.values().word("motion"), p.name)) add("root", p);
    }
    const std::vector<std::string> effects = effect_names(scene_);
    for (std::size_t i = 0; i < effects.size(); ++i) {
      const EffectChoice& effect = scene_.effects[i];
      for (const Parameter& p : effect.entry->parameters) {
        if (unused_number(*effect.entry, p.name, effect.parameters).empty() &&
            no_derivative(effect.entry->id, p.name).empty()) {
          add(effects[i], p);
        }
      }
    }
    const std::vector<std::string> of_tables = table_parameter_names(scene_);
    all.insert(all.end(), of_tables.begin(), of_tables.end());
    return all;
  }

  const Scene& scene_;
  const std::string& place_;
};

}  // namespace

std::span<const Parameter> gradient_table_parameters() { return gradient_keys; }

std::vector<SceneParameter> gradient_parameters(const Scene& scene,
                                                std::span<const std::string> names,
                                                const std::string& place) {
  std::vector<SceneParameter> all;
  const Finder finder(scene, place);
  for (const std::string& name : names) finder.find(name, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      refuse_if(all[i].name == all[j].name,
                fmt::format("parameter {} is named twice", all[i].name), place,
                "leave one out");
    }
  }
  return all;
}

std::vector<SceneParameter> gradient_parameters(const Scene& scene) {
  const Table& table = *scene.tables->gradient;
  const std::vector<std::string> names = names_of(table.values().word("by"));
  refuse_if(names.empty(), "[gradient] by names nothing", table.place("by"),
            "give a parameter, as by = [\"youngs_modulus_pa\"]");
  return gradient_parameters(scene, names, table.place("by"));
}

}  // namespace tress::simulation
