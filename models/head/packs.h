#pragma once

#include "models/head/long_packs.h"  // written by cmake: TRESS_LONG_PACKS is 1 or 0

/// Applies PACK(Number, lanes) to each pack for which kernels of batches are compiled.
/// TRESS_ONE_PACK, from the build, leaves packs of four doubles only.
#if defined(TRESS_ONE_PACK)
#define TRESS_EACH_PACK(PACK) PACK(double, 4)
#elif !TRESS_LONG_PACKS
#define TRESS_EACH_PACK(PACK) \
  PACK(double, 1)             \
  PACK(double, 4)             \
  PACK(float, 8)
#else
#define TRESS_EACH_PACK(PACK) \
  PACK(double, 1)             \
  PACK(double, 4)             \
  PACK(double, 8)             \
  PACK(float, 8)              \
  PACK(float, 16)
#endif
