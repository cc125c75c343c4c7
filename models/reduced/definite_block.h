#pragma once

#include "contract/system.h"

namespace tress::models {

/// Each row-major 3x3 block becomes its symmetric part without negative eigenvalues, the
/// nearest positive semidefinite matrix [Higham 1988]. O(blocks), and of those that are
/// definite as they stand a dozen operations.
void make_semidefinite(InOut blocks);

}  // namespace tress::models
