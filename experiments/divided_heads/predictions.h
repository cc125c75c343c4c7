#pragma once

#include <vector>

#include "simulation/files/row.h"

namespace tress::experiments::divided_heads {

/// What the model says of all rows, where enough of them were measured to set its
/// numbers, which all of these set together: its cost, of measured ones also how far it
/// is off, and efficiency; and how far it is off where it knows heads of all other
/// numbers of hairs alone. More ranks than cores take turns.
void add_predictions(std::vector<Row>& rows);

}  // namespace tress::experiments::divided_heads
