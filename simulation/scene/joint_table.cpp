#include "simulation/scene/joint_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "models/joints/joined_system.h"
#include "models/strand/geometry.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/table/read_table.h"

namespace tress::simulation {

using models::Joint;
using models::JointKind;
using models::SupportedSystem;

namespace {

constexpr Parameter joint_parameters[] = {
    {.name = "a",
     .help =
         "first end: the name or the number of a strand, and a point, as in "
         "[\"left\", 0.5]. Points are \"tip\", \"root\", or a number of 0 to 1: the arc "
         "length over the length, at the end of an element",
     .rows = true,
     .text = true},
    {.name = "b",
     .help = "second end, as `a`; forces and moments in the series act on it",
     .rows = true,
     .text = true},
    {.name = "kind",
     .help = "held parts. `ball`: the points. `weld`: points and "
             "sections, at the angle of the start. `hinge`: as `weld`, but free to turn "
             "about `axis`. `spring`: nothing; a spring and a damper connect the points",
     .choices = "ball|weld|hinge|spring"},
    {.name = "axis",
     .help = "axis of a hinge at the start, in the world, of any length",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "stiffness_n_per_m",
     .help = "stiffness of a spring (N/m)",
     .min = 0,
     .max = 1e12},
    {.name = "damping_n_s_per_m",
     .help = "damping of a spring (N s/m), on the rate of its length. With a rest length "
             "of 0: on the relative velocity of the points",
     .min = 0,
     .max = 1e12},
    {.name = "rest_length_m",
     .help = "length of a spring without force (m). Without this key: the distance of "
             "the points at the start",
     .min = 0,
     .max = 1e6},
};

/// An end's strand and point.
std::pair<std::string, std::string> end_of(const Table& table, std::string_view key) {
  const std::vector<std::string> words = names_of(table.values().word(key));
  if (words.size() == 2) return {words[0], words[1]};
  throw InputError(fmt::format("{} of a joint without a strand and a point", key),
                   table.place(key),
                   fmt::format("give {} = [\"NAME\", \"tip\"], with the name or the "
                               "number of a strand",
                               key));
}

void read_end(const toml::table& table, const char* key, const std::string& file,
              Table& read) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return;
  const std::string place = place_of(node->source(), file);
  const toml::array* list = node->as_array();
  std::string text;
  bool sound = list != nullptr && list->size() == 2;
  for (std::size_t i = 0; sound && i < 2; ++i) {
    const toml::node& one = (*list)[i];
    sound = one.is_string() || one.is_number();
    text += (i > 0 ? "," : "") + scalar_text(one);
  }
  if (!sound || std::ranges::count(text, ',') != 1) {
    throw InputError(fmt::format("{}: expected a strand and a point", key), place,
                     fmt::format("give {} = [\"NAME\", \"tip\"], with the name or the "
                                 "number of a strand",
                                 key));
  }
  read.set(key, text, place);
}

/// Refuses keys that the kind of a joint does not read.
void check_keys(const Table& table) {
  const std::string_view kind = table.values().word("kind");
  const auto refuse = [&](const char* key, const char* of) {
    if (!table.given(key) || kind == of) return;
    throw InputError(fmt::format("{} of a joint with kind = \"{}\"", key, kind),
                     table.place(key),
                     fmt::format("leave it out, or give kind = \"{}\"", of));
  };
  refuse("axis", "hinge");
  for (const char* key : {"stiffness_n_per_m", "damping_n_s_per_m", "rest_length_m"}) {
    refuse(key, "spring");
  }
  refuse_if(kind == "hinge" && norm(table.values().vec("axis")) == 0,
            "a hinge without an axis",
            table.given("axis") ? table.place("axis") : table.place("kind"),
            "give [joints] axis, such as [0, 1, 0]");
  refuse_if(kind == "spring" && table.values().number("stiffness_n_per_m") == 0 &&
                table.values().number("damping_n_s_per_m") == 0,
            "a spring without stiffness", table.place("kind"), "give stiffness_n_per_m");
}

JointKind kind_of(const Table& table) {
  const std::string_view kind = table.values().word("kind");
  return kind == "ball"    ? JointKind::ball
         : kind == "weld"  ? JointKind::weld
         : kind == "hinge" ? JointKind::hinge
                           : JointKind::spring;
}

/// The strands that [strand] tables describe, by name and by number; `strands` by number
/// where no table describes them.
std::map<std::string, std::size_t> strands_by_name(const StrandTables& tables,
                                                   std::size_t strands) {
  std::map<std::string, std::size_t> all;
  for (std::size_t i = 0; !describe_strands(&tables) && i < strands; ++i) {
    all.emplace(std::to_string(i), i);
  }
  for (std::size_t i = 0; i < tables.sources.size(); ++i) {
    const StrandSource& source = tables.sources[i];
    if (source.groom) break;  // after all [strand]
    all.emplace(std::to_string(i), i);
    const std::string name(source.table.values().word("name"));
    if (name.empty()) continue;
    refuse_if(!all.emplace(name, i).second, fmt::format("a second strand '{}'", name),
              source.table.place("name"), "give strands different names, not numbers");
  }
  return all;
}

}  // namespace

std::span<const Parameter> joint_table_parameters() { return joint_parameters; }

Table read_joint(const toml::table& table, const std::string& file) {
  constexpr std::string_view own[] = {"a", "b"};
  Table read = read_table(table, joint_parameters, "[joints]", file, own);
  for (const char* key : {"a", "b"}) read_end(table, key, file, read);
  check_keys(read);
  return read;
}

SceneJoints::SceneJoints(const Scene& scene)
    : tables_(scene.tables), on_bodies_(SceneSupports(scene).on_bodies()) {
  if (tables_ != nullptr && !tables().empty()) read_ends(scene.strands.size());
  std::size_t last = 0;
  for (const Ends& ends : ends_) last = std::max({last, ends.a, ends.b});
  const bool one = scene.strands.size() < 2 && on_bodies_.empty();
  if (!has_driven_bodies(scene) || one) {
    if (any()) find_groups(last + 1);
    return;
  }
  Group all{.count = std::max(scene.strands.size(), last + 1)};
  for (std::size_t j = 0; j < ends_.size(); ++j) all.joints.push_back(j);
  groups_.push_back(std::move(all));
}

void SceneJoints::read_ends(std::size_t count) {
  const auto strands = strands_by_name(*tables_, count);
  std::string known;
  for (const auto& [name, number] : strands) known += (known.empty() ? "" : ", ") + name;
  for (const Table& table : tables()) {
    const auto find = [&](std::string_view key) {
      const std::string name = end_of(table, key).first;
      const auto found = strands.find(name);
      refuse_if(found == strands.end(), fmt::format("a joint of a strand '{}'", name),
                table.place(key),
                known.empty() ? "joints are of strands with [strand]; there are none"
                              : "use one of: " + known);
      return found->second;
    };
    const std::size_t a = find("a"), b = find("b");
    ends_.push_back({a, b});
    refuse_if(a == b && end_of(table, "a").second == end_of(table, "b").second,
              "a joint of a point with itself", table.place("b"), "join two points");
  }
}

/// The smallest ranges of strands that contain whole joints.
void SceneJoints::find_groups(std::size_t strands) {
  for (std::size_t first = 0; first < strands;) {
    Group group{.first = first};
    for (std::size_t k = first; k < first + group.count; ++k) {
      for (const auto& [a, b] : ends_) {
        if (a != k && b != k) continue;
        group.count = std::max(group.count, std::max(a, b) + 1 - first);
      }
    }
    for (std::size_t j = 0; j < ends_.size(); ++j) {
      const bool inside = ends_[j].a >= first && ends_[j].a < first + group.count;
      if (inside) group.joints.push_back(j);
    }
    first += group.count;
    if (!group.joints.empty()) groups_.push_back(std::move(group));
  }
}

const std::vector<Table>& SceneJoints::tables() const { return tables_->joints; }

const SceneJoints::Group* SceneJoints::beginning_with(std::size_t strand) const {
  const auto found = std::ranges::find(groups_, strand, &Group::first);
  return found == groups_.end() ? nullptr : &*found;
}

const SceneJoints::Group* SceneJoints::of(std::size_t strand) const {
  const auto found = std::ranges::find_if(groups_, [strand](const Group& group) {
    return strand >= group.first && strand < group.first + group.count;
  });
  return found == groups_.end() ? nullptr : &*found;
}

std::vector<NamedSupport> SceneJoints::named() const {
  std::vector<NamedSupport> all;
  for (const Group& group : groups_) {
    for (const std::size_t j : group.joints) {
      const JointKind kind = kind_of(tables()[j]);
      const bool turns = kind == JointKind::weld || kind == JointKind::hinge;
      const std::string name = fmt::format("joint_{}", j);
      all.push_back({name, true, turns, name + " on its end b"});
    }
  }
  return all;
}

std::vector<std::string> SceneJoints::places(const Group& group) const {
  std::vector<std::string> all;
  for (const std::size_t j : group.joints) all.push_back(tables()[j].place());
  for (const auto& support : on_bodies_) all.push_back(support.table->place());
  return all;
}

const std::string& SceneJoints::place() const { return tables().front().place(); }

std::unique_ptr<System> SceneJoints::join(const Group& group,
                                          std::vector<std::unique_ptr<System>> systems,
                                          std::span<const Strand* const> strands,
                                          const models::Effects& effects) const {
  std::vector<std::unique_ptr<SupportedSystem>> held;
  std::vector<std::vector<double>> x;
  const bool joined = hold(group);
  const std::string where = joined ? places(group).front() : "effect body";
  for (std::size_t k = 0; k < systems.size(); ++k) {
    models::check_unbranched(*strands[k], where);
    MaterialPoints* const points = systems[k]->material_points();
    refuse_if(points == nullptr ||
                  points->count() != static_cast<int>(strands[k]->segments.size()) + 1,
              fmt::format("{} of a model without points at the ends of its elements",
                          joined ? "joints" : "several strands"),
              where, "use another model");
    refuse_if(joined && systems[k]->contact_form() != nullptr,
              "joints of a strand with exact contact: the response of contacts to their "
              "forces leaves joints out",
              where, "use friction_law = \"regularised\" for bodies");
    const auto n = static_cast<std::size_t>(systems[k]->layout().coordinates);
    std::vector<double> q(n), v(n);
    systems[k]->initial_state(q, v);
    points->positions(0, q,
                      x.emplace_back(3 * static_cast<std::size_t>(points->count())));
    held.push_back(models::as_supported(std::move(systems[k])));
  }
  std::vector<Joint> joints;
  for (const std::size_t j : group.joints) {
    const Table& table = tables()[j];
    const Parameters& p = table.values();
    Joint joint{.kind = kind_of(table)};
    const auto end = [&](std::string_view key, std::size_t number, models::RodJoint& half,
                         std::optional<Frame>& begin) {
      const std::size_t k = number - group.first;
      const auto [name, at] = end_of(table, key);
      const int point =
          point_at(at, *strands[k], fmt::format("strand {}", name), table.place(key));
      prepare_half(*strands[k], *held[k], point, half, begin);
      return models::StrandPoint{k, point};
    };
    joint.a = end("a", ends_[j].a, joint.half_a, joint.begin_a);
    joint.b = end("b", ends_[j].b, joint.half_b, joint.begin_b);
    joint.axis = p.vec("axis");
    joint.stiffness = p.number("stiffness_n_per_m");
    joint.damping = p.number("damping_n_s_per_m");
    const auto place = [&x](const models::StrandPoint& at) {
      return load3(&x[at.strand][3 * static_cast<std::size_t>(at.point)]);
    };
    const double distance = norm(place(joint.b) - place(joint.a));
    // Points that coincide up to rounding have no direction.
    constexpr double coincident = 1e-9;  // of the length
    joint.rest_length = table.given("rest_length_m") ? p.number("rest_length_m")
                        : distance > coincident * strands.front()->length() ? distance
                                                                            : 0;
    joints.push_back(joint);
  }
  std::vector<PointOnBody> on_bodies;
  for (const BodySupport& support : on_bodies_) {
    const Parameters& p = support.table->values();
    const auto number = static_cast<std::size_t>(p.whole("strand"));
    const std::size_t k = number - group.first;
    const int point =
        point_at(p.word("at"), *strands[k], fmt::format("strand {}", number),
                 support.table->place("at"));
    on_bodies.push_back({support, {k, point}});
  }
  const std::size_t bodies =
      add_body_joints(on_bodies, effects, {strands, x, held, joints});
  return std::make_unique<models::JoinedSystem>(std::move(held), joints, places(group),
                                                bodies);
}

void SceneJoints::check(const Scene& scene) const {
  if (!any()) return;
  refuse_if(scene.rest == RestStrains::inverse,
            "joints with rest = \"inverse\", which balances strands without their forces",
            place(), "leave out rest, or the joints");
  const Parameters* interaction = scene.interaction();
  refuse_if(interaction != nullptr && interaction->word("coupling") == "monolithic",
            "joints next to coupling = \"monolithic\"", place(),
            "use [effects.strand_interaction] coupling = \"lagged\"");
  refuse_if(scene.friction() != nullptr,
            "joints of strands that rub, whose impulses leave joints out", place(),
            "leave out [effects.strand_friction], or the joints");
  refuse_if(scene.failed_strands == FailedStrands::stay,
            "failed_strands = \"stay\" for joined strands, which are one system", place(),
            "leave out failed_strands");
}

bool has_constraints(const Scene& scene) {
  return SceneSupports(scene).constrain() || SceneJoints(scene).any();
}

}  // namespace tress::simulation
