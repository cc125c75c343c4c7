#include "simulation/run/head_classes.h"

#include <algorithm>
#include <exception>
#include <map>
#include <string>

#include "simulation/run/crew.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {

bool has_classes(const SceneOutline& outline) {
  return outline.series != nullptr &&
         std::ranges::any_of(outline.scene.tables->sources, [](const auto& source) {
           return source.groom && detail_tolerance(source.table.values()) > 0;
         });
}

std::vector<HeadClass> head_classes(const SceneOutline& outline, int threads) {
  const StrandSeries& all = *outline.series;
  std::vector<int> elements(all.size());
  Crew crew(threads);
  const std::size_t parts = 16 * static_cast<std::size_t>(threads);
  std::vector<std::exception_ptr> errors(parts);
  crew.run(parts, [&](std::size_t part) {
    const std::size_t end = all.size() * (part + 1) / parts;
    try {
      for (std::size_t k = all.size() * part / parts; k < end; ++k) {
        elements[k] = static_cast<int>(all.strand(k).segments.size());
      }
    } catch (...) {
      errors[part] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
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

std::optional<NoHead> no_classes(const SceneOutline& outline) {
  if (outline.scene.interaction() == nullptr) return {};
  return NoHead{"strands of several numbers of elements that touch each other",
                "leave out the tolerance of the groom, or [effects.strand_interaction]"};
}

}  // namespace tress::simulation
