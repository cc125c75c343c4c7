#include "models/head/packs.h"

#include <algorithm>

#include "math/instructions.h"
#include "models/head/head.h"

namespace tress::models {
namespace {

constexpr HeadPack all_packs[] = {
#define TRESS_PACK(Number, width) \
  {sizeof(Number) == 8 ? HeadNumber::float64 : HeadNumber::float32, width},
    TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK
};

/// The width of the longest pack, in doubles.
constexpr int longest = std::max({
#define TRESS_PACK(Number, width) \
  static_cast<int>(width * sizeof(Number) / sizeof(double)),
    TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK
});

}  // namespace

std::span<const HeadPack> compiled_packs() { return all_packs; }

HeadPack widest_pack(HeadNumber number) {
  const int registers = widest_instructions() == Instructions::avx512 ? 8 : 4;
  return pack_as_long_as(std::min(registers, longest), number);
}

HeadPack longest_pack(HeadNumber number) { return pack_as_long_as(longest, number); }

}  // namespace tress::models
