#pragma once

#include <span>
#include <string_view>

#include "models/strand/strand.h"
#include "simulation/table/table.h"

namespace tress::simulation {

/// Returns the keys of [strand] and [groom] for properties that vary along a strand. Each
/// has rows of an arc length over the length of the strand, and values there. Values are
/// linear between rows and constant beyond them.
std::span<const Parameter> along_parameters();

/// Returns the first key by which the table varies section or material along a strand,
/// the widths of a file among them; empty: there is none.
std::string_view varied_key(const Table& table);
/// Returns whether the table varies the radius along a strand.
bool varies_radius(const Table& table);

/// Sets section and material of all segments by the table, each to the values at its
/// middle. Internal friction varies as the mean bending stiffness, so that the damping
/// time stays. Throws InputError naming the key if its rows are not in order along the
/// strand, or a value is not positive.
void vary_along(const Table& table, models::Strand& strand);

/// Sets the radius of a segment (m), the mean of a circle of the same area, and its
/// internal friction as vary_along().
void set_radius(const models::Strand& strand, double radius, models::Segment& segment);

/// Returns the shape of `darboux_along` for a strand of this length (m). Throws
/// InputError unless its rows are in order along the strand.
models::Shape shape_along(const Table& table, double length);

}  // namespace tress::simulation
