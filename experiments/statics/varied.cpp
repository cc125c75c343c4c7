#include "experiments/statics/varied.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "simulation/scene/strand_tables.h"

namespace tress::experiments::statics {
namespace {

using simulation::EffectChoice;
using simulation::Scene;
using simulation::Table;
using Kind = Varied::Kind;

constexpr std::string_view rows_of_support[] = {"keyframes", "directions", "twist_rad"};

/// Number of components of a row, of which the first is the time.
std::size_t components(std::string_view key) { return key == "twist_rad" ? 2 : 4; }

const std::vector<Table>& supports_of(const Scene& scene) {
  static const std::vector<Table> none;
  return scene.tables == nullptr ? none : scene.tables->supports;
}

/// Time of the last row of the supports, s; 0: none moves.
double last_row(const Scene& scene) {
  double last = 0;
  for (const Table& table : supports_of(scene)) {
    for (const std::string_view key : rows_of_support) {
      const auto numbers = table.values().numbers(key);
      const std::size_t count = components(key);
      if (numbers.size() > count) last = std::max(last, numbers[numbers.size() - count]);
    }
  }
  return last;
}

std::vector<std::size_t> effects_with(const Scene& scene, std::string_view id) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < scene.effects.size(); ++i) {
    if (scene.effects[i].entry->id == id) all.push_back(i);
  }
  return all;
}

/// Names that the scene has, besides its numbers.
std::vector<std::string> names_in(const Scene& scene) {
  std::vector<std::string> all;
  if (last_row(scene) > 0) all.emplace_back("supports");
  for (const std::string& name : simulation::effect_names(scene)) {
    if (name.starts_with("point_force") || name == "gravity") all.push_back(name);
  }
  return all;
}

std::string chosen_by_scene(const Scene& scene, const std::string& place) {
  if (last_row(scene) > 0) return "supports";
  const std::size_t forces = effects_with(scene, "point_force").size();
  if (forces == 1) return "point_force";
  if (forces == 0 && !effects_with(scene, "gravity").empty()) return "gravity";
  throw InputError(forces > 1 ? "the scene has several point forces, of which one varies"
                              : "the scene has no load that can vary",
                   place,
                   forces > 1
                       ? "give --over point_force or --over point_force_2"
                       : "add [[effects.point_force]], [effects.gravity] or a "
                         "support with two keyframes, or give --over KEY=FROM..TO");
}

double end_of_range(std::string_view text, const std::string& place) {
  const double value = decimal(text).value_or(std::nan(""));
  refuse_if(!std::isfinite(value), fmt::format("'{}' is not a number", text), place,
            "give a range such as --over point_force=0..2");
  return value;
}

/// Reads FROM..TO.
void set_range(std::string_view text, const std::string& place, Varied& of) {
  const std::size_t dots = text.find("..");
  refuse_if(dots == text.npos, fmt::format("'{}' is not a range", text), place,
            "give FROM..TO, as in --over point_force=0..2");
  of.from = end_of_range(text.substr(0, dots), place);
  of.to = end_of_range(text.substr(dots + 2), place);
  refuse_if(of.from == of.to,
            fmt::format("both ends of the range {} are the same", std::string(text)),
            place, "give different numbers, as in --over point_force=0..2");
}

/// True: the name is a load or the supports.
bool set_load(const Scene& scene, const std::string& name, const std::string& place,
              Varied& of) {
  if (name == "supports") {
    of.kind = Kind::supports;
    of.unit = "s";
    of.to = last_row(scene);
    refuse_if(of.to <= 0, "the scene has no support that moves", place,
              "give a support at least two rows of keyframes, directions or twist_rad");
    return true;
  }
  const std::vector<std::string> effects = simulation::effect_names(scene);
  const auto found = std::ranges::find(effects, name);
  if (found == effects.end()) return false;
  of.effect = static_cast<std::size_t>(found - effects.begin());
  const std::string_view id = scene.effects[of.effect].entry->id;
  if (id != "gravity" && id != "point_force") return false;
  of.kind = id == "gravity" ? Kind::gravity : Kind::point_force;
  of.unit = "1";
  return true;
}

[[noreturn]] void refuse_name(const Scene& scene, const std::string& name,
                              const std::string& place) {
  const std::vector<std::string> known = names_in(scene);
  const std::vector<std::string_view> views(known.begin(), known.end());
  const bool load = name.starts_with("point_force") || name == "gravity";
  throw InputError(
      load ? fmt::format("the scene has no [effects.{}]", name)
           : fmt::format("nothing named '{}' can vary in the scene", name),
      place,
      // "gravity" is also the former name of a key.
      suggestion(name == "gravity" ? "" : name, views,
                 !known.empty()
                     ? fmt::format("give one of {}, or a number of the scene such as "
                                   "youngs_modulus_pa",
                                   fmt::join(known, ", "))
                 : load ? "add it"
                        : "give --over KEY=FROM..TO with a number of the scene, such as "
                          "youngs_modulus_pa"));
}

/// Refuses an effect that is no load of its own, and names its numbers.
void refuse_effect(const Scene& scene, const std::string& name,
                   const std::string& place) {
  const std::vector<std::string> effects = simulation::effect_names(scene);
  const auto found = std::ranges::find(effects, name);
  if (found == effects.end()) return;
  const auto i = static_cast<std::size_t>(found - effects.begin());
  std::vector<std::string> numbers;
  for (const Parameter& p : scene.effects[i].entry->parameters) {
    if (p.text || p.rows || !p.choices.empty() || p.components > 1) continue;
    numbers.push_back(fmt::format("{}.{}", name, p.name));
  }
  throw InputError(fmt::format("{} is an effect, not a number", name), place,
                   fmt::format("give a number of it: {}", fmt::join(numbers, ", ")));
}

void set_number(const Scene& scene, const std::string& name, const std::string& place,
                Varied& of) {
  const std::vector<std::string> known = names_in(scene);
  const std::vector<std::string_view> views(known.begin(), known.end());
  const bool load = name.starts_with("point_force") || name == "gravity";
  const bool near = !nearest(name, views).empty();
  refuse_effect(scene, name, place);
  if (name.find('.') == name.npos && (load || near)) refuse_name(scene, name, place);
  of.kind = Kind::number;
  const std::string names[] = {name};
  auto found = simulation::gradient_parameters(scene, names, place);
  refuse_if(found.size() != 1, fmt::format("'{}' names several numbers", name), place,
            "give one of them");
  of.number = std::move(found.front());
  of.unit = of.number.unit;
}

std::string scaled(const Vec& x, double factor) {
  return fmt::format("{},{},{}", number_text(factor * x.x), number_text(factor * x.y),
                     number_text(factor * x.z));
}

}  // namespace

Varied varied(const Scene& scene, std::string_view text, const std::string& place) {
  Varied of;
  const std::size_t equals = text.find('=');
  const std::string name(text.substr(0, equals));
  of.name = text.empty() ? chosen_by_scene(scene, place) : name;
  refuse_if(of.name.empty(), "no name before the range", place,
            "give KEY=FROM..TO, as in --over point_force=0..2");
  const bool load = set_load(scene, of.name, place, of);
  if (!load) set_number(scene, of.name, place, of);
  if (equals != text.npos) {
    set_range(text.substr(equals + 1), place, of);
  } else {
    refuse_if(!load, fmt::format("no range of {}", of.name), place,
              fmt::format("give --over {}=FROM..TO", of.name));
  }
  if (of.kind == Kind::supports) {
    refuse_if(of.from != 0 || of.to < 0,
              "a path of supports that does not begin at their start, or goes back from "
              "there",
              place, fmt::format("give --over supports=0..{:g}", last_row(scene)));
  }
  if (of.kind == Kind::number) {
    for (const double end : {of.from, of.to}) {
      const bool positive = !of.number.positive || end > 0;
      refuse_if(end < of.number.min || end > of.number.max || !positive,
                fmt::format("{} = {:g} is out of range", of.name, end), place,
                fmt::format("give numbers {}between {:g} and {:g}",
                            of.number.positive && of.number.min <= 0 ? "above 0 " : "",
                            of.number.min, of.number.max));
    }
  }
  return of;
}

Scene at_value(Scene scene, const Varied& varied, double value) {
  if (varied.kind == Kind::supports) return scene;
  if (varied.kind == Kind::number) {
    varied.number.change(scene, (value - varied.number.value) / varied.number.measure);
    return scene;
  }
  Parameters& load = scene.effects[varied.effect].parameters;
  if (varied.kind == Kind::gravity) {
    load.set("gravity_m_s2", scaled(load.vec("gravity_m_s2"), value));
  } else {
    load.set("force_n", scaled(load.vec("force_n"), value));
    load.set("follower_n", number_text(value * load.number("follower_n")));
  }
  return scene;
}

}  // namespace tress::experiments::statics
