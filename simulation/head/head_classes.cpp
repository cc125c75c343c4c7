#include "simulation/head/head_classes.h"

#include <algorithm>
#include <map>
#include <string>

#include "simulation/scene/strand_tables.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {

bool has_classes(const SceneOutline& outline) {
  if (outline.series == nullptr) return false;
  const auto& sources = outline.scene.tables->sources;
  const auto elements = [](const StrandSource& source) {
    return source.table.values().whole("elements");
  };
  return std::ranges::any_of(sources, has_tolerance) ||
         std::ranges::adjacent_find(sources, std::ranges::not_equal_to{}, elements) !=
             sources.end();
}

std::vector<HeadClass> head_classes(const SceneOutline& outline, int threads) {
  const StrandSeries& all = *outline.series;
  std::vector<int> elements(all.size());
  Crew crew(threads);
  const std::size_t parts = 16 * static_cast<std::size_t>(threads);
  in_parts(crew, 0, all.size(), parts, [&](std::size_t k, std::size_t) {
    elements[k] = static_cast<int>(all.strand(k).segments.size());
  });
  std::map<int, std::vector<std::size_t>> classes;
  for (std::size_t k = 0; k < all.size(); ++k) classes[elements[k]].push_back(k);
  std::vector<HeadClass> made;
  for (auto& [count, strands] : classes) {
    HeadClass one{count, outline};
    one.outline.series = std::make_shared<const StrandSeries>(all, std::move(strands));
    one.outline.scene.strands = {one.outline.series->strand(0)};
    one.outline.scene.name += '.' + std::to_string(count);
    made.push_back(std::move(one));
  }
  return made;
}

std::optional<NoHead> no_single_head(const SceneOutline& outline,
                                     models::HeadNumber number) {
  if (has_classes(outline)) {
    return NoHead{"strands of several numbers of elements",
                  "give all equally many elements, and no tolerance"};
  }
  return no_head(outline, number);
}

std::optional<NoHead> no_classes(const SceneOutline& outline) {
  if (outline.scene.interaction() == nullptr) return {};
  return NoHead{"strands of several numbers of elements that touch each other",
                "give all equally many elements, or leave out "
                "[effects.strand_interaction]",
                "effects.strand_interaction"};
}

}  // namespace tress::simulation
