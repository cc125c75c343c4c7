#include "simulation/scene/strand_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "contract/input_error.h"
#include "simulation/scene/groom.h"
#include "simulation/scene/root_table.h"
#include "simulation/scene/strand_table.h"

namespace tress::simulation {
namespace {

std::size_t elements_of(const StrandSource& source) {
  return static_cast<std::size_t>(source.table.values().whole("elements"));
}

const Table* own_material(const StrandSource& source) {
  return source.material ? &*source.material : nullptr;
}

void set_elements(StrandSource& source, long elements) {
  const std::string place = source.table.place("elements");
  source.table.set("elements", std::to_string(elements), place);
}

}  // namespace

StrandSeries::StrandSeries(std::shared_ptr<const StrandTables> tables,
                           const RootMotion& head, std::uint64_t seed, StrandLimits most)
    : tables_(std::move(tables)),
      head_(head),
      free_root_(free_motion(tables_->root)),
      common_{tables_->material, head_, free_root_, seed} {
  for (const StrandSource& source : tables_->sources) {
    const std::size_t each = elements_of(source);
    std::size_t count = 1;
    grooms_.emplace_back();
    if (source.groom) {
      const std::size_t room =
          std::min(most.strands - size(), (most.elements - elements_) / each);
      grooms_.back().emplace(source.table, own_material(source), common_, room);
      count = grooms_.back()->count();
    }
    first_.push_back(size() + count);
    elements_ += each * count;
    if (size() <= most.strands && elements_ <= most.elements) continue;
    throw InputError(
        fmt::format("{} strands of {} elements altogether", size(), elements_),
        source.table.place(),
        fmt::format("give at most {} strands and {} elements", most.strands,
                    most.elements));
  }
}

std::size_t StrandSeries::source(std::size_t k) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(first_, k) - first_.begin()) -
         1;
}

Strand StrandSeries::strand(std::size_t k) const {
  const std::size_t i = source(k);
  // Strands of one scene differ by their streams.
  if (grooms_[i]) return grooms_[i]->strand(k - first_[i], k);
  const StrandSource& source = tables_->sources[i];
  return scene_strand(source.table, own_material(source), common_, k);
}

std::vector<Strand> StrandSeries::all() const {
  std::vector<Strand> strands;
  strands.reserve(size());
  for (std::size_t k = 0; k < size(); ++k) strands.push_back(strand(k));
  return strands;
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
