#pragma once

#include <vector>

#include "simulation/files/row.h"

namespace tress::experiments::divided_heads {

/// Numbers of hairs whose measurements set the model's numbers, each of which they set
/// together.
inline constexpr int fitted_strands[] = {1000, 2000, 4000};

/// What the model says of all rows, where enough of them were measured to set it: its
/// cost, of measured ones also how far it is off, and efficiency. More ranks than cores
/// take turns.
void add_predictions(std::vector<Row>& rows);

}  // namespace tress::experiments::divided_heads
