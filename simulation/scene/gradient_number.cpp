#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "contract/input_error.h"
#include "models/affine_numbers.h"
#include "simulation/scene/gradient_table.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {
namespace {

// |s| of a stencil (integrators/gradient), and rounding: of affine numbers upwards, of
// others both ways.
constexpr double reach = 0.2501, central_reach = 1e-5;
// A number nearer to an end of its range than this part of it, times `reach`, has no
// room.
constexpr double least_room = 1e-3;

/// Tables of [[supports]] and of drives, which are no effects of the catalogue.
struct ListedTables {
  std::string_view name;                    // of the first one; the second is name_2
  std::vector<Table> StrandTables::*plain;  // null: of drives
  std::vector<Table> DrivenTables::*driven;

  template <class Tables>
  auto& of(Tables& tables) const {
    return plain != nullptr ? tables.*plain : tables.driven.*driven;
  }
};
constexpr ListedTables listed[] = {{"supports", &StrandTables::supports, nullptr},
                                   {"point_moment", nullptr, &DrivenTables::moments},
                                   {"natural_shape", nullptr, &DrivenTables::shapes}};

/// Numbers of these tables that have no derivative.
struct RefusedKey {
  std::string_view table, key, reason;
};
constexpr RefusedKey refused_keys[] = {
    {"point_moment", "at", "the end of an element cannot move a little"},
    {"natural_shape", "from", "derivatives jump where a part ends between elements"},
    {"natural_shape", "to", "derivatives jump where a part ends between elements"},
    {"supports", "axis", "the length of a direction does nothing"},
    {"supports", "slide", "the length of a direction does nothing"},
    {"tether", "at",
     "a tether holds one point of the model, and runs jump where that changes"},
    {"self_contact", "separation_m",
     "contact rounds it to elements, and runs jump where their number changes"},
    {"self_contact", "inner_radius_m",
     "contact points of an element are a whole number, and runs jump where it changes"}};

/// see(list, i, name) of every such table.
template <class See>
void each_listed(const Scene& scene, See see) {
  for (const ListedTables& list : listed) {
    for (std::size_t i = 0; i < list.of(*scene.tables).size(); ++i) {
      see(list, i,
          i == 0 ? std::string(list.name) : fmt::format("{}_{}", list.name, i + 1));
    }
  }
}

double or_one(double value) { return value != 0 ? std::abs(value) : 1; }

/// Whether a text in parentheses is a unit: "kg/(m s)", and not "1 - cos(2 pi f t)".
bool is_unit(std::string_view text) {
  constexpr std::string_view units[] = {"m", "s", "kg", "N", "Pa", "J", "Hz", "rad"};
  constexpr std::string_view others = "0123456789^/() ";
  bool any = false;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(others), text.size());
    if (end > 0 && std::ranges::count(units, text.substr(0, end)) == 0) return false;
    any = any || end > 0;
    text.remove_prefix(std::max<std::size_t>(end, 1));
  }
  return any;
}

/// The last unit in a help text: "air drag per length (kg/(m s))"; 1 if there is none.
std::string unit_of(const Parameter& p) {
  std::size_t end = p.help.rfind(')');
  while (end != p.help.npos) {
    int depth = 0;
    std::size_t i = end + 1;
    do {
      --i;
      depth += p.help[i] == ')' ? 1 : p.help[i] == '(' ? -1 : 0;
    } while (depth > 0 && i > 0);
    const std::string_view inside = p.help.substr(i + 1, end - i - 1);
    if (depth == 0 && is_unit(inside)) return std::string(inside);
    end = end == 0 ? p.help.npos : p.help.rfind(')', end - 1);
  }
  return "1";
}

}  // namespace

std::string_view no_derivative(std::string_view table, std::string_view key) {
  const auto found = std::ranges::find_if(refused_keys, [&](const RefusedKey& one) {
    return one.table == table && one.key == key;
  });
  return found == std::end(refused_keys) ? std::string_view() : found->reason;
}

std::string unused_number(const models::EffectEntry& effect, std::string_view key,
                          const Parameters& values) {
  for (const models::EffectUse& one : effect.uses) {
    std::vector<Use> of_choice;
    for (const auto& [choice, word, keys] : effect.uses) {
      if (choice == one.choice) of_choice.push_back({word, keys});
    }
    const std::string_view word = values.word(one.choice);
    if (!used(of_choice, word, key)) {
      return fmt::format("{} = \"{}\" does not use it", one.choice, word);
    }
  }
  return {};
}

integrators::ParameterLaw law_of_number(const EffectChoice& effect,
                                        std::string_view key) {
  using enum integrators::ParameterLaw;
  if (!models::affine_in(*effect.entry, key, effect.parameters)) return unknown;
  if (effect.entry->contact || effect.entry->make == nullptr) return affine;
  const auto made = effect.entry->make(effect.parameters, models::RootMotion{});
  return models::depends_on_place(*made) ? affine : smooth;
}

bool add_table_parameter(const Scene& scene, std::string_view name,
                         const std::string& place, std::vector<SceneParameter>& to) {
  const std::size_t dot = name.find('.');
  if (dot == name.npos) return false;
  bool found = false;
  each_listed(
      scene, [&](const ListedTables& list, std::size_t i, const std::string& of_table) {
        if (name.substr(0, dot) != of_table) return;
        found = true;
        const Table& table = list.of(*scene.tables)[i];
        const std::string_view written = name.substr(dot + 1);
        std::string_view key = written;
        take_component(key);
        const std::string_view reason = no_derivative(list.name, key);
        if (!reason.empty()) refuse_gradient(name, reason, place, "leave it out");
        const GradientNumber of =
            gradient_number(name, written, table.declared(), table.values(), place);
        to.push_back({std::string(name), of.unit, of.value, of.measure, false,
                      [of, list, i](Scene& changed, double s) {
                        auto own = std::make_shared<StrandTables>(*changed.tables);
                        Table& one = list.of(*own)[i];
                        one.set(of.key, of.text(one.values(), s), one.place());
                        changed.tables = std::move(own);
                      },
                      of.positive, of.min, of.max});
        // Loads and moments are products of these numbers.
        to.back().law = integrators::ParameterLaw::affine;
      });
  return found;
}

std::vector<std::string> table_parameter_names(const Scene& scene) {
  std::vector<std::string> all;
  each_listed(
      scene, [&](const ListedTables& list, std::size_t i, const std::string& of_table) {
        for (const Parameter& p : list.of(*scene.tables)[i].declared()) {
          if (p.text || p.rows || p.whole || !p.choices.empty()) continue;
          if (!no_derivative(list.name, p.name).empty()) continue;
          all.push_back(
              fmt::format("{}.{}{}", of_table, p.name, p.components == 3 ? ".x" : ""));
        }
      });
  return all;
}

Vec axis_of(std::size_t k) {
  return {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
}

std::optional<std::size_t> take_component(std::string_view& name) {
  constexpr std::string_view axes = "xyz";
  if (name.size() < 3 || name[name.size() - 2] != '.') return {};
  const std::size_t k = axes.find(name.back());
  if (k == axes.npos) return {};
  name.remove_suffix(2);
  return k;
}

void refuse_gradient(std::string_view name, std::string_view reason,
                     const std::string& place, std::string_view remedy) {
  throw InputError(fmt::format("no gradient by {}: {}", name, reason), place,
                   std::string(remedy));
}

std::string GradientNumber::text(const Parameters& values, double s) const {
  if (!component) return number_text(value + s * measure);
  const Vec v = values.vec(key) + (s * measure) * axis_of(*component);
  return number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z);
}

namespace {

/// Refuses "wind.velocity_m_s.w" of a known key.
void check_component(std::string_view name, std::string_view key,
                     std::span<const Parameter> declared, const std::string& place) {
  const std::size_t dot = key.find('.');
  const auto p = std::ranges::find(declared, key.substr(0, dot), &Parameter::name);
  if (dot == key.npos || p == declared.end()) return;
  const std::string_view whole = name.substr(0, name.find('.') + 1 + dot);
  if (p->components == 3) {
    refuse_gradient(name, fmt::format("{} has the components x, y and z", whole), place,
                    fmt::format("give {}.x, .y or .z", whole));
  }
  refuse_gradient(name, fmt::format("{} is one number", whole), place,
                  "leave out what follows the last dot");
}

}  // namespace

GradientNumber gradient_number(std::string_view name, std::string_view key,
                               std::span<const Parameter> declared,
                               const Parameters& values, const std::string& place) {
  GradientNumber all;
  all.component = take_component(key);
  all.key = key;
  const auto p = std::ranges::find(declared, key, &Parameter::name);
  if (p == declared.end()) {
    check_component(name, key, declared, place);
    std::vector<std::string_view> known;
    for (const Parameter& one : declared) known.push_back(one.name);
    throw InputError(
        fmt::format("unknown parameter '{}'", name), place,
        suggestion(key, known, fmt::format("use one of: {}", fmt::join(known, ", "))));
  }
  if (p->text || p->rows || p->whole || !p->choices.empty()) {
    refuse_gradient(name, "it is not a number that can change a little", place,
                    "leave it out");
  }
  if (all.component.has_value() != (p->components == 3)) {
    const bool three = p->components == 3;
    refuse_gradient(name, three ? "it has the components x, y and z" : "it is one number",
                    place,
                    three ? fmt::format("give {}.x, .y or .z", name)
                          : "leave out what follows the last dot");
  }
  all.value =
      all.component ? dot(axis_of(*all.component), values.vec(key)) : values.number(key);
  all.unit = unit_of(*p);
  // A change by a quarter of the measure stays within the range.
  const double typical = or_one(all.value);
  all.measure = std::min(
      {typical, (p->max - all.value) / reach, (all.value - p->min) / central_reach});
  all.positive = all.value > 0 && p->min >= 0;
  all.min = p->min;
  all.max = p->max;
  if (all.value <= p->min || all.measure < least_room * typical) {
    refuse_gradient(name,
                    fmt::format("{:g} is at the end of its range, {:g} to {:g}, where a "
                                "change has no two sides",
                                all.value, p->min, p->max),
                    place, "give it a value inside");
  }
  return all;
}

}  // namespace tress::simulation
