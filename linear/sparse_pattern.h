#pragma once

#include <vector>

#include "contract/basics.h"
#include "contract/pattern.h"

namespace tress {

/// The pattern whose column j has the entries columns[j], in any order, repeated or not.
Pattern pattern_of(int rows, std::vector<std::vector<int>> columns);

/// Index among the values of entry (row, column), which must be in the pattern.
int place_of(const Pattern& pattern, int row, int column);

/// all = the matrix of these values, column by column (rows x cols), zeros included.
void to_dense(const Pattern& pattern, In values, Out all);

}  // namespace tress
