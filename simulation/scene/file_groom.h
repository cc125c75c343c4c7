#pragma once

#include <memory>
#include <span>

#include "simulation/groom/fitted_groom.h"
#include "simulation/scene/strand_table.h"

namespace tress::simulation {

// [groom] file = "...": the strands of a file, each fitted by elements.

/// Returns the keys of [groom] that apply to files.
std::span<const Parameter> file_groom_parameters();

/// The strands of the table's file, in m and z up; null: it names none. Throws InputError
/// with the location of an invalid key, or of what is wrong in the file.
std::shared_ptr<const PlacedGroom> read_file_groom(const Table& groom);

/// Throws InputError on a key for files in a table without one.
void refuse_file_keys(const Table& groom);

/// Returns the number of strands of the file that the table takes.
std::size_t file_strands(const Table& groom, const PlacedGroom& file);

/// Fits `count` strands of the file by the table's settings. Throws InputError with the
/// location of an invalid key.
std::shared_ptr<const FittedGroom> fit_file_groom(const Table& groom,
                                                  const PlacedGroom& file,
                                                  std::size_t count);

/// A strand whose natural shape is the fitted one; it moves with the head.
Strand file_strand(const Table& groom, const Table* own_material, const Common& common,
                   const FittedStrand& fitted);

}  // namespace tress::simulation
