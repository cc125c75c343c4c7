#include "simulation/scene/strand_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "contract/input_error.h"
#include "simulation/groom/guide_choice.h"
#include "simulation/scene/file_groom.h"
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

/// As above, without a tolerance that would give others.
void set_elements_alone(StrandSource& source, int elements) {
  set_elements(source, elements);
  if (source.groom) {
    clear_detail(source.table);
  } else if (has_tolerance(source)) {
    source.table.set("tolerance_m", "0", source.table.place("tolerance_m"));
  }
}

}  // namespace

StrandSeries::StrandSeries(std::shared_ptr<const StrandTables> tables,
                           const RootMotion& head, std::uint64_t seed, StrandLimits most)
    : StrandSeries(std::move(tables), head, seed, most, {}) {}

StrandSeries::StrandSeries(std::shared_ptr<const StrandTables> tables,
                           const RootMotion& head, std::uint64_t seed, StrandLimits most,
                           const Fits& fits)
    : tables_(std::move(tables)),
      head_(head),
      free_root_(free_motion(tables_->root)),
      common_{tables_->material, {head_, free_root_, tables_->skin.get()}, seed},
      fits_(fits) {
  fits_.resize(tables_->sources.size());
  for (std::size_t i = 0; i < tables_->sources.size(); ++i) {
    const StrandSource& source = tables_->sources[i];
    const std::size_t each = elements_of(source);
    std::size_t count = 1;
    grooms_.emplace_back();
    if (source.file) {
      count = file_strands(source.table, *source.file);
    } else if (source.groom) {
      const std::size_t room =
          std::min(most.strands - size(), (most.elements - elements_) / each);
      grooms_.back().emplace(source.table, own_material(source), common_, room);
      count = grooms_.back()->count();
    }
    first_.push_back(size() + count);
    elements_ += each * count;
    if (size() > most.strands || elements_ > most.elements) {
      throw InputError(
          fmt::format("{} strands of {} elements altogether", size(), elements_),
          source.table.place(),
          fmt::format("give at most {} strands and {} elements", most.strands,
                      most.elements));
    }
    if (source.file && !fits_[i]) {
      fits_[i] = fit_file_groom(source.table, *source.file, count);
    }
  }
}

StrandSeries::StrandSeries(const StrandSeries& all, std::vector<std::size_t> some)
    : StrandSeries(all.tables_, all.head_, all.common_.seed, made_singly, all.fits_) {
  some_ = std::move(some);
}

StrandSeries::Fits StrandSeries::fitted() const {
  Fits made;
  std::ranges::copy_if(fits_, std::back_inserter(made),
                       [](const auto& fit) { return fit != nullptr; });
  return made;
}

std::size_t StrandSeries::source(std::size_t k) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(first_, number(k)) -
                                  first_.begin()) -
         1;
}

Strand StrandSeries::strand(std::size_t k) const {
  const std::size_t i = source(k), n = number(k);
  // Strands of one scene differ by their streams.
  if (grooms_[i]) return grooms_[i]->strand(n - first_[i], n);
  const StrandSource& source = tables_->sources[i];
  if (fits_[i]) {
    return file_strand(source.table, own_material(source), common_,
                       fits_[i]->strands[n - first_[i]]);
  }
  return scene_strand(source.table, own_material(source), common_, n);
}

CutStrands StrandSeries::all() const {
  CutStrands all;
  all.fitted = fitted();
  for (std::size_t i = 0; i < grooms_.size(); ++i) {
    std::vector<Strand> made;
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) made.push_back(strand(k));
    if (tables_->sources[i].groom) {
      keep_guides(tables_->sources[i].table, common_.seed, made, all.followers);
    }
    all.source.insert(all.source.end(), made.size(), i);
    std::ranges::move(made, std::back_inserter(all.strands));
  }
  return all;
}

CutStrands StrandSeries::outline() const {
  CutStrands all;
  all.fitted = fitted();
  for (std::size_t i = 0; i < grooms_.size(); ++i) {
    all.strands.push_back(strand(first_[i]));
    all.source.push_back(i);
  }
  return all;
}

bool has_tolerance(const StrandSource& source) {
  const Parameters& p = source.table.values();
  if (!source.groom) return p.number("tolerance_m") > 0;
  return detail_tolerance(source.table) > 0 || p.number("fit_tolerance") > 0;
}

void clear_detail(Table& groom) {
  for (const Parameter& p : detail_parameters()) {
    const std::string key(p.name);
    groom.set(key, "0", groom.place(key));
  }
}

StrandTables with_elements(StrandTables tables, int elements) {
  for (StrandSource& source : tables.sources) set_elements_alone(source, elements);
  return tables;
}

StrandTables with_elements(StrandTables tables, std::span<const int> elements) {
  for (std::size_t i = 0; i < tables.sources.size(); ++i) {
    if (elements[i] > 0) set_elements_alone(tables.sources[i], elements[i]);
  }
  return tables;
}

StrandTables with_cuts(StrandTables tables, std::string_view cuts) {
  for (StrandSource& source : tables.sources) {
    if (source.groom || source.table.values().word("mesh") == cuts) continue;
    source.table.set("mesh", std::string(cuts), source.table.place("mesh"));
  }
  return tables;
}

StrandTables with_twice_the_elements(StrandTables tables) {
  for (StrandSource& source : tables.sources) {
    if (has_tolerance(source)) {
      throw InputError("elements that follow from a tolerance cannot be doubled",
                       source.table.place(), "leave out the tolerance");
    }
    set_elements(source, 2 * source.table.values().whole("elements"));
  }
  return tables;
}

}  // namespace tress::simulation
