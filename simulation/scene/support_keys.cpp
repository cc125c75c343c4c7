#include "simulation/scene/support_keys.h"

#include <fmt/format.h>

#include "contract/input_error.h"
#include "simulation/scene/support_table.h"
#include "simulation/table/read_table.h"

// The keys of [[supports]].
namespace tress::simulation {
namespace {

constexpr double farthest_place = 1e6, most_stiffness = 1e12;

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
    {.name = "on",
     .help = "carrier of the support, which moves it rigidly: \"head\" (the motion of "
             "[root]), or a body that moves. Strands drive a body with moves = "
             "\"turns\" or \"free\" by it. A body has its name in the columns, such as "
             "\"body_2\". Empty: none",
     .text = true,
     .fallback = ""},
    {.name = "slide",
     .help =
         "direction in which the point slides freely, in the world, of any length; 0, "
         "0, 0: none",
     .min = -farthest_place,
     .max = farthest_place,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "stiffness_n_per_m",
     .help = "stiffness of a compliant support against displacements (N/m), which "
             "exerts a force in place of a constraint. 0: rigid",
     .number = 0,
     .min = 0,
     .max = most_stiffness},
    {.name = "damping_n_s_per_m",
     .help = "force of a compliant support over the velocity relative to it (N s/m)",
     .number = 0,
     .min = 0,
     .max = most_stiffness},
    {.name = "turn_stiffness_n_m_per_rad",
     .help = "stiffness of a compliant support against rotations (N m/rad), at small "
             "angles. 0: rigid",
     .number = 0,
     .min = 0,
     .max = most_stiffness},
    {.name = "turn_damping_n_m_s_per_rad",
     .help = "moment of a compliant support over the angular velocity relative to it (N "
             "m s/rad)",
     .number = 0,
     .min = 0,
     .max = most_stiffness},
};

/// Refuses the damping of a rigid support.
void check_damping(const Table& table, const char* damping, const char* stiffness) {
  if (table.values().number(damping) == 0 || table.values().number(stiffness) > 0) return;
  throw InputError(fmt::format("{} of a rigid support", damping), table.place(damping),
                   fmt::format("give {}, or leave out the damping", stiffness));
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
  for (const char* key : {"keyframes", "directions", "twist_rad"}) {
    if (table.values().word("on").empty() || !table.given(key)) continue;
    throw InputError(fmt::format("{} of a support with on = \"{}\", which moves it", key,
                                 table.values().word("on")),
                     table.place(key), "leave out one of them");
  }
  refuse_if(!table.values().word("on").empty() && norm(table.values().vec("slide")) > 0,
            "a slide of a support that a body carries", table.place("slide"),
            "leave it out, or leave out on");
  const auto refuse_number = [&](const char* key, const char* why, const char* remedy) {
    if (table.values().number(key) > 0) refuse(key, why, remedy);
  };
  if (kind == "ball") {
    refuse_number("turn_stiffness_n_m_per_rad", "which holds no direction", leave);
    refuse_number("turn_damping_n_m_s_per_rad", "which holds no direction", leave);
  }
  if (kind == "direction") {
    refuse_number("stiffness_n_per_m", "which holds no position",
                  "leave it out, or give turn_stiffness_n_m_per_rad");
    refuse_number("damping_n_s_per_m", "which holds no position",
                  "leave it out, or give turn_damping_n_m_s_per_rad");
  }
  check_damping(table, "damping_n_s_per_m", "stiffness_n_per_m");
  check_damping(table, "turn_damping_n_m_s_per_rad", "turn_stiffness_n_m_per_rad");
  if (kind == "direction") {
    refuse("keyframes", "which holds no position", leave);
    refuse("slide", "which holds no position", leave);
  }
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
  check_keys(read);
  return read;
}

bool compliant(const Table& table) {
  const std::string_view kind = table.values().word("kind");
  return (kind == "direction" || table.values().number("stiffness_n_per_m") > 0) &&
         (kind == "ball" || table.values().number("turn_stiffness_n_m_per_rad") > 0);
}

}  // namespace tress::simulation
