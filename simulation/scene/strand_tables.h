#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/strand/strand.h"
#include "simulation/scene/table.h"

namespace tress::simulation {

/// One [strand] or [groom] of a scene, with its own material if it has one.
struct StrandSource {
  Table table;
  std::optional<Table> material;
  bool groom = false;
};

/// The tables, as read, from which the strands of a scene are made.
struct StrandTables {
  Table material, root;
  std::vector<StrandSource> sources;  // each [strand], then each [groom]
};

struct CutStrands {
  std::vector<Strand> strands;
  std::vector<std::size_t> source;  // of every strand, its index in StrandTables
  std::vector<Strand> followers;    // of grooms with guides, all others
};

/// Throws InputError with the location of an invalid key, and on more strands or elements
/// than a scene may have. `head` is head_motion(tables.root).
CutStrands cut_strands(const StrandTables& tables, const RootMotion& head,
                       std::uint64_t seed);

/// The same tables with `elements` elements in every strand.
StrandTables with_elements(StrandTables tables, int elements);
/// The same tables, every strand with twice its elements.
StrandTables with_twice_the_elements(StrandTables tables);

}  // namespace tress::simulation
