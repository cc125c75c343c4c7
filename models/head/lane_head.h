#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/input_error.h"
#include "math/lanes.h"
#include "models/head/head.h"
#include "models/head/head_losses.h"
#include "models/head/head_units.h"
#include "models/head/lane_root.h"
#include "models/head/packs.h"

/// Common code of all batches, whatever their kernel.
namespace tress::models {

/// Place of errors of batches.
inline constexpr const char* place_of_head = "batch of strands";

/// Throws InputError unless these numbers make sense.
inline void check_for_head(const LaneOptions& options) {
  refuse_if(options.elements < 1, "no elements", place_of_head,
            "cut strands into at least one");
  refuse_if(!(options.longest > 0) || !std::isfinite(options.longest),
            "a length that is not positive", place_of_head,
            "give that of the longest strand, in m");
}

/// Throws InputError unless the strand has `elements` segments of equal length and
/// section, one after the other, and no free root.
inline void check_for_head(const Strand& strand, std::size_t elements) {
  refuse_if(strand.segments.size() != elements,
            "a strand of " + std::to_string(strand.segments.size()) +
                " elements among those of " + std::to_string(elements),
            place_of_head, "cut all into equally many");
  refuse_if(strand.free_root.has_value(), "a free root", place_of_head,
            "clamp all roots");
  const Segment& first = strand.segments.front();
  for (std::size_t i = 0; i < elements; ++i) {
    const Segment& s = strand.segments[i];
    refuse_if(
        s.parent != static_cast<int>(i) - 1 || s.mount.e0.x != 1 || s.mount.e1.y != 1,
        "a strand with branches", place_of_head, "run trees one by one");
    refuse_if(std::abs(s.length - first.length) > 1e-9 * first.length ||
                  s.section.a1 != first.section.a1 || s.section.a2 != first.section.a2,
              "elements of different length or section", place_of_head,
              "use grading = 1");
  }
}

/// Throws InputError on an effect that heads refuse.
inline void check_for_head(const Effect& effect) {
  if (const auto no = refused_by_heads(effect)) {
    throw InputError(no->reason, place_of_head, no->remedy);
  }
}

/// A length times this is no less than that of what T computes.
template <class T>
inline constexpr double rounded_up = 1 + (sizeof(typename T::Scalar) == 8 ? 1e-12 : 1e-5);

/// Returns an upper bound of the distance between points of elements of this length (m)
/// and the chords of the points x.
inline double largest_bulge(std::span<const double> x, double length) {
  double square = 0;
  for (std::size_t i = 0; i + 3 < x.size(); i += 3) {
    const Vec chord = load3(&x[i + 3]) - load3(&x[i]);
    square = std::max(square, length * length - dot(chord, chord));
  }
  return 0.5 * std::sqrt(square);
}

/// The packs of this build in words, such as "4 in double precision, 8 in single
/// precision".
inline constexpr std::string_view packs_of_build =
#define TRESS_PACK(Number, width) ", " #width " in " TRESS_NAME_OF_##Number " precision"
#define TRESS_NAME_OF_double "double"
#define TRESS_NAME_OF_float "single"
    TRESS_EACH_PACK(TRESS_PACK);
#undef TRESS_PACK
#undef TRESS_NAME_OF_double
#undef TRESS_NAME_OF_float

/// The remedy where packs are missing, empty if none is.
#if defined(TRESS_ONE_PACK) || !TRESS_LONG_PACKS
inline constexpr std::string_view other_packs =
    "; ./tress build compiles the other packs";
#else
inline constexpr std::string_view other_packs;
#endif

/// Returns made<T>() for the number type T of this pack. Throws InputError if the pack
/// does not exist. `short_numbers`: whether single precision is supported.
template <class Result, bool short_numbers = true, class Made>
Result on_pack(const HeadPack& pack, Made made) {
  const std::size_t bytes = pack.number == HeadNumber::float64 ? 8 : 4;
#define TRESS_PACK(Number, width)                               \
  if constexpr (short_numbers || sizeof(Number) == 8) {         \
    if (bytes == sizeof(Number) && pack.lanes == (width)) {     \
      return made.template operator()<PackOf<Number, width>>(); \
    }                                                           \
  }
  TRESS_EACH_PACK(TRESS_PACK)
#undef TRESS_PACK
  throw InputError(fmt::format("{} lanes in {} precision", pack.lanes,
                               bytes == 8 ? "double" : "single"),
                   place_of_head,
                   fmt::format("use {}{}", packs_of_build.substr(2), other_packs));
}

}  // namespace tress::models
