#pragma once

#include "integrators/esdirk.h"

namespace tress::integrators {

/// ESDIRK4(3)6L[2]SA: five implicit stages of order 2, L-stable, gamma = 1/4. [Kennedy,
/// Carpenter 2016, NASA/TM-2016-219173, section 4.1.2 and appendix]
const EsdirkTable& esdirk43_table();

}  // namespace tress::integrators
