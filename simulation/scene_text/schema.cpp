#include "simulation/scene_text/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "simulation/files/toml_text.h"
#include "simulation/scene/material_table.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::simulation {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::string range(const Parameter& p) {
  if (p.text) return p.rows ? "list of texts" : "text";
  if (!p.choices.empty()) return fmt::format("{}", fmt::join(words_of(p.choices), ", "));
  std::string text = p.whole ? "whole, " : "";
  if (p.min == -infinite && p.max == infinite) {
    text += "any";
  } else if (p.max == infinite) {
    fmt::format_to(std::back_inserter(text), "{:g} or more", p.min);
  } else {
    fmt::format_to(std::back_inserter(text), "{:g} to {:g}", p.min, p.max);
  }
  return text;
}

// --- the page
// -----------------------------------------------------------------------------

constexpr std::string_view page_head =
    R"(<!-- Written by `simulate --print-schema`; a test compares. -->
# Scenes

A scene is a TOML file: what moves (`[model]`, and `[strand]` or `[groom]`), how time advances
(`[integrator]`), what drives it (`[root]`) and which effects act (`[effects.*]`). An effect that a
scene does not name is not built and costs nothing. Everything else has the default of this page;
`simulate --print-defaults` writes a short scene to start from. That scene is an example: it sets
`tr_bdf2` and steps of 2 ms. A key that you delete has the default of this page.

Numbers are in SI units. Most keys end with their unit, without signs; the description has the exact
unit in parentheses. `stiffness_n_m` is in N m at `[root]`, but in N/m at a tether. Vectors are lists,
`[x, y, z]`; rows are lists of lists. z is up, a head faces x. Several strands, grooms or effects of one kind are written
`[[strand]]`, `[[groom]]`, `[[effects.body]]`. Files are named relative to the scene's folder. A key
that is misspelt, out of range, without effect, or refused by a model or integrator is reported
with file:line:column.
)";

void add_keys(std::string& page, std::span<const Parameter> parameters,
              std::string_view but = {}) {
  const auto out = std::back_inserter(page);
  bool first = true;
  for (const Parameter& p : parameters) {
    if (p.name == but) continue;
    if (first) page += "\n| key | default | range | |\n|---|---|---|---|\n";
    first = false;
    fmt::format_to(out, "| `{}` | `{}` | {} | {} |\n", p.name, default_value(p), range(p),
                   p.help);
  }
  if (first) page += "\nNo keys.\n";
}

void add_uses(std::string& page, const TableEntry& entry) {
  if (entry.uses.empty()) return;
  page += "\nKeys that apply to one choice only:\n\n";
  for (const Use& use : entry.uses) {
    fmt::format_to(std::back_inserter(page), "- `{} = \"{}\"`: `{}`\n", entry.choice,
                   use.word, fmt::join(words_of(use.keys), "`, `"));
  }
}

/// The values that each name stands for.
void add_materials(std::string& page) {
  page +=
      "\n| name | radius | ellipticity | E | G | density | curl radius, pitch |\n"
      "|---|---|---|---|---|---|---|\n";
  const auto parameters = material_table_parameters();
  for (const std::string_view name : words_of(parameters.front().choices)) {
    if (name == "custom") continue;
    Table table(parameters, "[material]", "");
    table.set("name", name, "");
    const StrandMaterial m = strand_material(table, nullptr);
    fmt::format_to(
        std::back_inserter(page),
        "| `{}` | {:.1f} um | {:.2f} | {:.2f} GPa | {:.2f} GPa | {:.0f} kg/m^3 | "
        "{:g}, {:g} mm |\n",
        name, 1e6 * std::sqrt(m.section.a1 * m.section.a2), m.section.a1 / m.section.a2,
        1e-9 * m.material.youngs_modulus, 1e-9 * m.material.shear_modulus,
        m.material.density, 1e3 * m.curl_radius, 1e3 * m.curl_pitch);
  }
  page +=
      "\n[Materials](../docs/start/faq.md#materials) lists the source of each value.\n";
}

void add_models(std::string& page) {
  page +=
      "\n## [model]\n\nWhich model; `id` and its own options. A model that brings its "
      "own geometry takes no\n`[strand]`, `[groom]`, `[material]`, `[root]` and "
      "`[effects.*]`.\n";
  const auto out = std::back_inserter(page);
  for (const ModelEntry& model : model_catalogue()) {
    fmt::format_to(out, "\n### id = \"{}\"\n\n{} ({}).{}\n", model.id, model.summary,
                   model.source,
                   model.on_strand == nullptr ? " Brings its own geometry." : "");
    add_keys(page, model_table_parameters(model), "id");
  }
}

// --- the scene to start from
// ------------------------------------------------------------------

constexpr std::string_view defaults_head =
    "# A hair, clamped at its root, falls from the horizontal and swings. All that this\n"
    "# file does not name has its default: scenes/README.md lists every table and key.\n"
    "title = \"a hair that swings\"\n"
    "source = \"simulate --print-defaults\"\n";

/// Keys shown, in the order of the page. Some have a value that suits the scene better
/// than the default. One is a method that hardly damps the resolved motion. Others are
/// the internal friction of measured hair (E I times 2 ms, E = 3.9 GPa) and the drag of
/// still air on a hair, 72 um thick.
struct Shown {
  std::string_view table, keys;
};
constexpr Shown shown[] = {{"integrator", "id=tr_bdf2|dt_s=0.002"},
                           {"material", "name|internal_friction_kg_m3_s=1e-11"},
                           {"strand", "length_m|elements|root_tangent"},
                           {"root", "motion"},
                           {"effects.gravity", "gravity_m_s2"},
                           {"effects.linear_drag", "drag_kg_m_s=8e-05"}};

/// key = value with help and range above; `keys` as "a|b=value".
void add_values(std::string& scene, std::span<const Parameter> parameters,
                std::string_view keys) {
  for (const std::string_view shown_key : words_of(keys)) {
    const std::size_t equals = shown_key.find('=');
    const auto p =
        std::ranges::find(parameters, shown_key.substr(0, equals), &Parameter::name);
    const std::string value = equals == shown_key.npos
                                  ? default_value(*p)
                                  : toml_value(*p, shown_key.substr(equals + 1));
    fmt::format_to(std::back_inserter(scene), "# {}; {}\n{} = {}\n", p->help, range(*p),
                   p->name, value);
  }
}

}  // namespace

std::string default_value(const Parameter& p) { return toml_value(p, p.default_text()); }

std::string scene_schema() {
  std::string page(page_head);
  page += fmt::format(
      "\nA file has at most {} MiB. A scene has at most {} strands and {} elements. One "
      "that runs "
      "as a batch\n(`simulate --as batch`) makes its strands one at a time and has at "
      "most {} "
      "strands and {} elements.\n",
      most_toml_bytes >> 20, held_at_once.strands, held_at_once.elements,
      made_singly.strands, made_singly.elements);
  page += "\n## Before the first table\n";
  add_keys(page, top_parameters());
  add_models(page);
  for (const TableEntry& entry : table_entries()) {
    fmt::format_to(std::back_inserter(page), "\n## [{}]{}\n\n{}\n", entry.name,
                   entry.many ? fmt::format(" or [[{}]]", entry.name) : "",
                   entry.summary);
    add_keys(page, entry.parameters);
    add_uses(page, entry);
    if (entry.name == "material") add_materials(page);
  }
  return page;
}

std::string scene_defaults() {
  std::string scene(defaults_head);
  add_values(scene, top_parameters(), "duration_s|frames_per_s");
  scene += "\n[model]\n";
  add_values(scene, model_table_parameters(find_model("super_helix")), "id");
  for (const TableEntry& entry : table_entries()) {
    const auto of_table = std::ranges::find(shown, entry.name, &Shown::table);
    if (of_table == std::end(shown)) continue;
    fmt::format_to(std::back_inserter(scene), "\n# {}\n[{}]\n", entry.summary,
                   entry.name);
    add_values(scene, entry.parameters, of_table->keys);
  }
  return scene;
}

}  // namespace tress::simulation
