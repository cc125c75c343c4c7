#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "math/lanes.h"
#include "models/head/head.h"
#include "models/head/head_units.h"
#include "models/head/lane_root.h"

/// What all heads of hair have in common, whatever their kernel.
namespace tress::models {

inline constexpr const char* place_of_head = "head of hair";

/// Throws InputError unless these numbers make sense.
inline void check_for_head(const HeadOptions& options) {
  refuse_if(options.elements < 1, "no elements", place_of_head,
            "cut strands into at least one");
  refuse_if(!(options.longest > 0) || !std::isfinite(options.longest),
            "a length that is not positive", place_of_head,
            "give that of the longest strand, in m");
  refuse_if(!(options.newton_tolerance > 0) || options.newton_iterations < 1,
            "no tolerance or no iterations", place_of_head, "give positive ones");
  refuse_if(!(options.tolerance >= 0 && options.tolerance < 1),
            "a tolerance that is no part of a length", place_of_head,
            "give one between 0 and 1");
  refuse_if(!(options.min_step >= 0), "a shortest step below 0", place_of_head,
            "give one in s, or leave it out");
  refuse_if(options.tolerance > 0 && options.method != HeadMethod::tr_bdf2,
            "a tolerance for equal steps", place_of_head,
            "use tr_bdf2, or give no tolerance");
}

/// Throws InputError if the method starts from an acceleration that strands do not have.
inline void check_start(const HeadOptions& options) {
  refuse_if(
      options.method == HeadMethod::tr_bdf2 && options.twist && !options.rotary_inertia,
      "no acceleration from which tr_bdf2 starts: twist has no inertia", place_of_head,
      "leave rotary_inertia on, or use backward_euler");
}

/// Throws InputError if numbers are too short for the tolerance.
inline void check_resolved(const HeadOptions& options, const HeadPack& pack) {
  refuse_if(options.tolerance > 0 && !resolve(pack.number, options.tolerance),
            "a tolerance that " +
                std::string(pack.number == HeadNumber::float32 ? "32" : "64") +
                " bits do not resolve",
            place_of_head, "give a larger one, or use 64 bits");
}

/// Throws InputError if steps are single corrections of numbers of 32 bits, for strands
/// in which their rounding errors grow.
inline void check_mended(const HeadOptions& options, const HeadPack& pack) {
  refuse_if(options.method == HeadMethod::linearly_implicit_midpoint &&
                pack.number == HeadNumber::float32,
            "32 bits, whose rounding a single correction does not mend", place_of_head,
            "use 64 bits, or tr_bdf2");
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

/// How far points of elements of so much length (m) are from the chords of these points
/// at most.
inline double largest_bulge(std::span<const double> x, double length) {
  double square = 0;
  for (std::size_t i = 0; i + 3 < x.size(); i += 3) {
    const Vec chord = load3(&x[i + 3]) - load3(&x[i]);
    square = std::max(square, length * length - dot(chord, chord));
  }
  return 0.5 * std::sqrt(square);
}

/// What several threads find.
class HeadLosses {
 public:
  /// In the step from t to t + h (s), after this part of it.
  void add(std::size_t strand, double t, double h, std::string_view reason,
           double part = 0) {
    const std::scoped_lock lock(guard_);
    all_.push_back({strand, std::lround(t / h) + 1, t + part * h, reason});
  }
  /// See Head::losses().
  std::vector<HeadLoss> after(std::size_t known) const {
    const std::scoped_lock lock(guard_);
    std::vector<HeadLoss> rest(all_.begin() + static_cast<std::ptrdiff_t>(known),
                               all_.end());
    std::ranges::sort(rest, {}, &HeadLoss::strand);
    return rest;
  }

 private:
  mutable std::mutex guard_;
  std::vector<HeadLoss> all_;
};

/// The Head of this pack: made<T>(instructions) for the type T of the pack's numbers.
/// Throws InputError if there is no such pack. `short_numbers`: whether there are those
/// of 32 bits.
template <bool short_numbers = true, class Made>
std::unique_ptr<Head> on_pack(const HeadPack& pack, Made made) {
  const Instructions set = pack.instructions.value_or(widest_instructions());
  refuse_if(!available(set),
            std::string("no instructions ") + name(set) + " on this machine",
            place_of_head, "leave the choice open");
  if (pack.number == HeadNumber::float64) {
    if (pack.lanes == 1) return made.template operator()<PackOf<double, 1>>(set);
    if (pack.lanes == 4) return made.template operator()<PackOf<double, 4>>(set);
    if (pack.lanes == 8) return made.template operator()<PackOf<double, 8>>(set);
  } else if constexpr (short_numbers) {
    if (pack.lanes == 8) return made.template operator()<PackOf<float, 8>>(set);
    if (pack.lanes == 16) return made.template operator()<PackOf<float, 16>>(set);
  }
  throw InputError(std::to_string(pack.lanes) + " lanes", place_of_head,
                   "use 1, 4 or 8 of 64 bits, 8 or 16 of 32 bits");
}

}  // namespace tress::models
