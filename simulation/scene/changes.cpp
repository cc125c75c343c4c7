#include "simulation/scene/changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "contract/input_error.h"
#include "simulation/scene/scene_tables.h"

namespace tress {
namespace {

/// Equal pieces of an unbranched strand. Every new piece takes from each old one the
/// share that lies within it.
Strand cut(const Strand& strand, int elements) {
  Strand made = strand;
  made.segments.clear();
  double length = 0;
  for (const Segment& old : strand.segments) length += old.length;
  const double piece = length / elements;
  for (int i = 0; i < elements; ++i) {
    const double from = i * piece, to = from + piece;
    Segment fresh = strand.segments.front();
    fresh.parent = i - 1;
    fresh.length = piece;
    fresh.natural = fresh.initial = {};
    if (i > 0) fresh.mount = {};
    double start = 0, most = 0;
    for (const Segment& old : strand.segments) {
      const double end = start + old.length;
      const double share = std::max(0.0, std::min(to, end) - std::max(from, start));
      fresh.natural = fresh.natural + (share / piece) * old.natural;
      fresh.initial = fresh.initial + (share / piece) * old.initial;
      if (share > most) fresh.section = old.section;
      most = std::max(most, share);
      start = end;
    }
    made.segments.push_back(fresh);
  }
  return made;
}

}  // namespace

std::string_view Method::word(std::string_view choice) const {
  for (const auto& [key, value] : options) {
    if (key == choice) return value;
  }
  for (const Parameter& p : model->parameters) {
    if (p.name == choice && !p.choices.empty()) return words_of(p.choices).front();
  }
  return {};
}

Scene with_method(Scene scene, const Method& method) {
  scene.model = method.model;
  scene.model_options = Parameters(model_table_parameters(*method.model), "[model]");
  scene.model_options.set("id", method.model->id);
  for (const auto& [key, value] : method.options) scene.model_options.set(key, value);
  scene.integrator = method.integrator;
  Options options;
  options.step = scene.options.step;
  options.formulation = method.formulation;
  scene.options = options;
  return scene;
}

Scene with_elements(Scene scene, int elements) {
  if (elements < 1) {
    throw InputError(fmt::format("{} elements", elements), "elements",
                     "give one or more");
  }
  for (Strand& strand : scene.strands) {
    for (std::size_t i = 0; i < strand.segments.size(); ++i) {
      if (strand.segments[i].parent == static_cast<int>(i) - 1) continue;
      throw InputError("a strand that branches", "scene " + scene.name,
                       "give strands without branches");
    }
    strand = cut(strand, elements);
  }
  return scene;
}

}  // namespace tress
