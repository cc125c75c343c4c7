#include "simulation/scene_text/write_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "integrators/integrator_options.h"
#include "simulation/scene/gradient_table.h"
#include "simulation/scene/scene_check.h"
#include "simulation/scene/scene_tables.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {
namespace {

/// "1,2;3,4" in brackets: "[[1, 2], [3, 4]]".
std::string list(std::string_view numbers, bool rows) {
  std::string text;
  for (const char c : numbers) {
    if (c == ';') {
      text += "], [";
    } else if (c == ',') {
      text += ", ";
    } else {
      text += c;
    }
  }
  if (!rows) return fmt::format("[{}]", text);
  return text.empty() ? "[]" : fmt::format("[[{}]]", text);
}

std::string quoted(std::string_view text) {
  std::string all = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') all += '\\';
    all += c;
  }
  return all + '"';
}

/// "a,b": ["a", "b"].
std::string quoted_list(std::string_view list) {
  std::string all;
  for (const std::string& one : names_of(list)) {
    all += (all.empty() ? "" : ", ") + quoted(std::string_view(one));
  }
  return "[" + all + "]";
}

void add_header(std::string& text, std::string_view name) {
  fmt::format_to(std::back_inserter(text), "\n{}\n", name);
}

std::string absolute(std::string_view file) {
  return std::filesystem::absolute(file).lexically_normal().string();
}

void add_key(std::string& text, const Parameter& p, std::string_view value) {
  std::string full;
  if (p.text && p.name.ends_with("file") && !value.empty()) {
    value = full = absolute(value);
  } else if (p.text && p.name.ends_with("files")) {
    for (const std::string& one : names_of(value)) {
      full += (full.empty() ? "" : ",") + absolute(one);
    }
    value = full;
  }
  fmt::format_to(std::back_inserter(text), "{} = {}\n", p.name, toml_value(p, value));
}

/// The keys whose values, `value(p)`, are not the defaults.
template <class F>
void add_changed(std::string& text, std::span<const Parameter> declared, const F& value) {
  for (const Parameter& p : declared) {
    const std::string own = value(p);
    if (own != p.default_text()) add_key(text, p, own);
  }
}

void add_parameters(std::string& text, std::span<const Parameter> declared,
                    const Parameters& values) {
  add_changed(text, declared, [&](const Parameter& p) { return values.text(p.name); });
}

/// The keys that were given, for tables where giving a default value makes a difference.
void add_given(std::string& text, const Table& table) {
  for (const Parameter& p : table.declared()) {
    if (table.given(p.name)) add_key(text, p, table.text(p.name));
  }
}

void add_top(std::string& text, const Scene& scene) {
  add_changed(text, top_parameters(), [&scene](const Parameter& p) -> std::string {
    if (p.name == "title") return scene.title;
    if (p.name == "source") return scene.source;
    if (p.name == "duration_s") return number_text(scene.duration);
    if (p.name == "frames_per_s") return number_text(scene.frame_rate);
    if (p.name == "checkpoint_s") return number_text(scene.checkpoint);
    if (p.name == "guard") return scene.guard ? "true" : "false";
    if (p.name == "failed_strands") {
      return scene.failed_strands == FailedStrands::stay ? "stay" : "end_run";
    }
    if (p.name == "rest") {
      return scene.rest == RestStrains::inverse ? "inverse" : "natural";
    }
    if (p.name == "unstable") {
      return scene.unstable == Unstable::stiffen ? "stiffen"
             : scene.unstable == Unstable::keep  ? "keep"
                                                 : "drop";
    }
    if (p.name == "seed") return std::to_string(scene.seed);
    throw std::logic_error("a key of scenes that is not written");
  });
}

void add_integrator(std::string& text, const Scene& scene) {
  const Options defaults;
  add_header(text, "[integrator]");
  for (const Parameter& p : integrator_table_parameters()) {
    if (p.name == "id") {
      add_key(text, p, scene.integrator);
      continue;
    }
    const std::string_view option = option_of(p.name);
    const std::string value = text_of(scene.options, option);
    if (value == text_of(defaults, option) || !idle_option(scene, option).empty())
      continue;
    add_key(text, p, value);
  }
}

void add_strands(std::string& text, const StrandTables& tables) {
  add_header(text, "[material]");
  add_given(text, tables.material);
  for (const StrandSource& source : tables.sources) {
    const std::string_view name = source.groom ? "groom" : "strand";
    add_header(text, fmt::format("[[{}]]", name));
    add_given(text, source.table);
    if (!source.material) continue;
    add_header(text, fmt::format("[{}.material]", name));
    add_given(text, *source.material);
  }
  add_header(text, "[root]");
  add_given(text, tables.root);
  const auto add_each = [&text](std::string_view name, const std::vector<Table>& all) {
    for (const Table& one : all) {
      add_header(text, name);
      add_given(text, one);
    }
  };
  add_each("[[supports]]", tables.supports);
  add_each("[[joints]]", tables.joints);
  add_each("[[effects.point_moment]]", tables.driven.moments);
  add_each("[[effects.natural_shape]]", tables.driven.shapes);
  if (!tables.gradient) return;
  add_header(text, "[gradient]");
  add_given(text, *tables.gradient);
}

void add_effects(std::string& text, const Scene& scene) {
  for (const EffectChoice& effect : scene.effects) {
    const EffectEntry& entry = *effect.entry;
    add_header(text,
               fmt::format(fmt::runtime(entry.many ? "[[effects.{}]]" : "[effects.{}]"),
                           entry.id));
    add_parameters(text, entry.parameters, effect.parameters);
  }
}

}  // namespace

std::string toml_value(const Parameter& parameter, std::string_view text) {
  if (parameter.choices == "true|false") return std::string(text);
  if (parameter.text && parameter.rows) return quoted_list(text);
  if (parameter.text || !parameter.choices.empty()) return quoted(text);
  const bool many = parameter.rows || parameter.components > 1;
  return many ? list(text, parameter.rows) : std::string(text);
}

std::string scene_text(const Scene& scene) {
  if (!describe_strands(scene.tables.get()) && !scene.strands.empty()) {
    throw std::logic_error("strands without a table cannot be written");
  }
  std::string text;
  add_top(text, scene);
  add_header(text, "[model]");
  text += fmt::format("id = \"{}\"\n", scene.model->id);
  const auto declared = model_table_parameters(*scene.model);
  add_parameters(text, declared.subspan(1), scene.model_options);
  add_integrator(text, scene);
  if (scene.tables == nullptr) return text;
  add_strands(text, *scene.tables);
  add_effects(text, scene);
  return text;
}

}  // namespace tress::simulation
