#pragma once

#include "contract/basics.h"

namespace tress::models {

/// Replaces each row-major 3x3 block by its symmetric part without negative eigenvalues,
/// the nearest positive semidefinite matrix [Higham 1988]. O(blocks); a block that is
/// already definite costs a dozen operations.
void make_semidefinite(InOut blocks);

}  // namespace tress::models
