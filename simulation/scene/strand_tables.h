#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "models/strand/strand.h"
#include "simulation/driven/driven_tables.h"
#include "simulation/groom/fitted_groom.h"
#include "simulation/scene/groom.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// One [strand] or [groom] of a scene, with its own material if it has one.
struct StrandSource {
  Table table;                    // the table as read
  std::optional<Table> material;  // its own [material], if it has one
  bool groom = false;             // whether it is a [groom]
  /// The strands of a groom's file; null: it makes them up.
  std::shared_ptr<const PlacedGroom> file = {};
};

/// The tables, as read, from which the strands of a scene are made. [gradient] names
/// numbers of them, [supports] and [joints] hold their points, and other tables drive
/// their sections.
struct StrandTables {
  Table material, root;                   // the scene's [material] and [root]
  std::vector<StrandSource> sources;      // each [strand], then each [groom]
  std::optional<Table> gradient = {};     // the scene's [gradient], if it has one
  std::vector<Table> supports = {};       // each [[supports]]
  std::vector<Table> joints = {};         // each [[joints]]
  DrivenTables driven = {};               // moments, and natural shapes over time
  std::shared_ptr<const Skin> skin = {};  // surface that carries roots, or null
};

/// Returns whether there are tables from which the strands can be made again.
inline bool describe_strands(const StrandTables* tables) {
  return tables != nullptr && !tables->sources.empty();
}

/// Strands of a scene, divided into elements.
struct CutStrands {
  std::vector<Strand> strands;      // strands that are simulated
  std::vector<std::size_t> source;  // of every strand, its index in StrandTables
  std::vector<Strand> followers;    // of grooms with guides, all others
  std::vector<std::shared_ptr<const FittedGroom>> fitted;  // of grooms from files
};

/// Limits of a scene that is read whole, and of one whose strands are made one at a
/// time.
struct StrandLimits {
  std::size_t strands, elements;  // bounds of strands and of their elements
};
/// Limits of a scene that is read whole.
inline constexpr StrandLimits held_at_once{10'000, 200'000};
/// Limits of a scene whose strands are made one at a time.
inline constexpr StrandLimits made_singly{1'000'000, 20'000'000};

/// The strands that the tables describe, made one at a time, by any number of threads.
class StrandSeries {
 public:
  /// Throws InputError with the location of an invalid key, and on more strands or
  /// elements than `most`. `head` is head_motion(tables.root).
  StrandSeries(std::shared_ptr<const StrandTables> tables, const RootMotion& head,
               std::uint64_t seed, StrandLimits most);
  /// Some strands of a series, ascending.
  StrandSeries(const StrandSeries& all, std::vector<std::size_t> some);
  StrandSeries(const StrandSeries&) = delete;
  StrandSeries& operator=(const StrandSeries&) = delete;

  /// Returns the number of strands.
  std::size_t size() const { return some_.empty() ? first_.back() : some_.size(); }
  /// Returns the number of elements of all strands.
  std::size_t elements() const { return elements_; }
  /// Throws InputError with the location of an invalid key.
  Strand strand(std::size_t k) const;
  /// Index in StrandTables::sources of the table that strand k comes from.
  std::size_t source(std::size_t k) const;
  /// First strand of each of these tables, and the end; for a series of all.
  std::span<const std::size_t> first() const { return first_; }
  /// Returns the number of strand k among all that the tables describe.
  std::size_t number(std::size_t k) const { return some_.empty() ? k : some_[k]; }
  /// Makes all strands.
  CutStrands all() const;
  /// The fits of all grooms from files.
  std::vector<std::shared_ptr<const FittedGroom>> fitted() const;
  /// The first strand of each table alone.
  CutStrands outline() const;

 private:
  using Fits = std::vector<std::shared_ptr<const FittedGroom>>;

  /// `fits`: those of an equal series, or none.
  StrandSeries(std::shared_ptr<const StrandTables> tables, const RootMotion& head,
               std::uint64_t seed, StrandLimits most, const Fits& fits);
  std::shared_ptr<const StrandTables> tables_;
  RootMotion head_;
  std::optional<FreeRoot> free_root_;
  Common common_;
  std::vector<std::optional<Groom>> grooms_;  // of each source that makes strands up
  Fits fits_;                                 // of each source with a file
  std::vector<std::size_t> first_{0};         // strand of each source, and the end
  std::size_t elements_ = 0;
  std::vector<std::size_t> some_;  // empty: all
};

/// Whether its strands get the number of elements that they need.
bool has_tolerance(const StrandSource& source);
/// Takes the tolerance from a groom by which its strands get their elements.
void clear_detail(Table& groom);

/// Returns the tables with `elements` elements in every strand.
StrandTables with_elements(StrandTables tables, int elements);
/// Returns the tables with `elements` elements and no tolerance in every strand, where
/// an entry of `elements` is above 0.
StrandTables with_elements(StrandTables tables, std::span<const int> elements);
/// Returns the tables with these `cuts` in every [strand].
StrandTables with_cuts(StrandTables tables, std::string_view cuts);
/// Returns the tables with twice the elements in every strand. Throws InputError where
/// these follow from a tolerance.
StrandTables with_twice_the_elements(StrandTables tables);

}  // namespace tress::simulation
