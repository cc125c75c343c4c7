#include "simulation/scene/strand_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "contract/input_error.h"
#include "simulation/scene/groom.h"
#include "simulation/scene/guide_choice.h"
#include "simulation/scene/root_table.h"
#include "simulation/scene/strand_table.h"

namespace tress::simulation {
namespace {

constexpr std::size_t most_strands = 10'000, most_elements = 200'000;

std::vector<Strand> strands_of(const StrandSource& source, const Common& common,
                               std::size_t strands, std::size_t elements) {
  const Table* own = source.material ? &*source.material : nullptr;
  if (!source.groom) return {scene_strand(source.table, own, common, strands)};
  const auto each = static_cast<std::size_t>(source.table.values().whole("elements"));
  const std::size_t most =
      std::min(most_strands - strands, (most_elements - elements) / each);
  return groom_strands(source.table, own, common, strands, most);
}

/// Leaves the guides of a groom, if it has any, and moves the others to the followers.
void keep_guides(const Table& groom, std::uint64_t seed, std::vector<Strand>& strands,
                 std::vector<Strand>& followers) {
  const auto guides = static_cast<std::size_t>(groom.values().whole("guides"));
  if (guides == 0) return;
  if (guides > strands.size()) {
    throw InputError(fmt::format("{} guides of {} strands", guides, strands.size()),
                     groom.place("guides"), "give at most as many as there are strands");
  }
  const std::vector<std::size_t> chosen = choose_guides(strands, guides, seed);
  std::vector<Strand> kept;
  for (std::size_t i = 0; i < strands.size(); ++i) {
    const bool guide = std::ranges::binary_search(chosen, i);
    (guide ? kept : followers).push_back(std::move(strands[i]));
  }
  strands = std::move(kept);
}

void set_elements(StrandSource& source, long elements) {
  const std::string place = source.table.place("elements");
  source.table.set("elements", std::to_string(elements), place);
}

}  // namespace

CutStrands cut_strands(const StrandTables& tables, const RootMotion& head,
                       std::uint64_t seed) {
  const std::optional<FreeRoot> free_root = free_motion(tables.root);
  const Common common{tables.material, head, free_root, seed};
  CutStrands all;
  std::size_t elements = 0;
  for (std::size_t i = 0; i < tables.sources.size(); ++i) {
    const StrandSource& source = tables.sources[i];
    std::vector<Strand> made = strands_of(source, common, all.strands.size(), elements);
    if (source.groom) keep_guides(source.table, seed, made, all.followers);
    for (Strand& strand : made) {
      elements += strand.segments.size();
      all.strands.push_back(std::move(strand));
      all.source.push_back(i);
    }
    if (all.strands.size() <= most_strands && elements <= most_elements) continue;
    throw InputError(
        fmt::format("{} strands of {} elements altogether", all.strands.size(), elements),
        source.table.place(),
        fmt::format("give at most {} strands and {} elements", most_strands,
                    most_elements));
  }
  return all;
}

StrandTables with_elements(StrandTables tables, int elements) {
  for (StrandSource& source : tables.sources) set_elements(source, elements);
  return tables;
}

StrandTables with_twice_the_elements(StrandTables tables) {
  for (StrandSource& source : tables.sources) {
    set_elements(source, 2 * source.table.values().whole("elements"));
  }
  return tables;
}

}  // namespace tress::simulation
