#include "models/head/head.h"

#include <algorithm>

#include "math/instructions.h"
#include "models/head/packs.h"

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

std::optional<HeadRefusal> refused_by_heads(const Effect& effect) {
  const std::string name(effect.name());
  if (effect.for_strand(0) != nullptr) {
    return HeadRefusal{"effect " + name + " holds contact forces between steps",
                       "set friction_law = \"regularised\""};
  }
  if (effect.needs().couplings) {
    return HeadRefusal{"effect " + name + " couples the points of a strand",
                       "leave it out"};
  }
  return {};
}

void take_uniform_effects(LaneOptions& options) {
  const Viscosity air = viscosity(options.effects);
  options.gravity = options.gravity + uniform_acceleration(options.effects);
  options.drag += air.per_length;
  options.mass_damping += air.per_mass;
  std::erase_if(options.effects,
                [](const auto& effect) { return !depends_on_place(*effect); });
}

}  // namespace tress::models
